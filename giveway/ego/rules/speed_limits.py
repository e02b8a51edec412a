"""Speed limits: the ego drives no faster than its lanes, its bends and its vehicle allow."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf

from controller.driving_constants import COMFORTABLE
from giveway.ego.perception.leader import NO_LEADER
from giveway.ego.rules.protocol import Demand, Situation
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.speed_profile import SpeedProfile
from giveway.geometry.kernel import Array
from giveway.sumo.network.lane_path import SpeedLimit


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
        profile, lanes = route.profile, route.session.lanes
        if profile is None:
            return None
        if not lanes.limits_change:
            return cls(profile, route.times_ahead)
        return VariableSpeedLimits(
            profile, route.times_ahead, route.lane_path.limits, lanes.speed_limit
        )

    def demand(self, situation: Situation) -> Demand:
        """The speeds not to be exceeded.

        Args:
            situation: Present situation of the ego.
        """
        station, speed = situation.station, situation.speed
        limit = self._profile.limit(station, speed)
        ahead = self._profile.ahead(station, speed, self._times)
        return Demand(inf, "", inf, limit, inf, NO_LEADER, ahead)


class VariableSpeedLimits(SpeedLimits):
    """Speed limits that variable speed signs or calibrators change during the drive.

    An ego that is faster than a new limit comes down to it with the comfortable deceleration.

    Args:
        profile: Speed of a free ego at each station of the path.
        times: Times (N,) [s] of the steps that the ego looks ahead.
        limits: Limits of the lanes along the path, by which the profile was made.
        limit_of: Function that returns the present limit [m/s] of a lane.
    """

    def __init__(
        self,
        profile: SpeedProfile,
        times: Array,
        limits: Sequence[SpeedLimit],
        limit_of: Callable[[str], float],
    ) -> None:
        super().__init__(profile, times)
        self._limits, self._limit_of = list(limits), limit_of
        self._changed, self._before = -inf, 0.0  # time [s] and speed [m/s] at the last change

    def update(self, situation: Situation) -> None:
        """Take note of the limits.

        Args:
            situation: Present situation of the ego.
        """
        limits = [
            limit._replace(speed=min(map(self._limit_of, limit.lanes))) for limit in self._limits
        ]
        if limits != self._limits:
            self._limits = limits
            self._profile.change(limits)
            self._changed, self._before = situation.time, situation.speed

    def demand(self, situation: Situation) -> Demand:
        """The speeds not to be exceeded.

        Args:
            situation: Present situation of the ego.
        """
        demand = super().demand(situation)
        braking = self._before - COMFORTABLE * (situation.time - self._changed)
        return demand._replace(speed=max(demand.speed, braking))
