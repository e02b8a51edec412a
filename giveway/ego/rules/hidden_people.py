"""Caution before hiding places: an ego drives so that it stands before who comes out gets to it.

A person who comes out of hiding at a distance g aside of the ego's body is in its way after a time
t. An ego that brakes by b stands by then, wherever the place is, if its speed is at most b t. The
safety layer demands the same; this rule has the ego slow down comfortably on the way to the place.
"""

from __future__ import annotations

from math import inf

import numpy as np

from controller.driving_constants import COMFORTABLE
from giveway.ego.perception.leader import NO_LEADER
from giveway.ego.perception.visibility import RADIUS
from giveway.ego.rules.protocol import Demand, Situation
from giveway.ego.rules.route import RouteContext
from giveway.geometry.kernel import Array

CRAWL = 1.5
"""Speed [m/s] that hiding places never slow an ego below, a walking pace: they hold it nowhere."""

_SHARE = 0.9  # share of the hardest braking that is planned with, and
_LATE = 0.1  # time [s] that a stop takes longer than by that braking alone
_KEPT = 6.0  # distance [m] before a place over which its speed is kept, past a row of cars
_SPARE = 0.05  # distance [m] beside the body that is kept, so that the safety layer need not act


class HiddenPeople:
    """Caps the speed before the hiding places along one ego's path.

    Args:
        speed: Speed [m/s] of people who come out of hiding.
        acceleration: Their largest acceleration [m/s^2].
        half_width: Half of the width of the ego [m].
        braking: Deceleration [m/s^2] of its stop before who comes out.
        late: Time [s] until it brakes so hard.
        times: Times (N,) [s] of the steps that the ego looks ahead.
    """

    def __init__(
        self,
        speed: float,
        acceleration: float,
        half_width: float,
        braking: float,
        late: float,
        times: Array,
    ) -> None:
        self._speed, self._acceleration, self._braking = speed, acceleration, braking
        self._late = _LATE + late
        self._inside, self._times = half_width + RADIUS + _SPARE, times[:, None]
        self._slowing = COMFORTABLE * np.concatenate([[0.0], times])

    @classmethod
    def on(cls, route: RouteContext) -> HiddenPeople | None:
        """The rule of one ego; None if nobody comes out of hiding."""
        config, ego = route.config, route.ego
        if not route.heeds("hidden_people") or not config.safety.hidden_speed:
            return None
        if not config.perception.plugged_in_sensor:
            return None
        return cls(
            config.safety.hidden_speed,
            min(ego.worst.setting_out, ego.worst.acceleration),
            0.5 * route.shape.width,
            _SHARE * route.hardest_braking,
            0.0 if ego.safety is None else ego.safety.actuator.reaction_time,
            route.times_ahead,
        )

    def demand(self, situation: Situation) -> Demand | None:
        """The speeds not to be exceeded before the hiding places ahead, or None without any.

        Args:
            situation: Present situation of the ego.
        """
        hidden = situation.hidden
        if not len(hidden.station):
            return None
        gap = np.maximum(hidden.aside - self._inside - hidden.error, 0.0)
        v, a = self._speed, self._acceleration
        time = (np.sqrt(v * v + 2.0 * a * gap) - v) / a
        there = np.maximum(self._braking * (time - self._late), CRAWL)
        ahead = hidden.station - situation.station
        left = np.concatenate([ahead[None], ahead - situation.speed * self._times])
        caps = np.sqrt(there * there + 2.0 * COMFORTABLE * np.maximum(left - _KEPT, 0.0))
        caps[left < 0.0] = inf
        # where a place comes in sight at once, the ego slows down no harder for it
        speeds = np.maximum(caps.min(axis=1), situation.speed - self._slowing)
        return Demand(inf, "", inf, float(speeds[0]), inf, NO_LEADER, speeds[1:])
