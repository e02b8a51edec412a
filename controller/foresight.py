"""What a controller may ask before it decides: how people would answer to a manoeuvre."""

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
        handicap: (k,) [s] that each pays in addition to what it costs.
    """

    distance: Array
    speed: Array
    acceleration: Array
    handicap: Array

    @classmethod
    def empty(cls, count: int, horizon: int, handicap: Array) -> Self:
        """Room for ``count`` manoeuvres of N steps."""
        distance, speed, acceleration = np.zeros((3, count, horizon + 1))
        return cls(distance, speed, acceleration, handicap)

    def of(self, k: int) -> tuple[Array, Array, Array]:
        """Distance, speed and acceleration of one of them."""
        return self.distance[k], self.speed[k], self.acceleration[k]


class Prospect(NamedTuple):
    """What a manoeuvre would lead to: arrays over steps 1 ... N, overwritten by the next one.

    Attributes:
        gap: (N,) [m] to the closest person in front; inf: nobody.
        conflicts: (N,) persons who would be less than the conflict time from a collision.
        calm: (N,) [m/s] the speed up to which nobody could force an emergency stop, whatever
            people did that they can; inf: the manoeuvre's is calm.
        crossers: (n, 4) who will be on the ego's way beyond the horizon: how far ahead of its front
            [m] at the horizon's end, how fast along the way [m/s], from when [s] after that end,
            and until when; 0: never. A race fills none.
    """

    gap: Array
    conflicts: Array
    calm: Array
    crossers: Array = np.empty((0, 4))  # nothing is ever written into it


class Foresight(Protocol):
    """Predicts the crowd under any manoeuvre of the ego."""

    def prospect(self, manoeuvre: Manoeuvre) -> Prospect:
        """What a manoeuvre would lead to; valid until the next call."""

    def prefer(self) -> None:
        """The latest manoeuvre is the best so far: remember what it would lead to."""


class Heats(NamedTuple):
    """Who of the trials runs when: rows of them; of equal ones the first is the best.

    Attributes:
        first: run against each other.
        content: run against the best of these where it lacks no stopping distance.
        wanting: run against it where it does.
    """

    first: list[int]
    content: list[int]
    wanting: list[int]


class Verdict(NamedTuple):
    """What a race between manoeuvres came to.

    Attributes:
        best: the row of the cheapest; -1: no cost is a number.
        missing: the longest stopping distance that it lacks [m].
        clear: nobody is in the way of the very first one, which then is the best.
        tried: how many were compared.
        prospect: what the best would lead to; overwritten by the next race.
    """

    best: int
    missing: float
    clear: bool
    tried: int
    prospect: Prospect


class RacingForesight(Foresight, Protocol):
    """A foresight that compares manoeuvres itself, and looks no farther than it takes."""

    def race(
        self,
        trials: Trials,
        heats: Heats,
        lead: bool,
        allowed: Array,
        wanted: float,
        weights: tuple[Any, ...],
    ) -> Verdict:
        """The cheapest of some manoeuvres: the same as by asking for the prospect of each.

        Args:
            trials: all manoeuvres.
            heats: which of them are compared.
            lead: ask first whether anybody is in the way of the first one; if nobody is, it wins.
            allowed: (N,) [m] that may be driven until steps 1 ... N.
            wanted: the speed [m/s] that time is lost against.
            weights: the numbers of the cost.
        """
