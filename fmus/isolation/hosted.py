"""The adapters hosted in an FMU's process, as plain numbers; a controller FMU is its own."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fmus.driving.controller import ControllerFmu
from fmus.driving.part import PartFmu
from fmus.driving.vehicle import VehicleFmu
from fmus.profile.preparation import Prepared


class HostedVehicle:
    """Adapter of a vehicle: START position [m], speed [m/s]; STEP force [N], grade [rad].

    Args:
        prepared: Prepared vehicle.
        folder: Folder of its unpacked FMU.
    """

    def __init__(self, prepared: Prepared, folder: Path) -> None:
        self._vehicle = VehicleFmu.unpacked(prepared, folder)
        self._has_records = bool(prepared.wiring.recorded)

    @staticmethod
    def numbers(prepared: Prepared) -> tuple[int, int]:
        """Return the numbers of values in requests and in replies."""
        return 3, 3 + len(prepared.wiring.recorded)

    @property
    def warnings(self) -> list[str]:
        """Warnings of the vehicle."""
        return self._vehicle.warnings

    @property
    def time(self) -> float:
        """Time [s] of the vehicle."""
        return self._vehicle.time

    def start(self, numbers: Sequence[float]) -> None:
        """Start the vehicle at a position and a speed."""
        self._vehicle.start(position=numbers[0], speed=numbers[1])

    def step(self, numbers: Sequence[float]) -> None:
        """Do one step under a force, on a grade."""
        self._vehicle.step(numbers[1], numbers[2])

    def state(self) -> Sequence[float]:
        """Return position, speed, acceleration and the recorded values."""
        vehicle = self._vehicle
        state = vehicle.position, vehicle.speed, vehicle.acceleration
        return (*state, *vehicle.recorded) if self._has_records else state

    def close(self) -> None:
        """End the FMU."""
        self._vehicle.close()


Hosted = HostedVehicle | ControllerFmu | PartFmu
"""The adapter that runs one FMU for one episode: START and STEP take the numbers of a request, of
which a step's first is the client's processor; ``state`` has the numbers of a reply."""
