"""A car in a few lines, whose every parameter is known: what the estimators are tried on."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

FINE = 5e-3  # [s] of the car's own integration


@dataclass
class Car:
    """M v' + alpha v + c v |v| + constant = F, the force late and limited; held by its brakes."""

    mass: float = 1000.0
    friction: float = 100.0
    drag: float = 0.0
    constant: float = 0.0
    lag: float = 0.0
    delay: float = 0.0
    drive_limit: float = np.inf
    brake_limit: float = np.inf
    noise: float = 0.0
    sign: float = 1.0
    brake_gain: float = 1.0  # of the brake forces that arrive
    brake_lag: float | None = None  # [s]; None: that of the drive
    seed: int = 1  # of the noise
    step_size: float = 0.05
    warnings: list[str] = field(default_factory=list)
    path: Path = Path("car.fmu")

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:
        self.position, self.speed, self.acceleration = position, speed, 0.0
        self._true, self._force = speed, 0.0
        self._late = deque([0.0] * round(self.delay / FINE))
        self._random = np.random.default_rng(self.seed)

    def step(self, force: float, _grade: float = 0.0) -> None:
        force = min(max(self.sign * force, -self.brake_limit), self.drive_limit)
        force *= self.brake_gain if force < 0.0 else 1.0
        lag = self.lag if force >= 0.0 and self._force >= 0.0 else self.late_brake
        before = self._true
        keep = np.exp(-FINE / lag) if lag else 0.0
        for _ in range(round(self.step_size / FINE)):
            self._late.append(force)
            arrived = self._late.popleft()
            mean = arrived
            if lag:
                mean += (self._force - arrived) * lag / FINE * (1.0 - keep)
            self._force = arrived + (self._force - arrived) * keep
            v = self._true
            moving = self.constant if v > 0.0 or mean > self.constant else 0.0
            pull = mean - self.friction * v - self.drag * v * abs(v) - moving
            after = max(0.0, v + FINE / self.mass * pull)
            self.position += 0.5 * FINE * (v + after)
            self._true = after
        self.acceleration = (self._true - before) / self.step_size
        self.speed = self._true + self.noise * self._random.standard_normal()

    @property
    def late_brake(self) -> float:
        return self.lag if self.brake_lag is None else self.brake_lag

    def close(self) -> None: ...


@pytest.fixture
def car() -> Callable[..., Callable[[float | None], Car]]:
    """Makes the opener of cars with the parameters given; each car has noise of its own."""

    def opener(**parameters: float) -> Callable[[float | None], Car]:
        seeds = count(1)
        return lambda _fmu_step: Car(**({"seed": next(seeds)} | parameters))

    return opener
