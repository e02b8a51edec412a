"""What a controller may ask before it decides: how people would answer to a manoeuvre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

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


class Prospect(NamedTuple):
    """What a manoeuvre would lead to: arrays over steps 1 ... N, overwritten by the next one.

    Attributes:
        gap: (N,) [m] to the closest person in front; inf: nobody.
        conflicts: (N,) persons who would be less than the conflict time from a collision.
        calm: (N,) [m/s] the speed up to which nobody could force an emergency stop, whatever
            people did that they can; inf: the manoeuvre's is calm.
    """

    gap: Array
    conflicts: Array
    calm: Array


class Foresight(Protocol):
    """Predicts the crowd under any manoeuvre of the ego."""

    def prospect(self, manoeuvre: Manoeuvre) -> Prospect:
        """What a manoeuvre would lead to; valid until the next call."""

    def prefer(self) -> None:
        """The latest manoeuvre is the best so far: remember what it would lead to."""
