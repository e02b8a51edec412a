"""What an FMU's process runs: a vehicle or a controller, told and asked in plain numbers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

from fmus.driving.controller import ControllerFmu
from fmus.driving.vehicle import VehicleFmu
from fmus.profile.controller_preparation import PreparedController
from fmus.profile.preparation import Prepared


class Hosted(Protocol):
    """One FMU for one episode.

    Attributes:
        warnings: what the user should know.
        time: as of the last step [s].
    """

    def __init__(self, prepared: Any, folder: Path) -> None: ...

    @property
    def warnings(self) -> list[str]:
        """What the user should know of the FMU."""

    @property
    def time(self) -> float:
        """As of the last step [s]."""

    @staticmethod
    def numbers(prepared: Any, /) -> tuple[int, int]:
        """How many numbers each request and each reply has."""

    def start(self, numbers: Sequence[float]) -> None:
        """Begin at time 0."""

    def step(self, numbers: Sequence[float]) -> None:
        """Do one step; the first number is the client's processor."""

    def state(self) -> Sequence[float]:
        """The numbers of a reply."""

    def close(self) -> None:
        """End the FMU."""


class HostedVehicle:
    """A vehicle: START position [m], speed [m/s]; STEP force [N], grade [rad].

    Args:
        prepared: the vehicle.
        folder: Folder of its unpacked FMU.
    """

    def __init__(self, prepared: Prepared, folder: Path) -> None:
        self._vehicle = VehicleFmu.unpacked(prepared, folder)
        self._has_records = bool(prepared.wiring.recorded)

    @staticmethod
    def numbers(prepared: Prepared) -> tuple[int, int]:
        """Of requests and of replies."""
        return 3, 3 + len(prepared.wiring.recorded)

    @property
    def warnings(self) -> list[str]:
        """Of the vehicle."""
        return self._vehicle.warnings

    @property
    def time(self) -> float:
        """Of the vehicle [s]."""
        return self._vehicle.time

    def start(self, numbers: Sequence[float]) -> None:
        """At a position and a speed."""
        self._vehicle.start(position=numbers[0], speed=numbers[1])

    def step(self, numbers: Sequence[float]) -> None:
        """Under a force, on a grade."""
        self._vehicle.step(numbers[1], numbers[2])

    def state(self) -> Sequence[float]:
        """Position, speed, acceleration and what is recorded."""
        vehicle = self._vehicle
        state = vehicle.position, vehicle.speed, vehicle.acceleration
        return (*state, *vehicle.recorded) if self._has_records else state

    def close(self) -> None:
        """End the FMU."""
        self._vehicle.close()


class HostedController:
    """A controller: START nothing; STEP its inputs, in its own units; answers its output.

    Args:
        prepared: the controller.
        folder: Folder of its unpacked FMU.
    """

    def __init__(self, prepared: PreparedController, folder: Path) -> None:
        self._controller = ControllerFmu(prepared, folder)

    @staticmethod
    def numbers(prepared: PreparedController) -> tuple[int, int]:
        """Of requests and of replies."""
        return 1 + len(prepared.wiring.inputs), 1

    @property
    def warnings(self) -> list[str]:
        """None so far: what it is told is looked at by who tells it."""
        return []

    @property
    def time(self) -> float:
        """Of the controller [s]."""
        return self._controller.time

    def start(self, _numbers: Sequence[float]) -> None:
        """With the start values of its profile."""
        self._controller.start()

    def step(self, numbers: Sequence[float]) -> None:
        """Told its inputs."""
        self._controller.step(numbers[1:])

    def state(self) -> Sequence[float]:
        """What it answers."""
        return (self._controller.answer,)

    def close(self) -> None:
        """End the FMU."""
        self._controller.close()
