"""Makes the plugged-in controller that a configuration names, with its options."""

from collections.abc import Callable

from controller import Setup
from giveway.config import EgoRunConfig
from giveway.config.files.controller_fmu import prepared, setup_of
from giveway.ego.fmu_plug_in import FmuPlugIn
from giveway.plug_ins.finding import is_fmu, load_maker, shown
from giveway.plug_ins.plugged_in_controller import PluggedIn
from giveway.plug_ins.sockets import CONTROLLER


def plugged_in(config: EgoRunConfig, time_step: float) -> PluggedIn:
    """The plugged-in controller of one ego.

    Args:
        config: Configuration of the ego; its reference speed is a number.
        time_step: Control step of the co-simulation [s].

    Raises:
        ConfigError: its options cannot be used.
        ControlError: it is not installed, or cannot be imported.
        ControllerError: it cannot be made.
    """
    make, setup = maker(config), setup_of(config, time_step)
    name = shown(config.controller)
    return PluggedIn(f"'{name}' of '{config.ego_id}'", lambda: make(setup), setup)


def maker(config: EgoRunConfig) -> Callable[[Setup], object]:
    """Return the function that makes the controller of one ego, with its options.

    Args:
        config: Configuration of the ego.

    Raises:
        ConfigError: its options cannot be used.
        ControlError: it is not installed, or cannot be imported or read.
    """
    if is_fmu(config.controller):
        return lambda setup: FmuPlugIn(prepared(config, setup.time_step))
    return load_maker(config.controller, CONTROLLER, config.controller_options)
