"""Merging: the ego and whoever comes onto the same lane from another one go one behind the other.

Where lanes become one (a zipper) or the ego changes lanes, whoever is ahead at the place goes
first, and the other keeps behind it as if it drove in front already: "vehicles in the through lane
enable those on the other one to change right before the narrowing, in turn" (Zippers in the German
road traffic regulations, StVO 2013, section 7(4)). Who is behind but so fast that it had to brake
firmly for the ego goes first as well (section 7(5): nobody is endangered by a change of lanes).
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.merge_places import Behind, Place, Rival, places_of
from giveway.ego.rules.protocol import YIELD, Demand, Needs, Situation
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.yielding import HARDEST

_BEFORE = 1.0  # [m] before the place that a short vehicle waits for another one
_SHORT, _SWEPT = 4.0, 0.5  # [m] of length, beyond which this share of it cuts the corner
_GAP = 1.0  # [m] between two vehicles where the ways are one
_OPENING = 0.25  # [m] of that which may still be missing, per metre before the place
_ASKED = 2.0  # [m/s^2] that it may ask of them
_FIRM = 3.0  # [m/s^2] for an ego that has waited, or of somebody who brakes for it already
_PATIENCE = 5.0  # [s] that it waits before
_REACTION = 0.5  # [s] in which they do not brake yet
_SLOWEST = 1.0  # [m/s] of an ego that is on its way
_STANDING = 0.2  # [m/s]
_LATER = 2.0  # [s] after the ego, somebody who waits comes to the place


class Merging:
    """The order in which one ego and others come onto lanes that they are going to share.

    Args:
        places: Places on the ego's path, by their entries.
        length: Length of its body [m].

    Attributes:
        needs: The places where lanes become one.
        keeps_behind: What each vehicle that goes after the ego has to heed, by its id.
    """

    def __init__(self, places: tuple[Place, ...], length: float) -> None:
        self._length = length
        self._first: list[tuple[Place, Rival]] = []  # vehicles that go before the ego
        self._waited = 0.0  # time [s] for which the ego has waited
        self.keeps_behind: dict[str, Behind] = {}
        self.needs = Needs(merges=places)

    @classmethod
    def on(cls, route: RouteContext) -> Merging | None:
        """The rule on one ego's route; None if it shares no lane, or heeds no vehicles."""
        if not (route.heeds("merging") and route.heeds("following")):
            return None
        found = route.session.lanes.mergings(route.lane_path)
        places = places_of(route.path, route.shape.width / 2, found, route.departure)
        return cls(places, route.shape.length) if places else None

    def update(self, situation: Situation) -> None:
        """Decide who goes first, as far as a place is in sight.

        Args:
            situation: What the rules know now.
        """
        if situation.merging:
            self._see(situation.merging, situation.station, situation.speed)

    def _see(self, rivals: Mapping[Place, Mapping[str, Rival]], front: float, speed: float) -> None:
        """Take note of the others at each place in sight, and of those that go after the ego."""
        self._first.clear()
        asks = _FIRM if self._waited > _PATIENCE else _ASKED
        behind: dict[str, Behind] = {}
        for place, others in rivals.items():
            for name, rival in others.items():
                asked = _FIRM if name in self.keeps_behind else asks
                if not self._goes_first(place, front, speed, rival, asked):
                    self._first.append((place, rival))
                    continue
                ahead = place.entry - front
                opening = _OPENING if ahead > 0.0 else 0.0
                room = self._room(place, front, rival) + opening * ahead
                moves = (1.0 - opening) * speed
                to_wait = _to_place(place, rival) - _before(self._length)
                here = Behind(moves, room, to_wait, asks if ahead > 0.0 else math.inf)
                if name not in behind or here.room < behind[name].room:
                    behind[name] = here
        self.keeps_behind = behind

    def _room(self, place: Place, front: float, rival: Rival) -> float:
        return front - place.origin - self._length - rival.position - _GAP

    def _goes_first(
        self, place: Place, front: float, speed: float, rival: Rival, asked: float
    ) -> bool:
        """Whether the ego goes before another vehicle, which may have to brake as ``asked``."""
        to_go, its_way = place.entry - front, _to_place(place, rival)
        ahead = rival.position - (front - place.origin)
        if to_go <= 0.0 or its_way <= 0.0:
            return ahead < 0.0
        time = to_go / max(speed, _SLOWEST)
        later = its_way > (time + _LATER) * max(rival.speed, _STANDING)
        if later or ahead >= 0.0:
            return later
        to_stop = its_way - _before(self._length) - rival.speed * _REACTION
        if rival.speed * rival.speed <= 2.0 * asked * max(to_stop, 0.0):
            return True
        room = self._room(place, front, rival) + _OPENING * to_go
        closing = max(0.0, rival.speed - (1.0 - _OPENING) * speed)
        if room > closing * _REACTION:
            return closing * closing <= 2.0 * asked * (room - closing * _REACTION)
        shortage = closing * time - room
        return 2.0 * shortage <= asked * time * time

    def demand(self, situation: Situation) -> Demand | None:
        """The vehicle that the ego follows already, or where it waits for the others.

        Args:
            situation: What the rules know now.
        """
        if not self._first:
            return None
        front, speed = situation.station, situation.speed
        leader, stop = NO_LEADER, math.inf
        for place, rival in self._first:
            to_go = place.entry - front
            if to_go <= 0.0:
                continue  # whoever is ahead is in the ego's corridor
            rear = place.origin + rival.position - rival.length + _OPENING * to_go
            if rear >= front + _GAP:
                # as the place comes closer, less of the gap may be missing
                leader = min(leader, Leader(rear, max(0.0, rival.speed - _OPENING * speed)))
            elif speed * speed <= 2.0 * HARDEST * to_go:
                place_to_wait = place.entry - _before(rival.length)
                stop = min(stop, max(place_to_wait, min(front, place.entry)))
        return Demand(stop, YIELD, leader=leader)

    def advance(self, situation: Situation, time_step: float) -> None:
        """Let the others drive on while SUMO does not step.

        Args:
            situation: What the rules know after the control step.
            time_step: Length of the step [s].
        """
        speed = situation.speed
        if speed > _SLOWEST or not self._first:
            self._waited = 0.0
        elif speed < _STANDING:
            self._waited += time_step
        self._first = [
            (place, rival._replace(position=rival.position + rival.speed * time_step))
            for place, rival in self._first
        ]


def _before(length: float) -> float:
    """How far [m] before the place one waits for a vehicle of this length to go first."""
    return _BEFORE + _SWEPT * max(0.0, length - _SHORT)


def _to_place(place: Place, rival: Rival) -> float:
    """How far [m] a vehicle is from where it would be in the ego's way."""
    return place.entry - place.origin - rival.position
