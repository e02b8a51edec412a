"""The checks before a run, which find errors of a request before anything is loaded."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from giveway.config import EgoRunConfig, RunConfig
from giveway.config.files.foreign_code import require_code
from giveway.config.files.presets import require_steady_preset
from giveway.crowd.zone import Zone
from giveway.ego.vehicle import require_vehicles
from giveway.ego.vehicle_model import with_coarse_model
from giveway.errors import ConfigError, as_request
from giveway.measures import require_pedpy
from giveway.metrics.plugged_in import metric_columns
from giveway.scenario_files import ScenarioFiles, read_scenario
from sumo_scenarios import Scenario

LONGEST_STEP = 0.05  # Longest control step [s]: the paper's; the crowd is stable with it


@dataclass(frozen=True)
class CheckedRun:
    """A run whose scenario, options and vehicles fit each other.

    Attributes:
        config: Effective configuration of the run.
        scenario: Places of the scenario's files.
        files: Content of the scenario's own configuration.
        egos: Configuration of each ego.
        zone: Zone in which giveway moves the scenario's own pedestrians.
        time_step: Control step [s].
    """

    config: RunConfig
    scenario: Scenario
    files: ScenarioFiles
    egos: tuple[EgoRunConfig, ...]
    zone: Zone
    time_step: float


@as_request()
def preflight(config: RunConfig, scenario: Scenario) -> CheckedRun:
    """Check everything that can be known before SUMO or a vehicle FMU is loaded.

    Raises:
        ScenarioError: a file of the scenario is missing or cannot be read.
        ConfigError: the zone is malformed, two egos have the same id, or people would tremble.
        ControlError: a controller, model or metric is not installed.
        MetricError: the columns of a metric cannot be used.
        VehicleError: a vehicle FMU cannot be read, or its profile does not fit.
        DatasetError: a recording whose people are to come in cannot be read.
    """
    if config.measure:
        require_pedpy()
    files = read_scenario(scenario.config_file)
    files.require_inputs()
    zone = Zone(config.crowd.zone)
    egos = config.each_ego()
    _require_distinct(egos)
    time_step = control_step(config, files)
    require_vehicles(egos, time_step)
    egos = tuple(with_coarse_model(ego, time_step) for ego in egos)
    require_code(config, time_step)
    metric_columns(config)  # raises an error if the columns are not sound
    if config.crowd.recorded:
        # imported here, since pandas comes with it
        from giveway.recordings.clips import read_clip

        for entry in config.crowd.recorded:
            read_clip(entry)
    require_steady_preset(config.crowd.preset, time_step, "[crowd] preset")
    for ego in egos:
        if ego.perception.preset:
            require_steady_preset(ego.perception.preset, time_step, "[perception] preset")
    return CheckedRun(config, scenario, files, egos, zone, time_step)


def control_step(config: RunConfig, files: ScenarioFiles) -> float:
    """The control step [s]: as configured, or the longest up to 0.05 s that divides SUMO's."""
    if config.time_step is not None:
        return config.time_step
    step_length = _whole_milliseconds(config.sumo.step_length or files.step_length)
    return step_length / max(1, math.ceil(step_length / LONGEST_STEP - 1e-9))


def substeps_of(time_step: float, step_length: float) -> int:
    """The number of control steps in one SUMO step.

    Raises:
        ConfigError: SUMO's step is not a whole multiple of the control step.
    """
    substeps = round(step_length / time_step)
    if substeps < 1 or abs(substeps * time_step - step_length) > 1e-9:
        raise ConfigError(
            f"--time-step {time_step:g}: SUMO's step of {step_length:g} s is not a whole multiple "
            "of it; choose another time step [s] or --sumo-step-length, or leave it out"
        )
    return substeps


def _whole_milliseconds(step_length: float) -> float:
    """SUMO's step [s], rounded as SUMO rounds it: half a millisecond is rounded up."""
    return math.floor(1000.0 * step_length + 0.5) / 1000.0


def _require_distinct(egos: Sequence[EgoRunConfig]) -> None:
    names = [ego.ego_id for ego in egos]
    for name in names:
        if names.count(name) > 1:
            raise ConfigError(
                f"ego '{name}': two egos have this id; give each [[egos]] entry its own"
            )
