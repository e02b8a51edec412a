"""The response of one side of a vehicle, driving or braking, to the forces that are commanded.

The command u passes, in this order, a dead time d, a limit, a limit of power over speed, a limit
of its rate, and a first- or second-order lag T_2 F'' + T_1 F' + F = u. All are computed per step of
the controller, for all drives at once: u is held over a step, and the result is the mean of F over
the step. Without a limit of the rate it is exact, also for dead times of fractions of a step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NEGLIGIBLE = 1e-4  # [s] time constant below which a lag is ignored

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SideResponse:
    """The actuator of one side.

    Attributes:
        lag: Sum T_1 [s] of the time constants.
        second: Product T_2 [s2] of the two time constants, or 0 for a first-order lag.
        release: Lag [s] while the force falls, or None if it is the same.
        delay: Dead time [s].
        limit: Largest force [N].
        power: Largest power [W].
        rate: Largest change of the force [N/s].
        exponent: Exponent of the characteristic of a pedal; 1 is linear.
        full: Force [N] at which a characteristic that is not linear meets the linear one.
        late_limits: True if the limits bound the force behind the lag, and not the command.
    """

    lag: float = 0.0
    second: float = 0.0
    release: float | None = None
    delay: float = 0.0
    limit: float = np.inf
    power: float = np.inf
    rate: float = np.inf
    exponent: float = 1.0
    full: float = 1.0
    late_limits: bool = False

    def force(self, command: Array, speed: Array, step: float) -> Array:
        """Return the mean force (d, n) [N] over each step.

        Args:
            command: Commanded force (d, n) [N] of each drive, not negative.
            speed: Mean speed (d, n) [m/s] over each step.
            step: Duration of a step [s].
        """
        ceiling = np.minimum(self.limit, self.power / np.maximum(speed, 0.1))
        force = command
        if self.exponent != 1.0:
            force = self.full * (command / self.full) ** self.exponent
        if not self.late_limits:
            force = np.minimum(force, ceiling)
        if np.isfinite(self.rate):
            force = _limited_rate(force, self.rate * step)
        if self.release is not None:
            late = _convolved(force, SideResponse(delay=self.delay)._kernel(force, step))
            force = _two_lags(late, step, self.lag, self.release)
        else:
            force = _convolved(force, self._kernel(force, step))
        return np.minimum(force, ceiling) if self.late_limits else force

    def _kernel(self, force: Array, step: float) -> Array:
        """Return the mean force (n,) in each step after a command of 1 in the first one."""
        times = np.arange(force.shape[1] + 1) * step - self.delay
        impulse = _step_integral(times, self.lag, self.second) / step
        kernel = np.diff(impulse)
        kernel[1:] -= kernel[:-1].copy()
        return kernel


def _step_integral(time: Array, lag: float, second: float) -> Array:
    """Return the integral (n,) [s] of the response to a step of height 1 at time 0."""
    t = np.maximum(time, 0.0)
    if lag <= NEGLIGIBLE and second <= NEGLIGIBLE**2:
        return t
    if second <= NEGLIGIBLE * lag:
        return np.asarray(t + lag * np.expm1(-t / lag))
    root = np.sqrt(complex(lag * lag - 4.0 * second))
    if abs(root) < 1e-3 * lag:
        root = 1e-3 * lag + 0.0j
    one, two = 0.5 * (lag + root), 0.5 * (lag - root)
    parts = (one**2 * np.expm1(-t / one) - two**2 * np.expm1(-t / two)) / root
    return np.asarray(t + parts.real)


def _convolved(command: Array, kernel: Array) -> Array:
    """Return the sum (d, n) of the responses to each step's command."""
    size = 2 * kernel.size
    spectrum = np.fft.rfft(command, size) * np.fft.rfft(kernel, size)
    return np.asarray(np.fft.irfft(spectrum, size)[:, : kernel.size])


def _limited_rate(target: Array, most: float) -> Array:
    """Return the mean (d, n) of each step of a force that follows by at most ``most`` per step."""
    reached, means = np.zeros(target.shape[0]), target.copy()
    for k, wanted in enumerate(target.T):
        gap = wanted - reached
        size = np.abs(gap)
        if size.any():
            change = gap * np.minimum(1.0, most / np.maximum(size, 1e-300))
            # The share of the step until the target is reached is at most 1.
            means[:, k] = reached + change * (1.0 - 0.5 * np.minimum(size / most, 1.0))
            reached = reached + change
    return means


def _two_lags(target: Array, step: float, lag: float, release: float) -> Array:
    """Return the mean (d, n) of each step of a force that rises and falls with different lags."""
    taus = np.maximum([release, lag], NEGLIGIBLE)
    keeps = np.exp(-step / taus)
    shares = taus / step * (1.0 - keeps)
    reached, means = np.zeros(target.shape[0]), np.empty_like(target)
    for k in range(target.shape[1]):
        gap = reached - target[:, k]
        rises = (gap < 0.0).astype(int)
        means[:, k] = target[:, k] + gap * shares[rises]
        reached = target[:, k] + gap * keeps[rises]
    return means
