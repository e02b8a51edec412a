"""The skeleton of all conformance kits: rules checked one after the other, each told in words.

A kit plays made-up scenes to plug-ins of one socket. It says how one is made and asked; the
checks that hold for every socket are here. No scene needs SUMO.
"""

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import cos, sin
from statistics import median
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

Hosted = TypeVar("Hosted")
Answers = TypeVar("Answers")
Array = NDArray[np.float64]
Begins = Callable[[str], object]

TURN = 0.9
"""Angle [rad] by which a scene is turned."""
_SHIFT = np.array([120.0, -45.0])  # Displacement [m] of a turned scene
_ROTATION = np.array([[cos(TURN), sin(TURN)], [-sin(TURN), cos(TURN)]])
_NEEDED = 2  # Number of first rules without which nothing else can be asked


@dataclass(frozen=True)
class Finding:
    """One rule, and the problem that breaks it.

    Attributes:
        rule: Rule in a few words.
        problem: Observation that breaks the rule; empty if the rule is kept.
    """

    rule: str
    problem: str = ""


def turned(vectors: Array) -> Array:
    """Return vectors (n, 2) as they are in a turned scene."""
    return np.asarray(vectors @ _ROTATION)


def moved(points: Array) -> Array:
    """Return points (n, 2) [m] where they are in a turned and shifted scene."""
    return np.asarray(turned(points) + _SHIFT)


class Battery(ABC, Generic[Hosted, Answers]):
    """The checks of one kit; each returns the problem in words, or an empty text.

    Attributes:
        faults: Errors that tell a fault of the plug-in.
        method: Method of the host whose computing time counts.
        longest: Computing time [s] that a call may take, at the median.
    """

    faults: ClassVar[tuple[type[Exception], ...]]
    method: ClassVar[str]
    longest: ClassVar[float] = 5e-3  # A tenth of the control step

    @abstractmethod
    def fresh(self) -> Hosted:
        """Return a plug-in in its host, which has seen nothing."""

    @abstractmethod
    def answers(
        self, hosted: Hosted, *, other: Hosted | None = None, order: int = 1, turned: bool = False
    ) -> Answers:
        """Return the answers to the made-up scene.

        Args:
            hosted: Plug-in to be asked.
            other: Plug-in that is asked in between, or None.
            order: -1 if people stand in the opposite order.
            turned: True if everything is turned and shifted.
        """

    @abstractmethod
    def difference(self, found: Answers, usual: Answers) -> str:
        """Return the first difference between answers in words; empty if there is none."""

    @abstractmethod
    def corner_cases(self) -> Iterable[tuple[str, Callable[[Hosted], object]]]:
        """Return each corner case: its name, and the function that asks a plug-in in it."""

    @abstractmethod
    def rules(self) -> dict[str, Callable[[], str]]:
        """Return the check of each rule."""

    def findings(self, begins: Begins | None = None) -> list[Finding]:
        """Return a finding for each rule, as far as rules can be checked.

        Args:
            begins: Function that is told each rule before it is checked, or None.
        """
        found: list[Finding] = []
        for rule, check in self.rules().items():
            if begins is not None:
                begins(rule)
            try:
                found.append(Finding(rule, check()))
            except self.faults as error:
                found.append(Finding(rule, str(error)))
            if found[-1].problem and len(found) <= _NEEDED:
                break
        return found

    def unlike(self, found: Answers, what: str) -> str:
        """Return how answers differ from the usual ones, behind the words ``what``."""
        difference = self.difference(found, self.answers(self.fresh()))
        return f"{what}: {difference}" if difference else ""

    def can_be_made(self) -> str:
        """Make the plug-in."""
        self.fresh()
        return ""

    def usual(self) -> str:
        """Ask in the usual scene."""
        self.answers(self.fresh())
        return ""

    def in_corner_cases(self) -> str:
        """Ask a fresh plug-in in each corner case."""
        for name, ask in self.corner_cases():
            try:
                ask(self.fresh())
            except self.faults as error:
                return f"{name}: {error}"
        return ""

    def deterministic(self) -> str:
        """Compare two plug-ins that are made alike."""
        return self.unlike(self.answers(self.fresh()), "made again, its answer differs")

    def independent(self) -> str:
        """Compare with a plug-in beside another one."""
        found = self.answers(self.fresh(), other=self.fresh())
        return self.unlike(found, "beside another one, its answer differs")

    def restarts(self) -> str:
        """Compare with a plug-in that has been reset."""
        hosted: Any = self.fresh()
        self.answers(hosted, order=-1)
        hosted.reset()
        return self.unlike(self.answers(hosted), "after reset, its answer differs")

    def unordered(self) -> str:
        """Compare with people in the opposite order."""
        found = self.answers(self.fresh(), order=-1)
        return self.unlike(found, "with the people in another order, its answer differs")

    def unturned(self) -> str:
        """Compare with everything turned and shifted."""
        found = self.answers(self.fresh(), turned=True)
        return self.unlike(found, "with everything turned and shifted, it answers otherwise")

    def quick(self) -> str:
        """Measure the computing time of a call."""
        hosted, times = self.fresh(), list[float]()
        call = getattr(hosted, self.method)

        def timed(*arguments: Any) -> Any:
            began = time.thread_time()
            answer = call(*arguments)
            times.append(time.thread_time() - began)
            return answer

        setattr(hosted, self.method, timed)
        self.answers(hosted)
        taken = median(times)
        return f"takes {1e3 * taken:.1f} ms for a call" if taken > self.longest else ""
