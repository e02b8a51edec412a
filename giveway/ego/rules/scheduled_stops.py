"""The scheduled stops of an ego: it halts at each for the time that the scenario gives."""

from __future__ import annotations

import math
from collections.abc import Sequence

from controller.driving_constants import STANDING
from giveway.ego.rules.protocol import STOP, Demand, Situation
from giveway.ego.rules.route import RouteContext, Stop
from giveway.ego.rules.yielding import needed_braking

_PASSED = 1.0  # distance [m] beyond the end of a stop, from which on the ego has missed it


class ScheduledStops:
    """Follows one ego from stop to stop.

    Args:
        stops: Stops in the order of the path.
        clock: SUMO's clock at the ego's departure [s].
        time_step: Control step [s].
        hardest: Deceleration [m/s^2] that the vehicle is capable of.

    Attributes:
        served: Number of stops at which the ego has halted for long enough.
        missed: Number of stops that the ego has driven past.
    """

    def __init__(
        self, stops: Sequence[Stop], *, clock: float, time_step: float, hardest: float
    ) -> None:
        self._stops = tuple(stops)
        self._clock = clock
        self._time_step = time_step
        self._hardest = hardest
        self._steps = 0
        self._approaching = False  # whether the ego has ever been able to brake for the next stop
        self._arrived: int | None = None  # the step in which the ego halted there
        self.served = 0
        self.missed = 0

    @classmethod
    def on(cls, route: RouteContext) -> ScheduledStops | None:
        """The rule on one ego's route; None if the ego serves no stops."""
        if not route.stops:
            return None
        return cls(
            route.stops,
            clock=route.time,
            time_step=route.time_step,
            hardest=route.hardest_braking,
        )

    @property
    def remarks(self) -> list[str]:
        """The remarks on how the drive went, one sentence each."""
        if not self.missed:
            return []
        return [f"it drove past {self.missed} of its stops, which were too near to halt at"]

    def demand(self, situation: Situation) -> Demand | None:
        """A stop at the next scheduled stop, if the ego is able to brake for it.

        Args:
            situation: Present situation of the ego.
        """
        stop = self._stop_at(situation.station, situation.speed)
        return None if stop == math.inf else Demand(stop, STOP)

    def _stop_at(self, front: float, speed: float) -> float:
        """The station [m] at which the front bumper has to halt; inf if it need not halt."""
        following = self._next
        if following is None or front > following.end + _PASSED:
            return math.inf
        needed = needed_braking(speed, following.end - front)
        self._approaching = self._approaching or needed <= self._hardest
        return max(following.end, front) if self._approaching else math.inf

    def advance(self, situation: Situation, _: float) -> None:
        """Find out whether the ego has halted, may drive on, or has driven past.

        Args:
            situation: Situation after the control step.
        """
        front, speed = situation.station, situation.speed
        self._steps += 1
        following = self._next
        if following is None:
            return
        if self._arrived is None:
            if front > following.end + _PASSED:
                self.missed += 1
                self._approaching = False
            elif front >= following.start and speed < STANDING:
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
