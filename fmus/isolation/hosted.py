"""The adapters hosted in an FMU's process, as plain numbers; a controller FMU is its own."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

from fmus.driving.vehicle import VehicleFmu
from fmus.profile.preparation import Prepared


class Hosted(Protocol):
    """The adapter that runs one FMU for one episode.

    Attributes:
        warnings: Warnings for the user.
        time: Time [s] at the end of the last step.
    """

    def __init__(self, prepared: Any, folder: Path) -> None: ...

    @property
    def warnings(self) -> list[str]:
        """Warnings for the user."""

    @property
    def time(self) -> float:
        """Time [s] at the end of the last step."""

    @staticmethod
    def numbers(prepared: Any, /) -> tuple[int, int]:
        """Return the numbers of values in each request and in each reply."""

    def start(self, numbers: Sequence[float]) -> None:
        """Begin the episode at time 0."""

    def step(self, numbers: Sequence[float]) -> None:
        """Do one step; the first number is the client's processor."""

    def state(self) -> Sequence[float]:
        """Return the numbers of a reply."""

    def close(self) -> None:
        """End the FMU."""


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
