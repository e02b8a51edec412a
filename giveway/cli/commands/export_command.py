"""The command ``giveway export controller``: the configured controller as an FMU."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.console import Console

from controller import Pid, SpeedController
from fmus.errors import FmuError
from fmus.sources.export import export_controller
from fmus.sources.parameters import CONTROLLER_FILES, ControllerParameters
from giveway.cli.commands.run_command import layers_of
from giveway.config import EgoRunConfig, RunConfig
from giveway.config.files.loading import load
from giveway.config.option import LANE
from giveway.cosimulation.preflight import control_step
from giveway.ego.controllers import make_controller
from giveway.ego.vehicle_model import model_margin
from giveway.errors import ConfigError, ControlError, ResultsError, retold
from giveway.scenario_files import read_scenario


def export_command(
    scenario: str | None,
    config: Path | None,
    settings: Mapping[str, Any],
    out: Path,
    *,
    fmi: str = "2.0",
    force: bool = False,
) -> int:
    """Write the controller of the effective configuration as an FMU.

    Args:
        scenario: Name or path, or None for the file's or the default.
        config: TOML file, or None.
        settings: Settings given by flags.
        out: File .fmu to write.
        fmi: FMI version, "2.0" or "3.0".
        force: True to replace an existing file.

    Raises:
        GivewayError: one line that says what to do.
    """
    version = next((known for known in CONTROLLER_FILES if known == fmi), None)
    if version is None:
        raise ConfigError(f"--fmi {fmi}: expected {' or '.join(CONTROLLER_FILES)}")
    effective, found = load(layers_of(scenario, config, settings))
    time_step = control_step(effective, read_scenario(found.config_file))
    parameters = _of_all(effective, time_step)
    _check_file(out, force=force)
    with retold(FmuError, ControlError):
        export_controller(out, parameters, fmi_version=version)
    _show(out, version, parameters)
    return 0


def _of_all(config: RunConfig, time_step: float) -> ControllerParameters:
    """Return the parameters of the egos' controller.

    Raises:
        ConfigError: there is no ego, or their controllers differ or cannot be exported.
        ControlError: the parameters contradict each other.
    """
    exports = dict.fromkeys(_parameters(ego, time_step) for ego in config.each_ego())
    if len(exports) == 1:
        return next(iter(exports))
    found = "no ego" if not exports else f"egos with {len(exports)} different controllers"
    raise ConfigError(f"egos: the configuration has {found}; expected one controller to export")


def _parameters(config: EgoRunConfig, time_step: float) -> ControllerParameters:
    """Return the parameters of one ego's controller."""
    if config.reference_speed == LANE:
        msg = f"[regulation] reference_speed = {LANE}: an exported controller has no lanes"
        raise ConfigError(f"{msg}; give a speed, like --desired-speed 8 [m/s]")
    own = make_controller(config, time_step)
    if not isinstance(own, SpeedController) or not isinstance(own.pid, Pid):
        msg = f"controller = {config.controller}: only the paper's controllers can be exported"
        raise ConfigError(f"{msg}; choose --controller mpc-paper or pid-paper")
    if config.safety_layer:
        msg = "[safety] enabled = true: an exported controller does not include the safety layer"
        raise ConfigError(f"{msg}; leave it out with --no-safety")
    pid = own.pid.parameters
    model = config.vehicle if own.mpc is None else own.mpc.model
    with retold(FmuError, ControlError):
        return ControllerParameters(
            mass=model.mass,
            friction=model.friction,
            time_step=time_step,
            reference_speed=pid.reference_speed,
            safe_distance=pid.safe_distance,
            margin=model_margin(config, time_step),
            buffer_distance=pid.buffer_distance,
            speed_max=config.vehicle.speed_max,
            force_limit=pid.force_limit,
            force_rate_limit=config.vehicle.force_rate_limit,
            proportional_gain=pid.K_p,
            integral_gain=pid.K_i,
            derivative_gain=pid.K_d,
            horizon=config.model_steps,
            mpc=own.mpc is not None,
        )


def _check_file(out: Path, *, force: bool) -> None:
    """Make sure that the FMU may be written.

    Raises:
        ResultsError: the name does not fit, or an existing file is not to be replaced.
    """
    if out.suffix != ".fmu":
        msg = f"--out {out}: expected the name of an .fmu file, like mpc.fmu"
    elif out.is_dir():
        msg = f"--out {out}: is a folder; expected the name of an .fmu file"
    elif out.exists() and not force:
        msg = f"--out {out}: exists; replace it with --force or name another file"
    elif not out.parent.is_dir():
        msg = f"--out {out}: the folder {out.parent} does not exist; create it first"
    else:
        return
    raise ResultsError(msg)


def _show(out: Path, version: str, p: ControllerParameters) -> None:
    kind = f"MPC of {p.horizon} steps, PID as fallback" if p.mpc else "PID"
    places = "obstacle_position"
    if version == "2.0":
        places = f"{places}[1] ... {places}[{p.horizon}]"
    head = f"{out}: FMI {version} Co-Simulation, {kind}, every {p.time_step:g} s"
    console = Console(highlight=False, soft_wrap=True)
    console.print(head, markup=False, style="bold")
    console.print(f"  inputs   speed, position, gap, speed_limit, {places}", markup=False)
    console.print("  outputs  force, reference_speed, acting, feasible, infeasibility")
