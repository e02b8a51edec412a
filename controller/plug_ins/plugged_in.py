"""The wrapper of a controller of another package: it checks answers and reports errors."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from contextlib import contextmanager
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from controller.errors import PlugInError
from controller.observation import Observation, People
from controller.plug_ins.plug_in import Acceleration, Force, PlugIn, Setup, Speed
from controller.protocol import Decision

if TYPE_CHECKING:
    from collections.abc import Iterator

    from controller._jit import Array

_SHOWN = 80  # largest number of characters of a returned value in a message
_ROUNDING = 1e-8  # tolerance of the force limit as a share of it, as solvers need
_FURTHEST = 10_000  # largest prediction horizon [steps]
_Entry = TypeVar("_Entry", bound=np.generic)


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
        with self._blamed("when it was made"):
            plug_in = make()
        if not isinstance(plug_in, PlugIn):
            msg = f"{name} made {_shown(plug_in)}: expected an object with a method control"
            raise PlugInError(msg)
        self._plug_in = plug_in
        with self._blamed("when it was asked for its horizon"):
            horizon = getattr(plug_in, "horizon", 0)
            self.foresees = bool(getattr(plug_in, "foresees", False))
        if not _is_count(horizon):
            msg = f"{name} has horizon = {_shown(horizon)}: expected a whole number of steps"
            raise PlugInError(f"{msg} from 0 to {_FURTHEST}")
        self.horizon = int(horizon)
        if self.foresees and not self.horizon:
            msg = f"{name} has foresees = True and horizon = 0: expected steps to foresee"
            raise PlugInError(msg)

    def reset(self) -> None:
        """Forget the past."""
        reset = getattr(self._plug_in, "reset", None)
        if reset is not None:
            with self._blamed("in reset"):
                reset()

    def control(self, observation: Observation) -> Decision:
        """Decide on the force at t_k.

        Raises:
            PlugInError: the plug-in raises, or returns no finite number.
        """
        try:
            answer = self._plug_in.control(_read_only(observation))
        except (Exception, SystemExit) as error:
            raise self._blame(error, "") from error
        setup = self._setup
        force, reason = self._force_of(answer, observation.speed)
        if abs(force) > setup.force_limit * (1.0 + _ROUNDING):
            force = min(max(force, -setup.force_limit), setup.force_limit)
        reference = min(setup.reference_speed, observation.speed_limit)
        return Decision(force, "plug-in", reason or "answered", "", 0, reference, None)

    def applied(self, force: float) -> None:
        """Tell the plug-in that ``force`` [N] acts instead of its last answer."""
        applied = getattr(self._plug_in, "applied", None)
        if applied is not None:
            with self._blamed("in applied"):
                applied(force)

    def close(self) -> None:
        """Close the plug-in after its last answer."""
        close = getattr(self._plug_in, "close", None)
        if close is not None:
            with self._blamed("in close"):
                close()

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
                f"{self._name} returned {_shown(answer)}: expected Force, Acceleration or Speed of "
                f"one number, or a force as a number [{unit}]"
            )
        if not isfinite(value):  # type: ignore[arg-type]
            raise PlugInError(
                f"{self._name} returned {_shown(answer)}: expected a finite number [{unit}]"
            )
        return float(value)  # type: ignore[arg-type]

    def _word(self, answer: object, reason: object) -> str:
        if not isinstance(reason, str):
            msg = f"{self._name} returned {_shown(answer)}: expected words as its reason"
            raise PlugInError(msg)
        return reason if reason.isprintable() else " ".join(reason.split())

    @contextmanager
    def _blamed(self, when: str) -> Iterator[None]:
        try:
            yield
        except (Exception, SystemExit) as error:
            raise self._blame(error, f" {when}") from error

    def _blame(self, error: BaseException, when: str) -> PlugInError:
        if isinstance(error, PlugInError):
            return PlugInError(f"{self._name}: {error}")
        return PlugInError(f"{self._name} raised {described(error)}{when}")


def described(error: BaseException) -> str:
    """Describe an error of another package by kind, first line and place.

    Example: "ValueError: bad (a.py:3)".
    """
    try:
        lines = str(error).split("\n")
    except Exception:
        lines = [""]
    said = f": {lines[0][: 3 * _SHOWN]}" if lines[0].strip() else ""
    frames = traceback.extract_tb(error.__traceback__)
    place = f" ({Path(frames[-1].filename).name}:{frames[-1].lineno})" if frames else ""
    return f"{type(error).__name__}{said}{place}"


class _SeenPeople(NamedTuple):
    """The pedestrians with read-only arrays."""

    position: Array
    velocity: Array


def _read_only(observation: Observation) -> Observation:
    """Return a copy of the observation with read-only arrays, because they belong to the run."""
    people, vehicles, ids = observation.people, observation.vehicles, observation.person_ids
    lanes = observation.lane_speeds
    return observation.replaced(
        obstacle_positions=_fixed(observation.obstacle_positions),
        people=None if people is None else _people(people),
        vehicles=None if vehicles is None else _fixed(vehicles),
        lane_speeds=None if lanes is None else _fixed(lanes),
        person_ids=None if ids is None else _fixed(ids),
    )


def _people(people: People) -> _SeenPeople:
    return _SeenPeople(_fixed(people.position), _fixed(people.velocity))


def _fixed(array: NDArray[_Entry]) -> NDArray[_Entry]:
    view = array.view()
    view.flags.writeable = False
    return view


def _is_count(value: Any) -> bool:
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    return whole and 0 <= int(value) <= _FURTHEST


def _shown(value: object) -> str:
    """Return a value on one line, even if its ``repr`` fails."""
    try:
        text = " ".join(repr(value).split())
    except Exception:
        text = f"a {type(value).__name__}"
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."
