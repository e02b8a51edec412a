"""Somebody else's controller, from the configuration: found, imported, given its options."""

from __future__ import annotations

from collections.abc import Callable

from controller import PluggedIn, Setup
from giveway.config import EgoRunConfig
from giveway.config.sections import DEFAULT_SPEED
from giveway.plug_ins.finding import load_class
from giveway.plug_ins.sockets import CONTROLLER


def plugged_in(config: EgoRunConfig, time_step: float) -> PluggedIn:
    """The controller of one ego that somebody else has written.

    Args:
        config: of the ego; its reference speed is a number.
        time_step: of the co-simulation [s].

    Raises:
        ConfigError: its options cannot be used.
        ControlError: it is not installed, or cannot be imported.
        ControllerError: it cannot be made.
    """
    name = config.controller
    make, setup = maker(config), setup_of(config, time_step)
    return PluggedIn(f"'{name}' of '{config.ego_id}'", lambda: make(setup), setup)


def maker(config: EgoRunConfig) -> Callable[[Setup], object]:
    """What makes the controller of one ego, with its options.

    Args:
        config: of the ego.

    Raises:
        ConfigError: its options cannot be used.
        ControlError: it is not installed, or cannot be imported.
    """
    kind, options = load_class(config.controller, CONTROLLER, config.controller_options)
    return lambda setup: kind(setup) if options is None else kind(setup, options)


def setup_of(config: EgoRunConfig, time_step: float) -> Setup:
    """What a controller is told of its drive.

    Args:
        config: of the ego; its reference speed is a number.
        time_step: of the co-simulation [s].
    """
    vehicle, regulation = config.vehicle, config.regulation
    speed = regulation.reference_speed
    return Setup(
        time_step=time_step,
        mass=vehicle.mass,
        friction=vehicle.friction,
        reference_speed=DEFAULT_SPEED if isinstance(speed, str) else speed,
        safe_distance=regulation.safe_distance,
        force_limit=config.mpc.force_limit,
        comfortable_deceleration=regulation.comfortable_deceleration,
    )
