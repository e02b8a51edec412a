"""The wrapper of a rule of another package: it checks answers and reports errors by name."""

from collections.abc import Callable, Set
from math import inf, isnan
from typing import Any

import numpy as np

from giveway.ego.perception.leader import Leader
from giveway.ego.rules.protocol import NO_NEEDS, Demand, Needs, Rule, Situation
from giveway.errors import RuleError
from giveway.plug_ins.faults import blamed, shown

_NUMBERS = ("stop", "latest", "speed", "advice")


class PluggedInRule:
    """A rule of another package, which `RuleSet` asks like giveway's own.

    Args:
        name: Name of the rule and its ego, for messages.
        rule: Rule of the other package.

    Attributes:
        needs: Needs of the rule.
        update: Called after each of SUMO's steps, if the rule has such a method.
        advance: Called after each control step, if the rule has such a method.

    Raises:
        RuleError: what it needs is no `Needs`.
    """

    update: Callable[..., None]
    advance: Callable[..., None]

    def __init__(self, name: str, rule: Rule) -> None:
        self._name, self._rule, self._ask = name, rule, rule.demand
        self.needs = getattr(rule, "needs", NO_NEEDS)
        if not isinstance(self.needs, Needs):
            raise RuleError(f"{name} has needs = {shown(self.needs)}: expected Needs(...)")
        for method in ("update", "advance"):
            if hasattr(rule, method):
                setattr(self, method, self._guarded(method))

    def demand(self, situation: Situation) -> Demand | None:
        """The demand of the rule, checked.

        Args:
            situation: Present situation of the ego.

        Raises:
            RuleError: it raises, or answers with no sound `Demand`.
        """
        with blamed(self._name, RuleError):
            answer = self._ask(situation)
        if answer is not None and (problem := problem_of(answer)):
            raise RuleError(f"{self._name} returned {shown(answer)}: {problem}")
        return answer

    @property
    def beside(self) -> Set[str]:
        """The ids of vehicles that, according to the rule, will pass beside the ego's path."""
        return frozenset(getattr(self._rule, "beside", ()))

    @property
    def remarks(self) -> list[str]:
        """The remarks on how the drive went, one sentence each."""
        return [" ".join(str(said).split()) for said in getattr(self._rule, "remarks", ())]

    def _guarded(self, method: str) -> Callable[..., None]:
        call = getattr(self._rule, method)

        def guarded(*arguments: Any) -> None:
            with blamed(self._name, RuleError, f" in {method}"):
                call(*arguments)

        return guarded


def problem_of(answer: object) -> str:
    """The problem with an answer of a rule, or an empty text if it is a valid `Demand`.

    Args:
        answer: Answer of a rule, other than None.
    """
    if not isinstance(answer, Demand):
        return "expected a Demand, or None"
    told: dict[str, Any] = answer._asdict()
    for key in _NUMBERS:
        value = told[key]
        if isinstance(value, bool) or not isinstance(value, int | float) or isnan(value):
            return f"expected a number as {key}; inf demands nothing"
    if min(told["speed"], told["advice"]) < 0.0:
        return "expected a speed of at least 0 m/s"
    if not isinstance(told["leader"], Leader):
        return "expected a Leader(station, speed) as leader"
    cause = told["cause"]
    if told["stop"] < inf and not (isinstance(cause, str) and cause and cause.isprintable()):
        return "expected a word as the cause of the stop, for the column waits_for"
    if not isinstance(told["lane_speeds"], np.ndarray | None):
        return "expected an array as lane_speeds, or None"
    return ""
