"""Speed limits: the ego drives no faster than its lanes, its bends and its vehicle allow."""

from __future__ import annotations

from giveway.ego.perception.leader import NO_LEADER
from giveway.ego.rules.protocol import Demand, Situation
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.speed_profile import SpeedProfile
from giveway.geometry.kernel import Array


class SpeedLimits:
    """Caps the speed along one ego's path, now and in the steps ahead.

    Args:
        profile: Speed of a free ego at each station of the path.
        times: Times (N,) [s] of the steps that the ego looks ahead.
    """

    def __init__(self, profile: SpeedProfile, times: Array) -> None:
        self._profile = profile
        self._times = times

    @classmethod
    def on(cls, route: RouteContext) -> SpeedLimits | None:
        """The rule on one ego's route; None if its free speed is the same everywhere."""
        profile = route.profile
        return None if profile is None else cls(profile, route.times_ahead)

    def demand(self, situation: Situation) -> Demand:
        """The speeds not to be exceeded.

        Args:
            situation: Present situation of the ego.
        """
        station, speed = situation.station, situation.speed
        limit = self._profile.limit(station, speed)
        ahead = self._profile.ahead(station, speed, self._times)
        inf = float("inf")
        return Demand(inf, "", inf, limit, inf, NO_LEADER, ahead)
