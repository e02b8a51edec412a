"""A controller profile: the roles of a controller FMU's inputs and outputs.

The same tables are read from a TOML file, or drafted by ``draft_controller`` in
:mod:`fmus.profile.controllers.controller_draft`. Whether a profile fits an FMU is checked by
:mod:`fmus.profile.controllers.controller_wiring`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic import Field, model_validator

from fmus.profile.tables import Axis, Parameters, Stepping, read_tables, validated
from fmus.strict_table import StrictTable

GUIDE = "docs/controller_fmu.md"


class SpeedAnswer(Axis):
    """The speed that the vehicle is to approach."""

    lead: float | None = Field(None, gt=0, le=60)  # T [s]: a = (v_set - v) / T; None: one step


class ControllerInputs(StrictTable):
    """The inputs of the FMU at each step; a series is an array, or ``x[1]``, ``x[2]``, ..."""

    speed: Axis | None = None  # [m/s]
    acceleration: Axis | None = None  # [m/s2]
    position: Axis | None = None  # [m] station of the point that keeps the safe distance
    last_force: Axis | None = None  # [N] force that acted in the step before
    gap: Axis | None = None  # [m] gap to the closest person, vehicle or stop ahead
    person_gap: Axis | None = None  # [m] gap to the closest person in front
    leader_gap: Axis | None = None  # [m] gap to the vehicle in front
    leader_speed: Axis | None = None  # [m/s] speed of that vehicle
    speed_limit: Axis | None = None  # [m/s]
    stop_gap: Axis | None = None  # [m] gap from the front bumper to the stop of lights or priority
    # [m] stations of those who will be in front, as a series
    obstacle_positions: Axis | None = None
    obstacle_gaps: Axis | None = None  # [m] the same from where ``position`` is now: a series
    # value that is given for infinity: nobody in front, or no limit
    nothing: float = Field(1e9, gt=0, le=1e300)


class ControllerOutputs(StrictTable):
    """The FMU's answer: one of force, acceleration, speed."""

    force: Axis | None = None  # [N] forwards positive
    acceleration: Axis | None = None  # [m/s2]
    speed: SpeedAnswer | None = None  # [m/s]

    @model_validator(mode="after")
    def _one(self) -> ControllerOutputs:
        answers = [name for name in ANSWERS if getattr(self, name) is not None]
        if len(answers) != 1:
            given = " and ".join(answers) or "no output"
            raise ValueError(f"{given}: expected one of {', '.join(ANSWERS)}")
        return self


class ControllerSetup(StrictTable):
    """The FMU's parameters that get the settings of the run."""

    time_step: Axis | None = None  # [s] between two answers
    mass: Axis | None = None  # M [kg]
    friction: Axis | None = None  # alpha [N.s/m]
    reference_speed: Axis | None = None  # v_r [m/s]
    safe_distance: Axis | None = None  # d_safe [m]
    force_limit: Axis | None = None  # [N]
    comfortable_deceleration: Axis | None = None  # [m/s2]


class ControllerProfile(StrictTable):
    """The settings that giveway needs to ask a controller FMU."""

    fmu: Stepping = Stepping()
    inputs: ControllerInputs
    outputs: ControllerOutputs
    setup: ControllerSetup = ControllerSetup()
    parameters: Parameters = Field(default_factory=dict)


ANSWERS = tuple(ControllerOutputs.model_fields)
SERIES = ("obstacle_positions", "obstacle_gaps")
TOLD = tuple(name for name in ControllerInputs.model_fields if name != "nothing")
SETTINGS = tuple(ControllerSetup.model_fields)


def read_controller_profile(path: Path) -> ControllerProfile:
    """Read the controller profile in a TOML file.

    Raises:
        FmuProfileError: the file is missing, not TOML, or a key or value cannot be used.
    """
    values = read_tables(path, "a controller profile", f"{GUIDE} shows one")
    return make_controller_profile(values, str(path))


def make_controller_profile(values: dict[str, Any], origin: str) -> ControllerProfile:
    """Return the controller profile in nested dictionaries.

    Args:
        values: Values with the keys of the TOML file.
        origin: Name of the source in errors.

    Raises:
        FmuProfileError: a key or value cannot be used.
    """
    return validated(ControllerProfile, values, origin, GUIDE)
