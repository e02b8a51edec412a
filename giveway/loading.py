"""Which settings win: the scenario's, then the user's file, then flags or arguments."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from giveway.config import RunConfig
from giveway.configfile import Layer, build_config, merge, read_toml
from giveway.errors import ConfigError, ScenarioError
from sumo_scenarios import ScenarioError as UnknownScenario
from sumo_scenarios import available, find

if TYPE_CHECKING:
    from collections.abc import Sequence

    from sumo_scenarios import Scenario


def load(layers: Sequence[Layer]) -> tuple[RunConfig, Scenario]:
    """The configuration that ``layers`` amount to on top of their scenario's own settings.

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
    return _placed(build_config([*own, *layers]), scenario), scenario


def _require_one_ego(layer: Layer) -> None:
    """Make sure that one origin does not ask for several kinds of ego at once.

    Raises:
        ConfigError: it does.
    """
    ego = layer.values.get("ego")
    if not isinstance(ego, Mapping):
        return
    named = [layer.name(("ego", key)) for key in ("take_over", "route", "none") if ego.get(key)]
    if len(named) > 1:
        msg = (
            f"{' and '.join(named)}: contradict each other; expected one of them: a vehicle of the "
            "scenario, an inserted one, or none"
        )
        raise ConfigError(msg)


def _placed(config: RunConfig, scenario: Scenario) -> RunConfig:
    """``config`` with absolute paths, so that it means the same from any folder."""
    if config.scenario not in available():
        config = config.model_copy(update={"scenario": str(scenario.config_file)})
    fmu = Path(config.vehicle.fmu)
    if fmu.is_file():
        vehicle = config.vehicle.model_copy(update={"fmu": str(fmu.absolute())})
        config = config.model_copy(update={"vehicle": vehicle})
    return config


def as_layer(config: RunConfig | dict[str, Any] | str | Path) -> Layer:
    """What a caller of the Python API has set, and nothing of the defaults.

    Raises:
        ConfigError: it is neither a configuration nor the name of a scenario or TOML file.
    """
    if isinstance(config, str | Path):
        path = Path(config)
        return read_toml(path) if path.suffix == ".toml" else Layer("", {"scenario": str(config)})
    if isinstance(config, RunConfig):
        return Layer("RunConfig", config.model_dump(exclude_unset=True))
    if isinstance(config, dict):
        return Layer("configuration", config)
    msg = (  # type: ignore[unreachable]  # callers without a type checker
        f"configuration = {config!r}: expected a RunConfig, a dictionary with the keys of the TOML "
        "file, a scenario's name or a .toml file"
    )
    raise ConfigError(msg)
