"""Merging: the order in which the ego and vehicles from another lane come onto one lane.

Lanes become one at a zipper, and where the ego changes lanes. The vehicle that is ahead at the
merge point goes first. The other one follows it as if both were on one lane already: "vehicles in
the through lane enable those on the other one to change right before the narrowing, in turn"
(zippers in the German road traffic regulations, StVO 2013, section 7(4)). A vehicle behind the ego
goes first as well if it is so fast that it would have to brake firmly for the ego (section 7(5):
nobody is endangered by a change of lanes).
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from controller.driving_constants import COMFORTABLE, FIRM, STANDING
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.merge_points import (
    FollowingConstraint,
    MergePoint,
    MergingVehicle,
    merge_points_of,
)
from giveway.ego.rules.protocol import YIELD, Demand, Needs, Situation
from giveway.ego.rules.route import RouteContext

_BEFORE = 1.0  # distance [m] before the merge point at which a vehicle waits for a short one
_SHORT, _SWEPT = 4.0, 0.5  # length [m] of a short vehicle; added distance per metre beyond it
_GAP = 1.0  # gap [m] between two vehicles behind the merge point
_OPENING = 0.25  # part of the gap [m] that may be missing per metre before the merge point
_PATIENCE = 5.0  # time [s] that counts as a long wait
_REACTION = 0.5  # reaction time [s] of a merging vehicle
_SLOWEST = 1.0  # speed [m/s] from which on an ego is no longer waiting
_LATER = 2.0  # time [s]: a vehicle that arrives this long after the ego does not matter


class Merging:
    """The order in which one ego and others come onto lanes that they are going to share.

    Args:
        places: Merge points on the ego's path, by their entries.
        length: Length of its body [m].

    Attributes:
        needs: Needs of the rule: its merge points.
        keeps_behind: Following constraint of each vehicle that goes after the ego, by its id.
    """

    def __init__(self, places: tuple[MergePoint, ...], length: float) -> None:
        self._length = length
        self._first: list[tuple[MergePoint, MergingVehicle]] = []  # vehicles that go before the ego
        self._waited = 0.0  # time [s] for which the ego has waited
        self.keeps_behind: dict[str, FollowingConstraint] = {}
        self.needs = Needs(merges=places)

    @classmethod
    def on(cls, route: RouteContext) -> Merging | None:
        """The rule on one ego's route, or None if it has no merge point or a rule is off."""
        if not (route.heeds("merging") and route.heeds("following")):
            return None
        found = route.session.lanes.mergings(route.lane_path)
        places = merge_points_of(route.path, route.shape.width / 2, found, route.departure)
        return cls(places, route.shape.length) if places else None

    def update(self, situation: Situation) -> None:
        """Decide which vehicles go first at the merge points in sight.

        Args:
            situation: Present situation of the ego.
        """
        if situation.merging:
            self._see(situation.merging, situation.station, situation.speed)

    def _see(
        self,
        merging_vehicles: Mapping[MergePoint, Mapping[str, MergingVehicle]],
        front: float,
        speed: float,
    ) -> None:
        """Sort the vehicles at the merge points into those before and those after the ego.

        Args:
            merging_vehicles: Vehicles at each merge point in sight, by their ids.
            front: Station of the ego's front bumper [m].
            speed: Speed of the ego [m/s].
        """
        self._first.clear()
        asks = FIRM if self._waited > _PATIENCE else COMFORTABLE
        behind: dict[str, FollowingConstraint] = {}
        for place, others in merging_vehicles.items():
            for name, other in others.items():
                asked = FIRM if name in self.keeps_behind else asks
                if not self._goes_first(place, front, speed, other, asked):
                    self._first.append((place, other))
                    continue
                ahead = place.entry - front
                opening = _OPENING if ahead > 0.0 else 0.0
                room = self._room(place, front, other) + opening * ahead
                moves = (1.0 - opening) * speed
                to_wait = _to_place(place, other) - _before(self._length)
                here = FollowingConstraint(moves, room, to_wait, asks if ahead > 0.0 else math.inf)
                if name not in behind or here.room < behind[name].room:
                    behind[name] = here
        self.keeps_behind = behind

    def _room(self, place: MergePoint, front: float, other: MergingVehicle) -> float:
        return front - place.origin - self._length - other.position - _GAP

    def _goes_first(
        self, place: MergePoint, front: float, speed: float, other: MergingVehicle, asked: float
    ) -> bool:
        """Return whether the ego goes before a vehicle that would brake at most with ``asked``.

        Args:
            place: Merge point.
            front: Station of the ego's front bumper [m].
            speed: Speed of the ego [m/s].
            other: Vehicle that merges.
            asked: Deceleration [m/s^2] that the vehicle may be made to brake with.
        """
        to_go, its_way = place.entry - front, _to_place(place, other)
        ahead = other.position - (front - place.origin)
        if to_go <= 0.0 or its_way <= 0.0:
            return ahead < 0.0
        time = to_go / max(speed, _SLOWEST)
        later = its_way > (time + _LATER) * max(other.speed, STANDING)
        if later or ahead >= 0.0:
            return later
        to_stop = its_way - _before(self._length) - other.speed * _REACTION
        if other.speed * other.speed <= 2.0 * asked * max(to_stop, 0.0):
            return True
        room = self._room(place, front, other) + _OPENING * to_go
        closing = max(0.0, other.speed - (1.0 - _OPENING) * speed)
        if room > closing * _REACTION:
            return closing * closing <= 2.0 * asked * (room - closing * _REACTION)
        shortage = closing * time - room
        return 2.0 * shortage <= asked * time * time

    def demand(self, situation: Situation) -> Demand | None:
        """The merging vehicle that the ego follows, and the stop at which it waits for others.

        Args:
            situation: Present situation of the ego.
        """
        if not self._first:
            return None
        front, speed = situation.station, situation.speed
        leader, stop = NO_LEADER, math.inf
        for place, other in self._first:
            to_go = place.entry - front
            if to_go <= 0.0:
                continue  # a vehicle ahead is in the ego's corridor by now
            rear = place.origin + other.position - other.length + _OPENING * to_go
            # The missing part of the gap shrinks as the ego nears the merge point.
            moves = max(0.0, other.speed - _OPENING * speed)
            room, closing = rear - front - _GAP, max(0.0, speed - moves)
            can_wait = speed * speed <= 2.0 * FIRM * to_go
            if room >= 0.0 and (closing * closing <= 2.0 * FIRM * room or not can_wait):
                leader = min(leader, Leader(rear, moves))
            elif can_wait:
                place_to_wait = place.entry - _before(other.length)
                stop = min(stop, max(place_to_wait, min(front, place.entry)))
        return Demand(stop, YIELD, leader=leader)

    def advance(self, situation: Situation, time_step: float) -> None:
        """Move the merging vehicles on between SUMO's steps, and measure the ego's wait.

        Args:
            situation: Situation after the control step.
            time_step: Length of the step [s].
        """
        speed = situation.speed
        if speed > _SLOWEST or not self._first:
            self._waited = 0.0
        elif speed < STANDING:
            self._waited += time_step
        self._first = [
            (place, other._replace(position=other.position + other.speed * time_step))
            for place, other in self._first
        ]


def _before(length: float) -> float:
    """The distance [m] before the merge point at which to wait for a vehicle of this length."""
    return _BEFORE + _SWEPT * max(0.0, length - _SHORT)


def _to_place(place: MergePoint, other: MergingVehicle) -> float:
    """The distance [m] that a vehicle can drive until it obstructs the ego."""
    return place.entry - place.origin - other.position
