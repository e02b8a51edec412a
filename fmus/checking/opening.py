"""Vehicles for the drives of a check, as a run would open them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fmus.description.model import Value
from fmus.isolation import open_vehicle
from fmus.profile.vehicle_profile import Limits

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from fmus.checking.manoeuvres import Opener
    from fmus.description.model import Value
    from fmus.interfaces.vehicle import Vehicle
    from fmus.profile.vehicle_profile import VehicleProfile


UNGUARDED = Limits(speed=1e9, position_jump=1e9)


def without_guards(profile: VehicleProfile) -> VehicleProfile:
    """The profile with limits that only nonsense exceeds."""
    return profile.model_copy(update={"limits": UNGUARDED})


def opener_of(
    path: Path,
    *,
    step_size: float,
    profile: VehicleProfile,
    start_values: Mapping[str, Value] | None = None,
    isolated: bool | None = None,
) -> Opener:
    """Opens fresh vehicles of one FMU and profile; their FMU's own step can be chosen.

    Args:
        path: the .fmu file.
        step_size: for which a force is held [s].
        profile: of the vehicle.
        start_values: further start values by variable name.
        isolated: in a process of its own; None: unless it is a shipped FMU.
    """

    def open_with(fmu_step: float | None) -> Vehicle:
        fmu = profile.fmu.model_copy(update={"step": fmu_step or profile.fmu.step})
        stepped = profile.model_copy(update={"fmu": fmu})
        return open_vehicle(
            path,
            step_size=step_size,
            profile=stepped,
            start_values=start_values,
            isolated=isolated,
        )

    return open_with
