"""Vehicles whose forces act late, each as good as the description of its actuator or better."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from controller import Actuator, ActuatorSide

PARTS = 6  # steps of the plant within a control step
MASS, FRICTION = 1000.0, 100.0

sides = st.builds(
    ActuatorSide,
    scale=st.sampled_from([1.0, 0.8, 1.5]),
    lag=st.sampled_from([0.0, 0.1, 0.3, 0.8]),
    delay=st.sampled_from([0.0, 0.1, 0.17, 0.3]),
    rate=st.sampled_from([np.inf, np.inf, 6000.0, 20000.0]),
)
actuators = st.builds(Actuator, drive=sides, brake=sides)


def late(delay):
    """An actuator with this dead time [s] on both sides."""
    return Actuator(ActuatorSide(delay=delay), ActuatorSide(delay=delay))


def weak(actuator, limit):
    """The same actuator, whose brake is limited to ``limit`` [N]."""
    b = actuator.brake
    brake = ActuatorSide(b.scale, b.lag, b.delay, limit, b.power_from, b.rate)
    return Actuator(actuator.drive, brake)


class LatePlant:
    """A vehicle with one actuator for both signs, or two; lags, dead times and rates are drawn.

    Its ``output`` is the speed, filtered by at most ``sensor`` [s].
    """

    def __init__(self, speed, actuator, seed, dt=0.05, sensor=0.0):
        rng = np.random.default_rng(seed)
        self.travel, self.speed, self._h = 0.0, speed, dt / PARTS
        self._sides = actuator.drive, actuator.brake
        self._two, self._rate_first = bool(rng.integers(2)), bool(rng.integers(2))
        share = rng.choice([0.0, 1.0, rng.uniform()], 3)
        self._lags = [share[0] * side.lag for side in self._sides]
        delays = [share[1] * side.delay for side in self._sides]
        self._late = [round(d / self._h) for d in (delays if self._two else [max(delays)] * 2)]
        rates = [side.rate for side in self._sides]
        rates = rates if self._two else [min(rates)] * 2
        self._most = [(1.0 + share[2]) * rate * self._h for rate in rates]
        self._told = [0.0] * (1 + max(self._late))
        self._behind, self._acts = [0.0, 0.0], [0.0, 0.0]
        self.output, self._filter = speed, sensor * rng.choice([1.0, rng.uniform(0.1, 1.0)])

    def step(self, told):
        """Hold the commanded force [N] for a control step."""
        for _ in range(PARTS):
            self._told = [*self._told[1:], told]
            force, v = self._force(), self.speed
            self.speed = max(0.0, v + self._h * (force - FRICTION * v) / MASS)
            self.travel += 0.5 * self._h * (v + self.speed)
            self._see(v)

    def _see(self, before):
        """Filter the speed, which has changed by a straight line from ``before`` [m/s]."""
        behind = self._filter * (self.speed - before) / self._h
        left = np.exp(-self._h / self._filter) if self._filter > 0.0 else 0.0
        self.output = self.speed - behind + (self.output - before + behind) * left

    def _force(self):
        late = [self._told[-1 - n] for n in self._late]
        drive, brake = self._sides
        if self._two:
            wanted = max(late[0], 0.0) / drive.scale, -min(late[1], 0.0) / brake.scale
            wanted = wanted[0], min(wanted[1], brake.limit)
            return self._follow(0, wanted[0], 0) - self._follow(1, wanted[1], 1)
        if late[0] > 0.0:
            return self._follow(0, late[0] / drive.scale, 0)
        return self._follow(0, max(late[0] / brake.scale, -brake.limit), 1)

    def _follow(self, i, wanted, side):
        """The force of actuator ``i`` a part later, with the lag and rate of a side."""
        lag, most = self._lags[side], self._most[side]
        share = 1.0 if lag == 0.0 else 1.0 - np.exp(-self._h / lag)
        if self._rate_first:
            self._behind[i] += np.clip(wanted - self._behind[i], -most, most)
            self._acts[i] += share * (self._behind[i] - self._acts[i])
        else:
            self._acts[i] += np.clip(share * (wanted - self._acts[i]), -most, most)
        return self._acts[i]
