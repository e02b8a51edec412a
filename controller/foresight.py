"""The predictions that a controller may ask for: how people react to a manoeuvre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol, Self

import numpy as np

from controller._jit import Array


@dataclass(frozen=True, slots=True)
class Manoeuvre:
    """The ego's motion at steps 0 ... N, by forward Euler as in the vehicle's model.

    Attributes:
        distance: Distances (N + 1,) [m] driven from now on.
        speed: Speeds (N + 1,) [m/s].
        acceleration: Accelerations (N + 1,) [m/s^2] from each step to the next.
    """

    distance: Array
    speed: Array
    acceleration: Array

    @classmethod
    def empty(cls, horizon: int) -> Manoeuvre:
        """Arrays for a manoeuvre of N steps, filled with 0."""
        return cls(np.zeros(horizon + 1), np.zeros(horizon + 1), np.zeros(horizon + 1))


class Trials(NamedTuple):
    """Manoeuvres that are compared, one per row; the last row holds the previous plan.

    Attributes:
        distance: Distances (k, N + 1) [m] driven from now on.
        speed: Speeds (k, N + 1) [m/s].
        acceleration: Accelerations (k, N + 1) [m/s^2].
        penalty: Fixed costs (k,) [s], added to the cost of each.
    """

    distance: Array
    speed: Array
    acceleration: Array
    penalty: Array

    @classmethod
    def empty(cls, count: int, horizon: int, penalty: Array) -> Self:
        """Arrays for ``count`` manoeuvres of N steps."""
        distance, speed, acceleration = np.zeros((3, count, horizon + 1))
        return cls(distance, speed, acceleration, penalty)

    def of(self, k: int) -> tuple[Array, Array, Array]:
        """Distance, speed and acceleration (N + 1,) of manoeuvre ``k``."""
        return self.distance[k], self.speed[k], self.acceleration[k]


class Evaluation(NamedTuple):
    """The predicted outcome of a manoeuvre, over steps 1 ... N; the next one overwrites it.

    Attributes:
        gap: Distances (N,) [m] to the closest person in front; inf without one.
        threat_free: Threat-free speeds (N,) [m/s], up to which no person could force an emergency
            stop by any motion they are capable of; inf if the manoeuvre's speed is threat-free.
        passing: Passing speeds (N,) [m/s]: speeds at which drivers pass people at the predicted
            clearances; inf if the manoeuvre is no faster.
        later_crossings: Later crossings (n, 4), of people on the ego's path beyond the horizon:
            distance [m] ahead of the front at the horizon's end, speed [m/s] along the path, and
            the times [s] after the horizon's end at which they enter and leave the path; they leave
            at 0 if they never enter it. A compiled search fills none.
    """

    gap: Array
    threat_free: Array
    passing: Array
    later_crossings: Array = np.empty((0, 4))  # shared default that is never written


class Foresight(Protocol):
    """Predicts the crowd under any manoeuvre of the ego."""

    def evaluate(self, manoeuvre: Manoeuvre, *, creeps: bool = False) -> Evaluation:
        """Return the predicted outcome of a manoeuvre, which is valid until the next call.

        Args:
            manoeuvre: Motion of the ego.
            creeps: Whether the ego creeps towards people. Those who may not see it then count as
                nearer.
        """

    def prefer(self) -> None:
        """Remember that the latest manoeuvre is the best so far, with its outcome."""


class Batches(NamedTuple):
    """The batches of a branch and bound: rows of candidates, the first of equals being the best.

    Attributes:
        first: Candidates that are compared first.
        content: Candidates compared next if the best of the first lacks no stopping distance.
        wanting: Candidates compared next if the best of the first lacks stopping distance.
    """

    first: tuple[int, ...]
    content: tuple[int, ...]
    wanting: tuple[int, ...]


class SearchResult(NamedTuple):
    """The result of a branch and bound over candidate manoeuvres.

    Attributes:
        best: Row of the cheapest candidate; -1 if no cost is finite.
        missing: Largest stopping distance [m] that the best candidate lacks.
        clear: Whether nobody is in the way of the first candidate, which then is the best.
        tried: Number of candidates compared.
        evaluation: Predicted outcome of the best; the next search overwrites it.
    """

    best: int
    missing: float
    clear: bool
    tried: int
    evaluation: Evaluation


class SearchingForesight(Foresight, Protocol):
    """A foresight that compares manoeuvres itself, and predicts no more than that needs."""

    def cheapest(
        self,
        trials: Trials,
        batches: Batches,
        probe: bool,
        allowed: Array,
        wanted: float,
        weights: tuple[Any, ...],
    ) -> SearchResult:
        """Return the cheapest manoeuvre, the same one as if each were evaluated in full.

        Args:
            trials: Manoeuvres; `batches` says which of them are compared.
            batches: Rows of the manoeuvres that are compared.
            probe: Whether the first one is evaluated alone first. It is accepted at once if other
                road users cost it nothing.
            allowed: Distances (N,) [m] that may be driven until steps 1 ... N.
            wanted: Speed [m/s] that lost time refers to.
            weights: Weights of the cost.
        """
