"""The isolation of foreign FMUs in processes of their own, so that a crash of one ends no run."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from fmus.archive.kinds import is_system
from fmus.description.model import Value
from fmus.driving.vehicle import VehicleFmu
from fmus.interfaces.vehicle import Vehicle
from fmus.isolation.isolated_controller import IsolatedController
from fmus.isolation.isolated_vehicle import IsolatedVehicle
from fmus.isolation.parts_vehicle import PartsVehicle
from fmus.isolation.watchdog_process import processes_reused
from fmus.profile.bundled import is_bundled
from fmus.profile.vehicle_profile import VehicleProfile

__all__ = ["IsolatedController", "IsolatedVehicle", "open_vehicle", "processes_reused"]


def open_vehicle(
    path: str | os.PathLike[str],
    *,
    step_size: float,
    profile: VehicleProfile | None = None,
    start_values: Mapping[str, Value] | None = None,
    isolated: bool | None = None,
) -> Vehicle:
    """Return a vehicle that runs an FMU.

    Args:
        path: Path of the .fmu file.
        step_size: Step size [s].
        profile: Roles of the FMU's variables, or None as in :func:`fmus.prepare`.
        start_values: Further start values by variable name.
        isolated: True to run it in a process of its own; None for this unless it is a shipped FMU.

    Raises:
        FmuError: see :class:`IsolatedVehicle`.
    """
    if isolated is None:
        isolated = not is_bundled(Path(path))
    make: type[IsolatedVehicle | VehicleFmu] = IsolatedVehicle if isolated else VehicleFmu
    if is_system(Path(path)):
        make = PartsVehicle  # each part is isolated in any case
    return make(path, step_size=step_size, profile=profile, start_values=start_values)
