"""The stops that an ego serves: it halts at each for as long as the scenario has its doors open."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from giveway.ego.giving_way import needed_braking

_STANDING = 0.2  # [m/s] below it the ego has halted
_PASSED = 1.0  # [m] beyond the stop's end, from which on the ego has driven past it


class Stop(NamedTuple):
    """Where the front bumper is to halt, and for how long."""

    start: float  # [m] station from which on a halt counts
    end: float  # [m] station that the ego drives up to
    duration: float  # [s] after the arrival, at least
    until: float  # [s] on SUMO's clock, at least; -inf: not given


class Stops:
    """Follows one ego from stop to stop.

    Args:
        stops: in the order of the path.
        clock: SUMO's at the ego's departure [s].
        time_step: of the control [s].
        hardest: deceleration [m/s^2] that the vehicle is capable of.

    Attributes:
        served: how many it has halted at for long enough.
        missed: how many it has driven past.
    """

    def __init__(
        self, stops: Sequence[Stop], *, clock: float, time_step: float, hardest: float
    ) -> None:
        self._stops = tuple(stops)
        self._clock = clock
        self._time_step = time_step
        self._hardest = hardest
        self._steps = 0
        self._approaching = False  # it could halt at the next stop when it first came in sight
        self._arrived: int | None = None  # the step in which it halted there
        self.served = 0
        self.missed = 0

    def stop_at(self, front: float, speed: float) -> float:
        """Station [m] at which the front bumper has to halt; inf: nowhere.

        Args:
            front: station of the front bumper [m].
            speed: [m/s].
        """
        following = self._next
        if following is None or front > following.end + _PASSED:
            return math.inf
        needed = needed_braking(speed, following.end - front)
        self._approaching = self._approaching or needed <= self._hardest
        return max(following.end, front) if self._approaching else math.inf

    def pass_time(self, front: float, speed: float) -> None:
        """Once after each control step: has it halted, may it drive on, has it driven past?

        Args:
            front: station of the front bumper [m].
            speed: [m/s].
        """
        self._steps += 1
        following = self._next
        if following is None:
            return
        if self._arrived is None:
            if front > following.end + _PASSED:
                self.missed += 1
                self._approaching = False
            elif front >= following.start and speed < _STANDING:
                self._arrived = self._steps
            return
        halted = (self._steps - self._arrived) * self._time_step
        now = self._clock + self._steps * self._time_step
        if halted >= following.duration - 1e-9 and now >= following.until - 1e-9:
            self.served += 1
            self._approaching, self._arrived = False, None

    @property
    def _next(self) -> Stop | None:
        done = self.served + self.missed
        return self._stops[done] if done < len(self._stops) else None
