"""The merging of settings in their order: the scenario's, the user's file, flags or arguments."""

import os
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from fmus import FmuError, read_profile
from giveway.config.files.declared import with_declared
from giveway.config.files.identified import identified_vehicle
from giveway.config.files.layers import Layer, build_config, merge, read_toml, undotted
from giveway.config.files.presets import parameters_of
from giveway.config.files.trust import require_trusted
from giveway.config.run_config import OWN_FMU, RunConfig
from giveway.config.tables.recorded import RecordedConfig
from giveway.errors import ConfigError, ScenarioError, VehicleError, retold
from sumo_scenarios import Scenario, available, find
from sumo_scenarios import ScenarioError as UnknownScenario

_FILES = ("fmu", "profile", "preset")  # Keys of tables that may name a file
_OWN_FILES = ("controller", "controller_profile")  # The same for keys of a run and of its egos
_WITH_FILES = ("vehicle", "crowd", "perception")  # Tables that have such keys
_KINDS_OF_EGO = ("take_over", "route", "none")


def load(layers: Sequence[Layer], trusted: Collection[str] = ()) -> tuple[RunConfig, Scenario]:
    """Return the configuration of ``layers`` on top of their scenario's own settings.

    Args:
        layers: Layers of settings.
        trusted: Plug-ins that may be imported although only a results folder names them.

    Raises:
        ConfigError: a key or value cannot be used.
        ScenarioError: the scenario does not exist.
    """
    wanted = merge(layers).get("scenario", RunConfig.model_fields["scenario"].default)
    if not isinstance(wanted, str) or not wanted:
        build_config(layers)  # raises an error that names the layer and what was expected
    with retold(UnknownScenario, ScenarioError):
        scenario = find(wanted)
    for layer in layers:
        _require_one_ego(layer)
    own = []
    if scenario.settings_file is not None:
        layer = read_toml(scenario.settings_file)
        settings = {key: value for key, value in layer.values.items() if key != "description"}
        # what a scenario names is the word of whoever names the scenario
        naming = [one.results for one in layers if one.holds(("scenario",))]
        own = [Layer(layer.origin, settings, results=naming[-1] if naming else None)]
    layers = [*own, *layers]
    identified = _identified(layers)
    config = build_config([*identified, *layers])
    require_trusted(config, layers, trusted)
    config = with_declared(config)
    known = identified[0].values["vehicle"] if identified else {}
    config = _with_one_ego(_each_identified(config, known), layers)
    return _placed(config, scenario), scenario


def _identified(layers: Sequence[Layer]) -> list[Layer]:
    """Return the lowest layer: what the profile of the run's vehicle says of [vehicle].

    Raises:
        VehicleError: the profile cannot be used.
    """
    vehicle = merge(layers).get("vehicle")
    profile = vehicle.get("profile") if isinstance(vehicle, Mapping) else None
    if not profile or not isinstance(profile, str):
        return []  # the validation of the table reports the error
    return [Layer(profile, {"vehicle": _model_in(profile)})]


def _each_identified(config: RunConfig, known: Mapping[str, float]) -> RunConfig:
    """Return ``config`` with the FMU's parameters in each entry of ``egos`` that names an FMU.

    Args:
        config: Configuration of the run. M, alpha and limits may come from the vehicle's profile.
        known: What that profile says of them, which does not hold for another FMU.
    """
    told = {key: value for key, value in config.vehicle.told.items() if value != known.get(key)}
    entries = []
    for entry in config.egos:
        vehicle = entry.get("vehicle")
        if isinstance(vehicle, Mapping) and OWN_FMU & set(vehicle):
            profile = vehicle.get("profile", "")
            found = _model_in(profile) if profile else {}
            entry = {**entry, "vehicle": {"profile": profile, **told, **found, **vehicle}}
        entries.append(entry)
    return config.model_copy(update={"egos": tuple(entries)})


def _model_in(profile: object) -> dict[str, float]:
    """Return what a profile says of [vehicle]; empty if the vehicle has not been identified."""
    with retold(FmuError, VehicleError):
        model = read_profile(Path(str(profile))).model
    return {} if model is None else identified_vehicle(model)


def _with_one_ego(config: RunConfig, layers: Sequence[Layer]) -> RunConfig:
    """Return ``config`` with the kind of ego that was requested last, and nothing of the others.

    A scenario's own route has no meaning in a run that takes over a vehicle, and the two settings
    would contradict each other. In a run without an ego, the route stays: zone and crowd refer to
    the path that an ego would have.
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
    """Make sure that one origin does not request several kinds of ego at once.

    Raises:
        ConfigError: it requests several.
    """
    ego = _ego_of(layer)
    named = [layer.name(("ego", key)) for key in _KINDS_OF_EGO if ego.get(key)]
    if len(named) > 1 and ego.get("take_over"):
        raise ConfigError(
            f"{' and '.join(named)}: contradict each other; expected one of them: a vehicle of the "
            "scenario, an inserted one, or none"
        )


def _placed(config: RunConfig, scenario: Scenario) -> RunConfig:
    """Return ``config`` with absolute paths, so that it does not depend on the current folder."""
    if config.scenario not in available():
        config = config.model_copy(update={"scenario": str(scenario.config_file)})
    placed: dict[str, Any] = {
        name: section.model_copy(update=_absolute(section.model_dump()))
        for name, section in config
        if name in _WITH_FILES
    }
    placed["crowd"] = placed["crowd"].model_copy(
        update={"recorded": tuple(map(_recording_placed, config.crowd.recorded))}
    )
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


def _recording_placed(entry: RecordedConfig) -> RecordedConfig:
    """Return the entry of a recording with an absolute path, so that it is found from anywhere."""
    update = {"path": str(Path(entry.path).absolute())}
    return entry.model_copy(update=update | _absolute(entry.model_dump(), ("dataset",)))


def _absolute(table: Mapping[str, Any], keys: Sequence[str] = _FILES) -> dict[str, str]:
    """Return the files that a table's settings name, with absolute paths, if they exist."""
    named = {key: Path(str(table[key])) for key in keys if table.get(key)}
    return {
        key: str(path.absolute())
        for key, path in named.items()
        # Path.is_file raises an error if a name is too long
        if os.path.isfile(path)  # noqa: PTH113
    }


def _presets_read(config: RunConfig) -> RunConfig:
    """Return ``config`` after a check that its preset files can be used.

    Raises:
        ConfigError: a preset file cannot be used.
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
    """Return the settings of a caller of the Python API, without the defaults.

    Raises:
        ConfigError: the argument is neither a configuration nor the name of a scenario or TOML
            file.
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
