"""The rules that hold for one ego, and what they demand together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf
from typing import Any

from giveway.ego.perception.hidden_people import NOWHERE, Hidden
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.crossings import Crossings
from giveway.ego.rules.hidden_people import HiddenPeople
from giveway.ego.rules.junctions import SIGHT
from giveway.ego.rules.merge_points import SIGHT as MERGE_SIGHT
from giveway.ego.rules.merge_points import FollowingConstraint, MergePoint
from giveway.ego.rules.merging import Merging
from giveway.ego.rules.plug_ins.plug_in import plugged_in_rules
from giveway.ego.rules.protocol import LIGHT, NO_NEEDS, Rule, Situation, Told
from giveway.ego.rules.right_of_way import RightOfWay
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.scheduled_stops import ScheduledStops
from giveway.ego.rules.speed_limits import SpeedLimits
from giveway.ego.rules.traffic_lights import TrafficLights
from giveway.ego.rules.yielding import firm_stop
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

RULES: tuple[Callable[[RouteContext], Rule | None], ...] = (
    ScheduledStops.on,
    Merging.on,  # before the rules that use the vehicle ahead
    TrafficLights.on,  # before the rules that use the station where that vehicle comes to rest
    Crossings.on,
    RightOfWay.on,
    SpeedLimits.on,
    HiddenPeople.on,
)
"""The factories of giveway's own rules, in the order in which the rules are asked.

Each returns the rule of one ego, or None if nothing on its route falls under the rule. To add a
rule: its file, its line here, its key in `giveway.config.tables.rules`.
"""

BEYOND = 0.1, 0.5  # distance [m] beyond a demanded stop that a plan may lead to; of a late demand
STOPS_EARLY = 0.4  # distance [m] before it at which a plan's wanted speed is 0; plans lag behind


class RuleSet:
    """Asks each rule of one ego, and keeps the strictest of what they demand.

    Args:
        rules: Rules in the order in which they are asked.
        time: SUMO's clock [s] at the departure.

    Attributes:
        situation: Situation that the rules know now; it is refilled in place.
        watches: Whether any rule has to be updated after SUMO's steps.
        needs: Needs of each rule; `NO_NEEDS` for a rule without any.
        junctions: Junctions whose traffic matters, in the path's order.
        systems: SUMO's ids of the signal systems that matter.
        stop: Station [m] at which the front bumper has to stop; inf if it need not stop.
        cause: Reason of the stop; empty without one.
        latest: Station [m] beyond which no plan may lead; inf without such a bound.
        speed: Speed [m/s] not to be exceeded now; inf without a limit.
        advice: Speed [m/s] advised to a controller that plans ahead; inf without advice.
        leader: Vehicle to be followed as if it were ahead; `NO_LEADER` without one.
        lane_speeds: Speeds (N,) [m/s] not to be exceeded in the steps ahead, or None.
    """

    def __init__(self, rules: Sequence[Rule] = (), time: float = 0.0) -> None:
        self.situation = Situation(time)
        self._rules = tuple(rules)
        self._demands = tuple(rule.demand for rule in rules)
        self._updates: tuple[Any, ...] = _methods(rules, "update")
        self._advances: tuple[Any, ...] = _methods(rules, "advance")
        self.needs = [getattr(rule, "needs", NO_NEEDS) for rule in rules]
        self.systems = frozenset[str]().union(*(needs.systems for needs in self.needs))
        self.junctions = tuple(place for needs in self.needs for place in needs.junctions)
        self._merges = tuple(place for needs in self.needs for place in needs.merges)
        self._keep_clear = sorted(area for needs in self.needs for area in needs.keep_clear)
        self.watches = bool(self._updates)
        self._reset()

    @classmethod
    def on(cls, route: RouteContext) -> RuleSet:
        """The rules that hold on one ego's route: giveway's own, then those of other packages.

        Args:
            route: Route of the ego.

        Raises:
            GivewayError: a rule of another package cannot be found or made.
        """
        made = (factory(route) for factory in RULES)
        own = [rule for rule in made if rule is not None]
        return cls([*own, *plugged_in_rules(route)], route.time)

    def _reset(self) -> None:
        self.stop = self.latest = self.speed = self.advice = inf
        self.cause = ""
        self.leader = NO_LEADER
        self.lane_speeds: Array | None = None
        self.situation.stop_at_light = inf

    @property
    def beside(self) -> frozenset[str]:
        """The ids of vehicles that, by a rule, will pass beside the path at the next junctions."""
        return frozenset[str]().union(*(getattr(rule, "beside", ()) for rule in self._rules))

    @property
    def keeps_behind(self) -> dict[str, FollowingConstraint]:
        """The following constraint of each vehicle that merges behind the ego, by its id."""
        found: dict[str, FollowingConstraint] = {}
        if not self.situation.merging:
            return found  # no merge point is in sight
        for rule in self._rules:
            found |= getattr(rule, "keeps_behind", {})
        return found

    @property
    def remarks(self) -> list[str]:
        """The remarks on how the drive went, one sentence each."""
        return [said for rule in self._rules for said in getattr(rule, "remarks", ())]

    def near_junctions(self, station: float) -> set[str]:
        """SUMO's ids of the junctions in sight.

        Args:
            station: Station of the front bumper [m].
        """
        return {
            place.movement.junction
            for place in self.junctions
            if place.exit >= station and place.entry - station <= SIGHT
        }

    def near_merges(self, station: float) -> tuple[MergePoint, ...]:
        """The merge points in sight.

        Args:
            station: Station of the front bumper [m].
        """
        return tuple(
            p for p in self._merges if p.end > station and p.entry - station <= MERGE_SIGHT
        )

    def keep_clear_distance(self, station: float) -> float:
        """The distance [m] to drive until the ego has left the keep-clear zone that it stands on.

        The distance is 0 if the ego stands on none.

        Args:
            station: Station of the front bumper [m].
        """
        left = 0.0
        for entry, leave in self._keep_clear:
            if entry >= station:
                break
            left = max(left, leave - station)
        return left

    def update(self, time: float, station: float, speed: float, told: Told) -> None:
        """Pass the state of SUMO after its step to the rules.

        Args:
            time: SUMO's clock [s].
            station: Station of the front bumper [m].
            speed: Speed of the ego [m/s].
            told: State of the signals, and the vehicles near the path, as far as a rule needs them.
        """
        situation = self.situation
        situation.time, situation.station, situation.speed = time, station, speed
        situation.signals, situation.traffic, situation.merging = told
        for update in self._updates:
            update(situation)

    def look(
        self, station: float, speed: float, crowd: Crowd, leader: Leader, hidden: Hidden = NOWHERE
    ) -> None:
        """Ask each rule what it demands, and keep the strictest.

        Args:
            station: Station of the front bumper [m].
            speed: Speed of the ego [m/s].
            crowd: Pedestrians as the ego sees them.
            leader: Vehicle ahead.
            hidden: Places ahead where people could come out of hiding.
        """
        if not self._demands:
            return
        situation = self.situation
        situation.station, situation.speed = station, speed
        situation.crowd, situation.leader, situation.hidden = crowd, leader, hidden
        self._reset()
        for ask in self._demands:
            demand = ask(situation)
            if demand is None:
                continue
            stop, cause, latest, cap, advice, ahead, lane_speeds = demand
            if stop < self.stop:
                self.stop, self.cause = stop, cause
                firm = firm_stop(station, speed) - stop
                self.latest = min(self.latest, stop + min(max(firm, BEYOND[0]), BEYOND[1]))
            if cause == LIGHT:
                situation.stop_at_light = stop
            if latest < self.latest:
                self.latest = latest
            if cap < self.speed:
                self.speed = cap
            if advice < self.advice:
                self.advice = advice
            if ahead is not NO_LEADER:
                self.leader = min(self.leader, ahead)
                situation.leader = min(situation.leader, ahead)
            if lane_speeds is not None:
                known = self.lane_speeds
                self.lane_speeds = lane_speeds if known is None else known.clip(max=lane_speeds)

    def advance(self, station: float, speed: float, time_step: float) -> None:
        """Advance the rules by one control step.

        Args:
            station: Station of the front bumper [m] after the step.
            speed: Speed of the ego [m/s] after the step.
            time_step: Length of the step [s].
        """
        situation = self.situation
        situation.time += time_step
        if self._advances:
            situation.station, situation.speed = station, speed
            for advance in self._advances:
                advance(situation, time_step)


def _methods(rules: Sequence[Rule], name: str) -> tuple[Any, ...]:
    """The method ``name`` of each rule that has it."""
    return tuple(getattr(rule, name) for rule in rules if hasattr(rule, name))
