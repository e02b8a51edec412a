"""The step tests as arrays: what was commanded, and how the vehicle moved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.side_response import Array, SideResponse

STANDSTILL = 0.05  # [m/s] speed below which steps are not fitted: brakes may hold the vehicle
LONG_SETTLING = 1.9  # [s] the same with a filtered speed
FADES = 1.2  # [s] time in which a filtered speed forgets a standstill
STOPS = 0.6  # [s] time before a standstill that is not fitted
SETTLING = 1.0  # [s] first part of a drive that is not fitted: earlier forces are unknown
ALIKE = 0.9  # share of the positions' disagreement with the speeds that a sensor's lag explains
INTEGRATED = 1e-6  # [m/s] disagreement below which the position is the speeds' integral


@dataclass(frozen=True)
class Measurements:
    """All steps of the tests, padded to the longest drive, and those of them that count.

    Attributes:
        step: Duration of a step [s].
        commands: Commands (d, n) [N] of driving and of braking, never negative.
        speed: Speed (d, n) [m/s] in each step.
        used: Flags (d, n) of the steps that count.
        acceleration: Mean acceleration (m,) [m/s2] over each step that counts.
        drive: Number (m,) of the drive of each step that counts.
    """

    step: float
    commands: tuple[Array, Array]
    speed: Array
    used: NDArray[np.bool_]
    acceleration: Array
    drive: NDArray[np.int_]

    @classmethod
    def of(
        cls,
        traces: Sequence[Trace],
        *,
        map_friction: float = 0.0,
        full: tuple[float, float] = (np.inf, np.inf),
        euler: bool = False,
        filtered: bool = False,
    ) -> Measurements:
        """Collect traces.

        Args:
            traces: Traces of drives.
            map_friction: Friction [N.s/m] that an inverse map subtracts from the force.
            full: Forces [N] of fully pressed pedals; more is not commanded.
            euler: True if the vehicle does forward Euler steps: its resistance is that of the
                speed at the beginning of a step, otherwise that of the mean speed.
            filtered: True if the speed may be filtered: what holds a standing vehicle is seen
                for some time after it has driven off.
        """
        shape = (len(traces), max(trace.force.size for trace in traces))
        commanded, speed, change = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        used = np.zeros(shape, bool)
        for row, trace in enumerate(traces):
            here = (row, slice(trace.force.size))
            before, after = trace.speed[:-1], trace.speed[1:]
            commanded[here] = trace.force - map_friction * before
            speed[here] = before if euler else 0.5 * (before + after)
            change[here] = (after - before) / trace.step_size
            first = LONG_SETTLING if filtered else SETTLING
            settled = np.arange(before.size) * trace.step_size >= first - 1e-9
            # A filtered speed still falls when the vehicle stands: its slope leads to 0 soon.
            stops = after + STOPS * np.minimum(change[here], 0.0) <= 0.0
            moving = np.minimum(before, after) > STANDSTILL
            used[here] = moving & settled & ~stops
            if filtered:
                stood = np.maximum.accumulate(np.where(moving, -1, np.arange(moving.size)))
                since = (np.arange(moving.size) - stood) * trace.step_size
                used[here] &= (stood < 0) | (since > FADES)
        return cls(
            step=traces[0].step_size,
            commands=(np.clip(commanded, 0.0, full[0]), np.clip(-commanded, 0.0, full[1])),
            speed=speed,
            used=used,
            acceleration=change[used],
            drive=np.repeat(np.arange(shape[0]), used.sum(axis=1)),
        )

    @property
    def largest(self) -> float:
        """The largest command [N] of both sides."""
        return max(float(command.max()) for command in self.commands) or 1.0

    def acting(self, side: int, response: SideResponse) -> Array:
        """Return the force (m,) that acts over the largest command; braking is negative."""
        return self.acting_everywhere(side, response)[self.used] / self.largest

    def acting_everywhere(self, side: int, response: SideResponse) -> Array:
        """Return the force (d, n) [N] that acts in each step; braking is negative."""
        force = response.force(self.commands[side], self.speed, self.step)
        return force if side == 0 else -force

    def resistances(self) -> list[Array]:
        """Return the terms (m,) of the resistance: constant, linear and quadratic."""
        v = self.speed[self.used]
        return [-np.ones_like(v), -v, -v * np.abs(v)]


def sensor_lag(traces: Sequence[Trace]) -> float | None:
    """Return the lag [s] of the speed output behind the motion, from the positions.

    A speed output v' with a lag T is late: the true speed is v + T v'. Over a step the position
    changes by h (v + v+) / 2 + T (v+ - v). T = -h/2 is a vehicle of forward Euler steps.

    Returns:
        Lag, or 0 without one. None if the position is the integral of the speeds, which tells
        nothing.
    """
    h = traces[0].step_size
    moving = [np.minimum(t.speed[:-1], t.speed[1:]) > STANDSTILL for t in traces]
    pairs = list(zip(traces, moving, strict=True))
    change = np.concatenate([np.diff(t.speed)[used] for t, used in pairs])
    mean = np.concatenate([(0.5 * (t.speed[1:] + t.speed[:-1]))[used] for t, used in pairs])
    apart = np.concatenate([np.diff(t.position)[used] for t, used in pairs]) - h * mean
    if not change.any() or np.abs(apart).max() < INTEGRATED * h:
        return None
    lag = float(apart @ change / (change @ change))
    explained = 1.0 - float(((apart - lag * change) ** 2).sum() / (apart**2).sum())
    return lag if explained > ALIKE else 0.0
