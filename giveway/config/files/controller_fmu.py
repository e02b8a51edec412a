"""The controller FMU that a configuration names: its file, its profile, its hash."""

import dataclasses
from hashlib import sha256
from pathlib import Path
from typing import Any

from controller import Setup
from controller.driving_constants import COMFORTABLE
from fmus import (
    ControllerProfile,
    FmuError,
    PreparedController,
    choose_controller_profile,
    describe,
    prepare_controller,
    read_controller_profile,
)
from giveway.config.run_config import EgoRunConfig
from giveway.config.tables.basics import DEFAULT_SPEED
from giveway.errors import ControlError, retold


def setup_of(config: EgoRunConfig, time_step: float) -> Setup:
    """Return the setup by which a controller learns about its drive.

    Args:
        config: Configuration of the ego, with a number as its reference speed.
        time_step: Time step of the co-simulation [s].
    """
    vehicle, regulation = config.vehicle, config.regulation
    speed = config.reference_speed
    return Setup(
        time_step=time_step,
        mass=vehicle.mass,
        friction=vehicle.friction,
        reference_speed=DEFAULT_SPEED if isinstance(speed, str) else speed,
        safe_distance=regulation.safe_distance,
        force_limit=config.vehicle.force_limit,
        comfortable_deceleration=COMFORTABLE,
    )


def prepared(config: EgoRunConfig, time_step: float) -> PreparedController:
    """Return the controller FMU of one ego, with the run's settings and the user's options.

    Args:
        config: Configuration of the ego.
        time_step: Time step of the co-simulation [s].

    Raises:
        ControlError: the file or its profile cannot be read, or the two do not fit each other.
    """
    with retold(FmuError, ControlError):
        return prepare_controller(
            Path(config.controller),
            step_size=time_step,
            setup=setup_of(config, time_step)._asdict(),
            profile=_profile(config),
            start_values=_start_values(config),
        )


def fmu_hash(path: str) -> str:
    """Return the SHA-256 of a controller FMU.

    Raises:
        ControlError: the file cannot be read.
    """
    try:
        return sha256(Path(path).read_bytes()).hexdigest()
    except OSError as error:
        raise ControlError(
            f"controller = '{path}': cannot be read ({error.strerror}); expected an FMU"
        ) from None


def fmu_described(config: EgoRunConfig) -> dict[str, Any]:
    """Return the entries of the manifest for a controller FMU.

    Raises:
        ControlError: the file cannot be read.
    """
    path = Path(config.controller)
    with retold(FmuError, ControlError):
        profile = choose_controller_profile(path, _profile(config))
        return {
            **dataclasses.asdict(describe(path)),
            "name": config.controller,
            "profile": profile.model_dump(exclude_unset=True),
            "options": dict(config.controller_options),
        }


def _start_values(config: EgoRunConfig) -> dict[str, Any]:
    """Return the user's options, which are parameters of the FMU.

    Raises:
        ControlError: an option is a table.
    """
    for name, value in config.controller_options.items():
        if isinstance(value, dict) or value is None:
            raise ControlError(
                f"[controller_options] {name} = {value}: expected a number, true, false, a text or "
                f"a list of numbers for a parameter of {config.controller}"
            )
    return dict(config.controller_options)


def _profile(config: EgoRunConfig) -> ControllerProfile | None:
    named = config.controller_profile
    return read_controller_profile(Path(named)) if named else None
