"""The order of settings: the scenario's, the user's file, then flags or arguments."""

import os
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from fmus import FmuError, read_profile
from giveway.config.files.declared import with_declared
from giveway.config.files.layers import Layer, build_config, merge, read_toml, undotted
from giveway.config.files.presets import parameters_of
from giveway.config.files.trust import require_trusted
from giveway.config.run_config import RunConfig
from giveway.errors import ConfigError, ScenarioError, VehicleError
from sumo_scenarios import Scenario, available, find
from sumo_scenarios import ScenarioError as UnknownScenario

_FILES = ("fmu", "profile", "preset")  # keys of tables that may name a file
_OWN_FILES = ("controller", "controller_profile")  # of a run and of its egos
_WITH_FILES = ("vehicle", "crowd", "perception")  # tables that have such keys
_KINDS_OF_EGO = ("take_over", "route", "none")


def load(layers: Sequence[Layer], trusted: Collection[str] = ()) -> tuple[RunConfig, Scenario]:
    """The configuration that ``layers`` amount to on top of their scenario's own settings.

    Args:
        layers: Layers of settings.
        trusted: Controllers that may be imported though only a results folder names them.

    Raises:
        ConfigError: a key or value cannot be used.
        ScenarioError: the scenario does not exist.
    """
    wanted = merge(layers).get("scenario", RunConfig.model_fields["scenario"].default)
    if not isinstance(wanted, str) or not wanted:
        build_config(layers)  # names the layer and what was expected
    try:
        scenario = find(wanted)
    except UnknownScenario as error:
        raise ScenarioError(str(error)) from error
    for layer in layers:
        _require_one_ego(layer)
    own = []
    if scenario.settings_file is not None:
        layer = read_toml(scenario.settings_file)
        settings = {key: value for key, value in layer.values.items() if key != "description"}
        own = [Layer(layer.origin, settings)]
    layers = [*own, *layers]
    identified = _identified(layers)
    config = build_config([*identified, *layers])
    require_trusted(config, layers, trusted)
    config = with_declared(config)
    own_model = _model_of(build_config(layers) if identified else config)
    config = _with_one_ego(_each_identified(config, own_model), layers)
    return _placed(config, scenario), scenario


def _identified(layers: Sequence[Layer]) -> list[Layer]:
    """Return the lowest layer: what the profile of the run's vehicle knows of it.

    Raises:
        VehicleError: the profile cannot be used.
    """
    vehicle = merge(layers).get("vehicle")
    profile = vehicle.get("profile") if isinstance(vehicle, Mapping) else None
    if not profile or not isinstance(profile, str):
        return []  # the vehicle's own table says what is wrong with it
    return [Layer(profile, {"vehicle": _model_in(profile)})]


def _model_of(config: RunConfig) -> dict[str, float]:
    return {"mass": config.vehicle.mass, "friction": config.vehicle.friction}


def _each_identified(config: RunConfig, set_model: dict[str, float]) -> RunConfig:
    """``config`` in which those entries of ``egos`` that name an FMU have what belongs to it.

    Args:
        config: Configuration of the run; its vehicle's M and alpha may be those of its profile.
        set_model: M and alpha without that: what was identified of another FMU is no other's.
    """
    identified = {} if _model_of(config) == set_model else set_model
    entries = []
    for entry in config.egos:
        vehicle = entry.get("vehicle")
        if isinstance(vehicle, Mapping) and {"fmu", "profile"} & set(vehicle):
            profile = vehicle.get("profile", "")
            known = _model_in(profile) if profile else {}
            entry = {**entry, "vehicle": {"profile": profile, **identified, **known, **vehicle}}
        entries.append(entry)
    return config.model_copy(update={"egos": tuple(entries)})


def _model_in(profile: object) -> dict[str, float]:
    """M and alpha as identified; empty if they have not been."""
    try:
        model = read_profile(Path(str(profile))).model
    except FmuError as error:
        raise VehicleError(str(error)) from error
    return {} if model is None else {"mass": model.mass, "friction": model.friction}


def _with_one_ego(config: RunConfig, layers: Sequence[Layer]) -> RunConfig:
    """``config`` with the kind of ego that was asked for last, and nothing left of the others.

    A scenario's own route means nothing to a run that takes over a vehicle; written down beside
    it, the two would contradict each other. Where nobody drives, the route stays: zone and crowd
    are about the way that an ego would have.
    """
    asked = [key for layer in layers for key in _KINDS_OF_EGO if _ego_of(layer).get(key)]
    nothing: dict[str, Any] = {"take_over": (), "route": (), "none": False}
    kept = {"none": {"none", "route"}}.get(asked[-1], {asked[-1]}) if asked else set(nothing)
    others = {key: value for key, value in nothing.items() if key not in kept}
    return config.model_copy(update={"ego": config.ego.model_copy(update=others)})


def _ego_of(layer: Layer) -> Mapping[str, Any]:
    ego = layer.values.get("ego")
    return ego if isinstance(ego, Mapping) else {}


def _require_one_ego(layer: Layer) -> None:
    """Make sure that one origin does not ask for several kinds of ego at once.

    Raises:
        ConfigError: it does.
    """
    ego = _ego_of(layer)
    named = [layer.name(("ego", key)) for key in _KINDS_OF_EGO if ego.get(key)]
    if len(named) > 1 and ego.get("take_over"):
        raise ConfigError(
            f"{' and '.join(named)}: contradict each other; expected one of them: a vehicle of the "
            "scenario, an inserted one, or none"
        )


def _placed(config: RunConfig, scenario: Scenario) -> RunConfig:
    """``config`` with absolute paths, so that it means the same from any folder."""
    if config.scenario not in available():
        config = config.model_copy(update={"scenario": str(scenario.config_file)})
    placed: dict[str, Any] = {
        name: section.model_copy(update=_absolute(section.model_dump()))
        for name, section in config
        if name in _WITH_FILES
    }
    placed |= _absolute(dict(config), _OWN_FILES)
    placed["egos"] = tuple(
        {name: _table_placed(name, table) for name, table in ego.items()}
        | _absolute(ego, _OWN_FILES)
        for ego in config.egos
    )
    return _presets_read(config.model_copy(update=placed))


def _table_placed(name: str, table: Any) -> Any:
    is_table = name in _WITH_FILES and isinstance(table, Mapping)
    return {**table, **_absolute(table)} if is_table else table


def _absolute(table: Mapping[str, Any], keys: Sequence[str] = _FILES) -> dict[str, str]:
    """The files that a table's settings name, as far as there are such files."""
    named = {key: Path(str(table[key])) for key in keys if table.get(key)}
    return {
        key: str(path.absolute())
        for key, path in named.items()
        if os.path.isfile(path)  # noqa: PTH113 - Path's own raises if a name is too long
    }


def _presets_read(config: RunConfig) -> RunConfig:
    """``config``, whose preset files can be used.

    Raises:
        ConfigError: one cannot.
    """
    named = {config.crowd.preset: "[crowd] preset"}
    named |= {ego.perception.preset: "[perception] preset" for ego in config.each_ego()}
    for preset, key in named.items():
        if preset:
            try:
                parameters_of(preset)
            except ConfigError as error:
                raise ConfigError(f"{key}: {error}") from error
    return config


def as_layer(config: RunConfig | dict[str, Any] | str | Path) -> Layer:
    """Return what a caller of the Python API has set, without the defaults.

    Raises:
        ConfigError: it is neither a configuration nor the name of a scenario or TOML file.
    """
    if isinstance(config, str | Path):
        path = Path(config)
        return read_toml(path) if path.suffix == ".toml" else Layer("", {"scenario": str(config)})
    if isinstance(config, RunConfig):
        return Layer("RunConfig", config.model_dump(exclude_unset=True))
    if isinstance(config, dict):
        return Layer("configuration", undotted(config))
    msg = (  # type: ignore[unreachable]  # callers without a type checker
        f"configuration = {config!r}: expected a RunConfig, a dictionary with the keys of the TOML "
        "file, a scenario's name or a .toml file"
    )
    raise ConfigError(msg)
