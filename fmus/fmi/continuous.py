"""The continuous part of a Model Exchange FMU for a solver: x' = f(t, x), z = g(t, x)."""

from collections.abc import Callable
from ctypes import byref, c_double, c_size_t, c_void_p
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from fmus.fmi.calls import CallFailedError, Calls
from fmus.fmi.status import DISCARD, WARNING

SMALLEST = 1e-13  # smallest step, relative to the greater of the time and 1 s
LONGEST = 0.02  # [s] step with event indicators, as two crossings in one step would be missed


class IntegrationError(Exception):
    """The solver cannot go on; the message says why and when."""


class UndefinedError(Exception):
    """The FMU has no finite derivatives at a trial point: a smaller step may avoid it."""


class ContinuousSystem:
    """The right-hand side and the event indicators of an FMU in continuous-time mode.

    Attributes:
        nx: Number of continuous states.
        nz: Number of event indicators.
    """

    def __init__(self, calls: Calls) -> None:
        self.nx, self.nz = counts(calls)
        self._component = calls.component
        self._names = names = calls.exchange_names()
        self._set_time = calls.function(names["set_time"])
        self._time = c_double()
        self._size, self._number = c_size_t(self.nx), c_size_t(self.nz)
        self._z = np.zeros(self.nz)
        if self.nx:
            self._set_states = calls.function(names["set_states"])
            self._get_states = calls.function(names["get_states"])
            self._get_derivatives = calls.function(names["get_derivatives"])
            self._get_nominals = calls.function(names["get_nominals"])
        if self.nz:
            self._get_indicators = calls.function(names["get_indicators"])

    def states(self) -> NDArray[np.float64]:
        """The present states of the FMU."""
        x = np.zeros(self.nx)
        if self.nx:
            status = self._get_states(self._component, x.ctypes.data_as(c_void_p), self._size)
            self._require(status, "get_states")
        if not np.isfinite(x).all():
            raise IntegrationError(
                f"state {_first_not_finite(x)} of {self.nx} is {x[_first_not_finite(x) - 1]}"
            )
        return x

    def nominals(self) -> NDArray[np.float64]:
        """Return the states' nominal values; a value that is no positive number becomes 1."""
        x = np.ones(self.nx)
        if self.nx:
            status = self._get_nominals(self._component, x.ctypes.data_as(c_void_p), self._size)
            if status not in (0, WARNING):
                return np.ones(self.nx)
        x = np.abs(x)
        return np.where(np.isfinite(x) & (x > 0.0), x, 1.0)

    def set_time(self, time: float) -> None:
        """Set the time [s] of the FMU."""
        self._time.value = time
        self._require(self._set_time(self._component, self._time), "set_time")

    def set(self, time: float, x: NDArray[np.float64]) -> None:
        """Set the FMU to a point of its trajectory."""
        self.set_time(time)
        if self.nx:
            self._put(x.ctypes.data)

    def derivatives(self, time: float, x: int, slope: int) -> None:
        """Write x' to an address.

        Args:
            time: Time [s].
            x: Address of the states.
            slope: Address for the derivatives.

        Raises:
            UndefinedError: the FMU discards this point.
            CallFailedError: the FMU fails.
        """
        self.set_time(time)
        self._put(x)
        status = self._get_derivatives(self._component, c_void_p(slope), self._size)
        self._require(status, "get_derivatives")

    def signs(self, time: float, x: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return the signs of the event indicators; a change is an event (FMI 2.0.4, 3.1.1)."""
        if not self.nz:
            return self._z > 0.0
        self.set(time, x)
        pointer = self._z.ctypes.data_as(c_void_p)
        status = self._get_indicators(self._component, pointer, self._number)
        self._require(status, "get_indicators")
        if not np.isfinite(self._z).all():
            odd = _first_not_finite(self._z)
            raise IntegrationError(
                f"event indicator {odd} of {self.nz} is {self._z[odd - 1]} at {time:.9g} s"
            )
        return self._z > 0.0

    def undefined(self, slope: NDArray[np.float64], time: float) -> str:
        """Name the derivative that is no finite number, or return an empty text."""
        if np.isfinite(slope).all():
            return ""
        odd = _first_not_finite(slope)
        return f"derivative {odd} of {self.nx} is {slope[odd - 1]} at {time:.9g} s"

    def _put(self, x: int) -> None:
        status = self._set_states(self._component, c_void_p(x), self._size)
        self._require(status, "set_states")

    def _require(self, status: int, what: str) -> None:
        if status == DISCARD:
            raise UndefinedError(f"{self._names[what]} discards this point")
        if status not in (0, WARNING):
            raise CallFailedError(self._names[what], status)


class Solver(Protocol):
    """Integrates a continuous system.

    Attributes:
        x: States at the end of the last step.
        remedy: Advice on the profile for when too many steps are needed.
    """

    x: NDArray[np.float64]
    remedy: str

    def restart(self, time: float, x: NDArray[np.float64], nominals: NDArray[np.float64]) -> None:
        """Start again, after an event or with new inputs."""

    def expect_events(self) -> None:
        """Make the next step a short one: the next event may follow soon."""

    def step(self, stop: float) -> float:
        """Do one internal step, not beyond ``stop`` [s], and return where it ends [s].

        Raises:
            IntegrationError: there is no step that is small enough.
            CallFailedError: the FMU fails.
        """

    def at(self, time: float) -> NDArray[np.float64]:
        """Return the states at a time within the last step."""

    def close(self) -> None:
        """Free everything."""


def locate(
    crossed: Callable[[float], bool], before: float, after: float, resolution: float
) -> float:
    """Return the time [s] of a crossing by bisection, at most ``resolution`` after it.

    Args:
        crossed: Function that returns whether the crossing has happened at a time between the two.
        before: Time [s] at which it has not happened.
        after: Time [s] at which it has happened.
        resolution: Resolution [s].
    """
    while after - before > resolution:
        middle = before + 0.5 * (after - before)
        if not before < middle < after:
            break
        if crossed(middle):
            after = middle
        else:
            before = middle
    return after


def counts(calls: Calls) -> tuple[int, int]:
    """Return the numbers of states and event indicators; in FMI 3 they depend on parameters."""
    found = [calls.model.states, calls.model.event_indicators]
    if calls.model.fmi_version == "3.0":
        for index, name in enumerate(
            ("fmi3GetNumberOfContinuousStates", "fmi3GetNumberOfEventIndicators")
        ):
            number = c_size_t()
            function = calls.library.optional(name)
            if function is not None and function(calls.component, byref(number)) in (0, WARNING):
                found[index] = number.value
    return found[0], found[1]


def _first_not_finite(values: NDArray[np.float64]) -> int:
    return int(np.argmin(np.isfinite(values))) + 1
