"""Somebody else's controller, from the configuration: found, imported, given its options."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from controller import PluggedIn, Setup
from giveway.config import EgoRunConfig, RunConfig
from giveway.config.sections import DEFAULT_SPEED
from giveway.errors import ConfigError, ControlError
from giveway.plug_ins.finding import find, load
from giveway.plug_ins.options import plain, read_options

_PLACE = "in the controller at"  # as a heartbeat tells it


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
    kind, options = _with_options(config)
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


def require_controllers(egos: Sequence[EgoRunConfig]) -> None:
    """Make sure, before anything runs, that every controller is there and takes its options.

    Raises:
        ConfigError: one has no such option.
        ControlError: one is not installed, or cannot be imported.
    """
    for config in egos:
        if config.plugged_in:
            _with_options(config)


def provenance(egos: Sequence[EgoRunConfig]) -> dict[str, dict[str, Any]]:
    """Of each ego that somebody else drives: distribution, version, hash, all options."""
    told = {}
    for config in egos:
        if config.plugged_in:
            _, options = _with_options(config)
            told[config.ego_id] = find(config.controller).described() | {"options": plain(options)}
    return told


def named_in(failure: str, config: RunConfig) -> str:
    """What is said of a process that died in a controller, with that controller's name.

    Args:
        failure: as the supervisor tells it.
        config: of the run.
    """
    names = dict.fromkeys(ego.controller for ego in config.each_ego() if ego.plugged_in)
    shown = " or ".join(f"'{name}'" for name in names)
    return failure.replace(_PLACE, f"in the controller {shown} at") if names else failure


def _with_options(config: EgoRunConfig) -> tuple[Any, Any]:
    """The class, and the options that it is made with; None: it has none."""
    kind = load(find(config.controller))
    if not callable(kind):
        raise ControlError(
            f"controller = '{config.controller}': {kind!r} is no class; expected one with a method "
            "control (docs/plugins.md)"
        )
    try:
        options = getattr(kind, "Options", None)
        return kind, read_options(config.controller, options, config.controller_options)
    except ConfigError as error:
        error.args = (f"ego '{config.ego_id}': {error}",)
        raise
