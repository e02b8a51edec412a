"""The wrapper of a controller of another package: it checks answers and reports errors."""

from collections.abc import Callable
from math import isfinite
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller import (
    Acceleration,
    Decision,
    Force,
    Observation,
    PlugIn,
    PlugInError,
    Setup,
    Speed,
)
from giveway.plug_ins.faults import blamed, read_only, shown

Array = NDArray[np.float64]

_ROUNDING = 1e-8  # tolerance of the force limit as a share of it, as solvers need
_ARRAYS = ("obstacle_positions", "vehicles", "lane_speeds", "person_ids")
_FURTHEST = 10_000  # largest prediction horizon [steps]


class PluggedIn:
    """A controller of another package, which the co-simulation asks like giveway's own.

    Its force is limited to that of the actuator. The next observation has the force that acted.

    Args:
        name: Name of the controller and its ego, for messages.
        make: Function that makes the plug-in.
        setup: Setup of the drive.

    Raises:
        PlugInError: it cannot be made, or is no controller.
    """

    def __init__(self, name: str, make: Callable[[], object], setup: Setup) -> None:
        self._name, self._setup = name, setup
        with blamed(name, PlugInError, " when it was made"):
            plug_in = make()
        if not isinstance(plug_in, PlugIn):
            msg = f"{name} made {shown(plug_in)}: expected an object with a method control"
            raise PlugInError(msg)
        self._plug_in = plug_in
        with blamed(name, PlugInError, " when it was asked for its horizon"):
            horizon = getattr(plug_in, "horizon", 0)
            self.foresees = bool(getattr(plug_in, "foresees", False))
        if not _is_count(horizon):
            msg = f"{name} has horizon = {shown(horizon)}: expected a whole number of steps"
            raise PlugInError(f"{msg} from 0 to {_FURTHEST}")
        self.horizon = int(horizon)
        if self.foresees and not self.horizon:
            msg = f"{name} has foresees = True and horizon = 0: expected steps to foresee"
            raise PlugInError(msg)

    def reset(self) -> None:
        """Forget the past."""
        self._call_if_there("reset")

    def control(self, observation: Observation) -> Decision:
        """Decide on the force at t_k.

        Raises:
            PlugInError: the plug-in raises, or returns no finite number.
        """
        with blamed(self._name, PlugInError):
            answer = self._plug_in.control(_unwritable(observation))
        setup = self._setup
        force, reason = self._force_of(answer, observation.speed)
        if abs(force) > setup.force_limit * (1.0 + _ROUNDING):
            force = min(max(force, -setup.force_limit), setup.force_limit)
        reference = min(setup.reference_speed, observation.speed_limit)
        return Decision(force, "plug-in", reason or "answered", "", 0, reference, None)

    def applied(self, force: float) -> None:
        """Tell the plug-in that ``force`` [N] acts instead of its last answer."""
        self._call_if_there("applied", force)

    def close(self) -> None:
        """Close the plug-in after its last answer."""
        self._call_if_there("close")

    def _call_if_there(self, method: str, *arguments: float) -> None:
        call = getattr(self._plug_in, method, None)
        if call is not None:
            with blamed(self._name, PlugInError, f" in {method}"):
                call(*arguments)

    @property
    def warnings(self) -> list[str]:
        """The warnings of the plug-in for the user."""
        return list(getattr(self._plug_in, "warnings", ()))

    def _force_of(self, answer: object, speed: float) -> tuple[float, str]:
        """Return the force [N] of an answer, and its reason."""
        setup = self._setup
        if isinstance(answer, Acceleration):
            wanted = self._number(answer, answer.value, "m/s^2")
            return setup.mass * wanted + setup.friction * speed, self._word(answer, answer.reason)
        if isinstance(answer, Speed):
            wanted = self._number(answer, answer.value, "m/s")
            lead = max(self._number(answer, answer.lead, "s"), setup.time_step)
            force = setup.mass * (wanted - speed) / lead + setup.friction * speed
            return force, self._word(answer, answer.reason)
        if isinstance(answer, Force):
            return self._number(answer, answer.value, "N"), self._word(answer, answer.reason)
        return self._number(answer, answer, "N"), ""

    def _number(self, answer: object, value: object, unit: str) -> float:
        known = isinstance(value, float | int | np.floating | np.integer)
        if not known or isinstance(value, bool):
            raise PlugInError(
                f"{self._name} returned {shown(answer)}: expected Force, Acceleration or Speed of "
                f"one number, or a force as a number [{unit}]"
            )
        if not isfinite(value):  # type: ignore[arg-type]
            raise PlugInError(
                f"{self._name} returned {shown(answer)}: expected a finite number [{unit}]"
            )
        return float(value)  # type: ignore[arg-type]

    def _word(self, answer: object, reason: object) -> str:
        if not isinstance(reason, str):
            msg = f"{self._name} returned {shown(answer)}: expected words as its reason"
            raise PlugInError(msg)
        return reason if reason.isprintable() else " ".join(reason.split())


class _SeenPeople(NamedTuple):
    """The pedestrians with read-only arrays."""

    position: Array
    velocity: Array


def _unwritable(observation: Observation) -> Observation:
    """Return a copy of the observation with read-only arrays, because they belong to the run."""
    arrays = {name: getattr(observation, name) for name in _ARRAYS}
    fixed = {name: read_only(array) for name, array in arrays.items() if array is not None}
    people = observation.people
    if people is not None:
        people = _SeenPeople(read_only(people.position), read_only(people.velocity))
    return observation.replaced(people=people, **fixed)


def _is_count(value: Any) -> bool:
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    return whole and 0 <= int(value) <= _FURTHEST
