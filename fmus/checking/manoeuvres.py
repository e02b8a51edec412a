"""Scripted drives: a fresh vehicle receives forces, and its motion is recorded as a trace."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from fmus.description.model import Value
from fmus.errors import FmuError
from fmus.interfaces.vehicle import Vehicle
from fmus.isolation import open_vehicle
from fmus.profile.vehicle_profile import Limits, VehicleProfile

Opener = Callable[[float | None], Vehicle]
"""Function that makes a new vehicle whose FMU does steps of the size given [s], or with None as its
profile says. The vehicle's own step, for which a force is held, does not change.
"""


UNGUARDED = Limits(speed=1e9, position_jump=1e9, acceleration=1e12)


def without_guards(profile: VehicleProfile) -> VehicleProfile:
    """Return the profile with limits that only absurd values exceed."""
    return profile.model_copy(update={"limits": UNGUARDED})


def opener_of(
    path: Path,
    *,
    step_size: float,
    profile: VehicleProfile,
    start_values: Mapping[str, Value] | None = None,
    isolated: bool | None = None,
) -> Opener:
    """Return an opener of fresh vehicles with one FMU and profile; it takes the FMU's own step.

    Args:
        path: Path of the .fmu file.
        step_size: Step size for which a force is held [s].
        profile: Profile of the vehicle.
        start_values: Further start values by variable name.
        isolated: True to run it in a process of its own; None for this unless it is a shipped FMU.
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


@dataclass(frozen=True)
class Phase:
    """A constant force, held for a time or until the speed reaches a bound."""

    force: float  # [N]
    duration: float  # [s] longest duration
    above: float = -np.inf  # [m/s] ends when the speed falls below
    below: float = np.inf  # [m/s] ends when the speed rises above
    grade: float = 0.0  # [rad] grade of the road, uphill positive


@dataclass(frozen=True, eq=False)
class Trace:
    """The record of a drive: n steps, n + 1 instants.

    Attributes:
        step_size: Step size of the vehicle [s].
        force: Force (n,) held over each step [N].
        position: Position (n + 1,) [m].
        speed: Speed (n + 1,) [m/s].
        acceleration: Acceleration (n + 1,) [m/s2], as the vehicle reports it.
        cost: Wall-clock time (n,) of each step [s].
        warnings: Warnings of the vehicle.
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
        """Instants (n + 1,) [s]."""
        return np.asarray(np.arange(self.speed.size) * self.step_size, np.float64)

    def same_motion(self, other: Trace) -> bool:
        """Return whether position, speed and acceleration equal the other's bit by bit."""
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
        opener: Function that opens the vehicle.
        phases: Phases, one after the other.
        speed: Speed at the start [m/s].
        fmu_step: Step of the FMU itself [s], or None for the profile's.

    Raises:
        FmuError: the vehicle cannot be opened or started, or fails on the way.
    """
    attempt = try_to_drive((speed,), opener, phases, fmu_step=fmu_step)[0]
    if attempt.error is not None:
        raise attempt.error
    assert attempt.trace is not None
    return attempt.trace


@dataclass(frozen=True)
class Attempt:
    """A drive up to its end or failure."""

    trace: Trace | None  # None if the vehicle did not start
    error: FmuError | None  # error that ended the drive


def try_to_drive(
    speeds: Sequence[float],
    opener: Opener,
    phases: Iterable[Phase],
    *,
    fmu_step: float | None = None,
) -> list[Attempt]:
    """Do the same as :func:`drive` from several speeds in turn, until one drive fails.

    A failure is returned together with the trace up to it.
    One vehicle is started again for each speed, so that its FMU is unpacked only once.
    """
    attempts: list[Attempt] = []
    vehicle: Vehicle | None = None
    try:
        vehicle = opener(fmu_step)
        for speed in speeds:
            attempts.append(_attempt(vehicle, phases, speed))
            if attempts[-1].error is not None:
                break
    except FmuError as caught:
        attempts.append(Attempt(None, caught))
    finally:
        if vehicle is not None:
            vehicle.close()
    return attempts


def _attempt(vehicle: Vehicle, phases: Iterable[Phase], speed: float) -> Attempt:
    log: _DriveLog | None = None
    try:
        vehicle.start(speed=speed)
        log = _DriveLog(vehicle)
        for phase in phases:
            _hold(vehicle, phase, log)
    except FmuError as caught:
        return Attempt(log.trace() if log is not None else None, caught)
    return Attempt(log.trace(), None)


def _hold(vehicle: Vehicle, phase: Phase, log: _DriveLog) -> None:
    for _ in range(round(phase.duration / vehicle.step_size)):
        if not phase.above <= vehicle.speed <= phase.below:
            return
        log.step(phase.force, phase.grade)


class _DriveLog:
    """Collects the samples of a drive."""

    def __init__(self, vehicle: Vehicle) -> None:
        self._vehicle = vehicle
        self._forces: list[float] = []
        self._costs: list[float] = []
        self._motion = [(vehicle.position, vehicle.speed, vehicle.acceleration)]

    def step(self, force: float, grade: float) -> None:
        vehicle = self._vehicle
        begin = perf_counter()
        vehicle.step(force, grade)
        self._costs.append(perf_counter() - begin)
        self._forces.append(force)
        self._motion.append((vehicle.position, vehicle.speed, vehicle.acceleration))

    def trace(self) -> Trace:
        position, speed, acceleration = np.array(self._motion).T
        return Trace(
            self._vehicle.step_size,
            np.array(self._forces),
            np.ascontiguousarray(position),
            np.ascontiguousarray(speed),
            np.ascontiguousarray(acceleration),
            np.array(self._costs),
            tuple(self._vehicle.warnings),
        )
