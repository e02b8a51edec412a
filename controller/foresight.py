"""The predictions that a controller may ask for: how people answer to a manoeuvre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol, Self

import numpy as np

from controller._jit import Array


@dataclass(frozen=True, slots=True)
class Manoeuvre:
    """The ego's motion at steps 0 ... N under forward Euler, as the vehicle's model has it.

    Attributes:
        distance: (N + 1,) [m] driven from now on.
        speed: (N + 1,) [m/s].
        acceleration: (N + 1,) [m/s^2]; from each step to the next.
    """

    distance: Array
    speed: Array
    acceleration: Array

    @classmethod
    def empty(cls, horizon: int) -> Manoeuvre:
        """Room for a manoeuvre of N steps."""
        return cls(np.zeros(horizon + 1), np.zeros(horizon + 1), np.zeros(horizon + 1))


class Trials(NamedTuple):
    """Manoeuvres that are compared: a row for each, the last of them what was planned before.

    Attributes:
        distance: (k, N + 1) [m] driven from now on.
        speed: (k, N + 1) [m/s].
        acceleration: (k, N + 1) [m/s^2].
        penalty: (k,) [s] that each pays in addition to what it costs.
    """

    distance: Array
    speed: Array
    acceleration: Array
    penalty: Array

    @classmethod
    def empty(cls, count: int, horizon: int, penalty: Array) -> Self:
        """Room for ``count`` manoeuvres of N steps."""
        distance, speed, acceleration = np.zeros((3, count, horizon + 1))
        return cls(distance, speed, acceleration, penalty)

    def of(self, k: int) -> tuple[Array, Array, Array]:
        """Distance, speed and acceleration of one of them."""
        return self.distance[k], self.speed[k], self.acceleration[k]


class Prospect(NamedTuple):
    """The predicted outcome of a manoeuvre, over steps 1 ... N; the next one overwrites it.

    Attributes:
        gap: (N,) [m] Distance to the closest person in front; inf without one.
        conflicts: (N,) Number of persons less than the conflict time from a collision.
        calm: (N,) [m/s] the speed up to which nobody could force an emergency stop, whatever
            people did that they can; inf: the manoeuvre's is calm.
        crossers: (n, 4) who will be on the ego's way beyond the horizon: how far ahead of its front
            [m] at the horizon's end, how fast along the way [m/s], from when [s] after that end,
            and until when; 0: never. A compiled search fills none.
    """

    gap: Array
    conflicts: Array
    calm: Array
    crossers: Array = np.empty((0, 4))  # shared default that is never written


class Foresight(Protocol):
    """Predicts the crowd under any manoeuvre of the ego."""

    def prospect(self, manoeuvre: Manoeuvre) -> Prospect:
        """Return the predicted outcome of a manoeuvre, which is valid until the next call."""

    def prefer(self) -> None:
        """Remember the outcome of the latest manoeuvre as that of the best so far."""


class Batches(NamedTuple):
    """The batches of a branch and bound: rows of candidates; the first of equals is the best.

    Attributes:
        first: Candidates that are compared with each other.
        content: Candidates evaluated next if the best of these lacks no stopping distance.
        wanting: Candidates evaluated next if it lacks some.
    """

    first: list[int]
    content: list[int]
    wanting: list[int]


class SearchResult(NamedTuple):
    """The result of a branch and bound over candidate manoeuvres.

    Attributes:
        best: Row of the cheapest candidate; -1 if no cost is finite.
        missing: Largest stopping distance that it lacks [m].
        clear: Whether nobody is in the way of the first candidate, which then is the best.
        tried: Number of candidates compared.
        prospect: Predicted outcome of the best; the next search overwrites it.
    """

    best: int
    missing: float
    clear: bool
    tried: int
    prospect: Prospect


class SearchingForesight(Foresight, Protocol):
    """A foresight that compares manoeuvres itself, and looks no farther than it takes."""

    def cheapest(
        self,
        trials: Trials,
        batches: Batches,
        probe: bool,
        allowed: Array,
        wanted: float,
        weights: tuple[Any, ...],
    ) -> SearchResult:
        """Return the cheapest manoeuvre, the same as by asking for the prospect of each.

        Args:
            trials: Manoeuvres, compared or not.
            batches: Rows of the manoeuvres that are compared.
            probe: Whether the first one is evaluated alone first; it wins if nobody is in its way.
            allowed: Distances [m] that may be driven until steps 1 ... N, (N,).
            wanted: Speed [m/s] that time is lost against.
            weights: Numbers of the cost.
        """
