"""The classical Runge-Kutta method of order 4, with a step size from an error estimate."""

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from fmus.fmi.continuous import (
    LONGEST,
    SMALLEST,
    ContinuousSystem,
    IntegrationError,
    UndefinedError,
)

FIRST_STEP = 1e-5  # [s] short: another event may follow soon
SAFETY, LEAST, MOST = 0.9, 0.1, 4.0  # factors of a step's length: Hairer, Norsett, Wanner, II.4


class RungeKutta:
    """An integrator that does each step once whole and once in halves to estimate the error.

    Both results combined are of order 5 (Richardson; Hairer, Norsett & Wanner 1993, II.4).

    Args:
        system: System to integrate.
        tolerance: Relative tolerance; the absolute one is this times a state's nominal value.
    """

    remedy = '`solver = "cvode"`, it is for stiff systems, or a greater `tolerance`,'

    def __init__(self, system: ContinuousSystem, tolerance: float) -> None:
        self._system = system
        self._tolerance = tolerance
        self._next = FIRST_STEP
        self._slopes = np.zeros((4, system.nx))
        self._trial = np.zeros(system.nx)
        self._time = self._start = 0.0
        self._nominals = np.ones(system.nx)
        self.x = self._x_start = np.zeros(system.nx)

    def restart(  # noqa: D102 - as in Solver
        self, time: float, x: NDArray[np.float64], nominals: NDArray[np.float64]
    ) -> None:
        self._time, self.x, self._nominals = time, x.copy(), nominals

    def expect_events(self) -> None:  # noqa: D102
        self._next = FIRST_STEP

    def step(self, stop: float) -> float:  # noqa: D102
        start, x = self._time, self.x
        if self._system.nz:
            stop = min(stop, start + LONGEST)
        if not self._system.nx:
            self._arrive(start, x, stop, x)
            return stop
        why = ""
        while True:
            last = self._next >= (stop - start) * (1.0 - 1e-9)
            h = stop - start if last else self._next
            try:
                end, error = self._propose(start, x, h)
                why = f"the local error is {error:.3g} times the tolerance"
            except UndefinedError as undefined:
                error, why = float("inf"), str(undefined)
            if error <= 1.0:
                break
            factor = max(LEAST, SAFETY * error**-0.2) if isfinite(error) else LEAST
            self._next = h * factor
            if self._next < SMALLEST * max(1.0, abs(start)):
                raise IntegrationError(f"{why}; no step from {start:.9g} s is small enough")
        grown = h * (min(MOST, SAFETY * error**-0.2) if error > 0.0 else MOST)
        self._next = max(self._next, grown) if last else grown
        self._arrive(start, x, stop if last else start + h, end)
        return self._time

    def at(self, time: float) -> NDArray[np.float64]:  # noqa: D102
        if not self._system.nx:
            return self.x
        return self._propose(self._start, self._x_start, time - self._start)[0]

    def close(self) -> None:
        """Do nothing: there is nothing to free."""

    def _arrive(
        self, start: float, x_start: NDArray[np.float64], end: float, x: NDArray[np.float64]
    ) -> None:
        self._start, self._x_start = start, x_start
        self._time, self.x = end, x

    def _propose(
        self, time: float, x: NDArray[np.float64], h: float
    ) -> tuple[NDArray[np.float64], float]:
        """Return the states after ``h``, and the error relative to the tolerance."""
        whole = self._classical(time, x, h)
        halves = self._classical(time + 0.5 * h, self._classical(time, x, 0.5 * h), 0.5 * h)
        difference = (halves - whole) / 15.0
        scale = self._tolerance * (self._nominals + np.maximum(np.abs(x), np.abs(halves)))
        return halves + difference, float(np.max(np.abs(difference) / scale))

    def _classical(self, time: float, x: NDArray[np.float64], h: float) -> NDArray[np.float64]:
        k = self._slopes
        self._slope(time, x, k[0])
        self._slope(time + 0.5 * h, x + 0.5 * h * k[0], k[1])
        self._slope(time + 0.5 * h, x + 0.5 * h * k[1], k[2])
        self._slope(time + h, x + h * k[2], k[3])
        after: NDArray[np.float64] = x + h / 6.0 * (k[0] + 2.0 * (k[1] + k[2]) + k[3])
        if not np.isfinite(after).all():
            raise UndefinedError(f"the states leave the range of numbers at {time:.9g} s")
        return after

    def _slope(self, time: float, x: NDArray[np.float64], slope: NDArray[np.float64]) -> None:
        self._trial[:] = x
        self._system.derivatives(time, self._trial.ctypes.data, slope.ctypes.data)
        problem = self._system.undefined(slope, time)
        if problem:
            raise UndefinedError(problem)
