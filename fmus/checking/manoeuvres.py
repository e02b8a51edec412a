"""Scripted drives of a vehicle: forces in, what it did out; every one with a fresh instance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from time import perf_counter
from typing import TYPE_CHECKING, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray


class Drivable(Protocol):
    """What a manoeuvre needs of a vehicle: that of ``fmus.Vehicle``."""

    warnings: list[str]

    @property
    def path(self) -> Path:
        """The .fmu file."""

    @property
    def step_size(self) -> float:
        """[s]."""

    @property
    def position(self) -> float:
        """[m]."""

    @property
    def speed(self) -> float:
        """[m/s]."""

    @property
    def acceleration(self) -> float:
        """[m/s2]."""

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:
        """Begin (again) at time 0."""

    def step(self, force: float) -> None:
        """Hold ``force`` [N] for one step."""

    def close(self) -> None:
        """Free everything."""


Opener = Callable[[float | None], Drivable]
"""Makes a fresh vehicle whose FMU does steps of the size given [s]; None: as its profile says.

The steps of the vehicle itself (how long a force is held) are always the same.
"""


@dataclass(frozen=True)
class Phase:
    """A constant force, held for a time or until the speed has come where it should."""

    force: float  # [N]
    duration: float  # [s] at most
    above: float = -np.inf  # [m/s] ends when the speed falls below
    below: float = np.inf  # [m/s] ends when the speed rises above


@dataclass(frozen=True, eq=False)
class Trace:
    """What a vehicle did: n steps, n + 1 instants.

    Attributes:
        step_size: of the vehicle [s].
        force: (n,) held over each step [N].
        position: (n + 1,) [m].
        speed: (n + 1,) [m/s].
        acceleration: (n + 1,) as the vehicle reports it [m/s2].
        cost: (n,) wall clock of each step [s].
        warnings: of the vehicle.
    """

    step_size: float
    force: NDArray[np.float64] = field(repr=False)
    position: NDArray[np.float64] = field(repr=False)
    speed: NDArray[np.float64] = field(repr=False)
    acceleration: NDArray[np.float64] = field(repr=False)
    cost: NDArray[np.float64] = field(repr=False)
    warnings: tuple[str, ...]

    @property
    def time(self) -> NDArray[np.float64]:
        """(n + 1,) [s]."""
        return np.asarray(np.arange(self.speed.size) * self.step_size, np.float64)

    def same_motion(self, other: Trace) -> bool:
        """Whether every bit of position, speed and acceleration is the other's."""
        return all(
            np.array_equal(getattr(self, name), getattr(other, name))
            for name in ("position", "speed", "acceleration")
        )


def drive(
    opener: Opener,
    phases: Iterable[Phase],
    *,
    speed: float = 0.0,
    fmu_step: float | None = None,
) -> Trace:
    """Drive a fresh vehicle through phases of constant force.

    Args:
        opener: makes the vehicle.
        phases: one after the other.
        speed: at the start [m/s].
        fmu_step: of the FMU itself [s]; None: as its profile says.

    Raises:
        FmuError: the vehicle cannot be opened or started, or fails on the way.
    """
    vehicle = opener(fmu_step)
    try:
        vehicle.start(speed=speed)
        log = _Log(vehicle)
        for phase in phases:
            _hold(vehicle, phase, log)
        return log.trace(vehicle)
    finally:
        vehicle.close()


def replay(
    opener: Opener, forces: Sequence[float] | NDArray[np.float64], *, speed: float = 0.0,
    fmu_step: float | None = None,
) -> Trace:  # fmt: skip
    """Drive a fresh vehicle with one force per step; see :func:`drive`."""
    vehicle = opener(fmu_step)
    try:
        vehicle.start(speed=speed)
        log = _Log(vehicle)
        for force in forces:
            log.step(vehicle, float(force))
        return log.trace(vehicle)
    finally:
        vehicle.close()


def _hold(vehicle: Drivable, phase: Phase, log: _Log) -> None:
    for _ in range(round(phase.duration / vehicle.step_size)):
        if not phase.above <= vehicle.speed <= phase.below:
            return
        log.step(vehicle, phase.force)


class _Log:
    """The rows of a drive as it goes on."""

    def __init__(self, vehicle: Drivable) -> None:
        self._forces: list[float] = []
        self._costs: list[float] = []
        self._motion = [(vehicle.position, vehicle.speed, vehicle.acceleration)]

    def step(self, vehicle: Drivable, force: float) -> None:
        begin = perf_counter()
        vehicle.step(force)
        self._costs.append(perf_counter() - begin)
        self._forces.append(force)
        self._motion.append((vehicle.position, vehicle.speed, vehicle.acceleration))

    def trace(self, vehicle: Drivable) -> Trace:
        position, speed, acceleration = np.array(self._motion).T
        return Trace(
            vehicle.step_size,
            np.array(self._forces),
            np.ascontiguousarray(position),
            np.ascontiguousarray(speed),
            np.ascontiguousarray(acceleration),
            np.array(self._costs),
            tuple(getattr(vehicle, "warnings", ())),
        )
