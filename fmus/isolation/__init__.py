"""Any vehicle FMU: one that is not ours runs in a process of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fmus.bundled import bundled_fmu
from fmus.isolation.vehicle import IsolatedVehicle
from fmus.vehicle import VehicleFmu

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from fmus.profile import Value, VehicleProfile

__all__ = ["IsolatedVehicle", "open_vehicle"]
