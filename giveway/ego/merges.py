"""Merging: the ego and whoever comes onto the same lane from another one go one behind the other.

Where lanes become one (a zipper) or the ego changes lanes, whoever is ahead at the place goes
first, and the other keeps behind it as if it drove in front already: "vehicles in the through lane
enable those on the other one to change right before the narrowing, in turn" (Zippers in the German
road traffic regulations, StVO 2013, section 7(4)). Who is behind but so fast that it had to brake
firmly for the ego goes first as well (section 7(5): nobody is endangered by a change of lanes).
"""

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from giveway.ego.giving_way import HARDEST
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.sumo.merging import Merging

_SAMPLE = 0.5  # [m] between the points of the path that are looked at
_OTHERS = 1.25  # [m] half the width of those who come along the other lane, trucks included
_BESIDE = 0.2  # [m] between two vehicles on different lanes at least
_SIGHT = 80.0  # [m] before the place, from which on the ego looks for others
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


class Rival(NamedTuple):
    """A vehicle that is going to share a lane with the ego."""

    position: float  # [m] of its front bumper along the shared lane; negative: before it begins
    speed: float  # [m/s]
    length: float  # [m]


class Place(NamedTuple):
    """Where the ego's way and others become one."""

    lane: str  # that is shared
    over: frozenset[str]  # lanes right before it that the others come over; empty: any
    origin: float  # [m] station at which that lane begins
    entry: float  # [m] the front bumper's station from which on the ego is in their way
    end: float  # [m] and from which on it is on their lane


class Behind(NamedTuple):
    """What a vehicle that keeps behind the ego has to heed."""

    speed: float  # [m/s] at which the room moves on
    room: float  # [m] that it may still come closer to the ego; negative: it is too close
    to_wait: float  # [m] to where it is not in the ego's way yet
    braking: float  # [m/s^2] at most; inf: the ego is in its way already


def places_of(
    path: EgoPath, half_width: float, mergings: Sequence[Merging], departure: float
) -> tuple[Place, ...]:
    """Where an ego comes into the way of others.

    Args:
        path: of the ego.
        half_width: of its body [m].
        mergings: along its route.
        departure: station [m] at which it enters.
    """
    apart = half_width + _OTHERS + _BESIDE
    places = []
    for merging in mergings:
        last = min(merging.end, path.length)
        stations = np.arange(max(merging.begin, departure), last, _SAMPLE)
        if not len(stations):
            continue
        near = _distances(path.points(stations), merging.lines)
        if near.min() >= apart:
            continue
        clear = np.flatnonzero(near >= apart)
        if merging.over:  # the ways meet at its end
            first = clear[-1] + 1 if len(clear) else 0
            entry = float(stations[min(first, len(stations) - 1)])
            end = last
        else:
            entry = float(stations[np.argmax(near < apart)])
            end = float(stations[np.argmax(near <= near.min() + _BESIDE)])
        places.append(Place(merging.lane, merging.over, merging.origin, entry, end))
    return tuple(sorted(places, key=lambda place: place.entry))


def _distances(points: Array, lines: Sequence[Array]) -> Array:
    """(n,) [m] of ``points`` (n, 2) [m] to the closest of polylines."""
    x, y = points.T
    nearest = np.full(len(x), np.inf)
    for line in lines:
        for (x_0, y_0), (x_1, y_1) in itertools.pairwise(line):
            d_x, d_y = x_1 - x_0, y_1 - y_0
            squared = max(d_x * d_x + d_y * d_y, 1e-12)
            share = np.clip(((x - x_0) * d_x + (y - y_0) * d_y) / squared, 0.0, 1.0)
            nearest = np.minimum(nearest, np.hypot(x - x_0 - share * d_x, y - y_0 - share * d_y))
    return nearest


class Merges:
    """The order in which one ego and others come onto lanes that they are going to share.

    Args:
        places: of the ego's path, by their entries.
        length: of its body [m].
    """

    def __init__(self, places: Sequence[Place], length: float) -> None:
        self._places = list(places)
        self._length = length
        self._first: list[tuple[Place, Rival]] = []  # who goes before the ego
        self._behind: set[str] = set()  # who does not
        self._waited = 0.0  # [s]

    def in_sight(self, front: float) -> tuple[Place, ...]:
        """The places that the ego comes to; those behind it are forgotten.

        Args:
            front: station of the front bumper [m].
        """
        while self._places and self._places[0].end <= front:
            del self._places[0]
        return tuple(p for p in self._places if p.entry - front <= _SIGHT and p.end > front)

    def see(
        self, rivals: Mapping[Place, Mapping[str, Rival]], front: float, speed: float
    ) -> dict[str, Behind]:
        """Take note of the others; those that keep behind the ego.

        Args:
            rivals: by their ids, at each place in sight.
            front: station of the ego's front bumper [m].
            speed: of the ego [m/s].
        """
        self._first.clear()
        asks = _FIRM if self._waited > _PATIENCE else _ASKED
        behind: dict[str, Behind] = {}
        for place, others in rivals.items():
            for name, rival in others.items():
                asked = _FIRM if name in self._behind else asks
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
        self._behind = set(behind)
        return behind

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

    def look(self, front: float, speed: float) -> tuple[Leader, float]:
        """Whom the ego follows already, and the station [m] at which it waits for the others.

        Args:
            front: station of the front bumper [m].
            speed: of the ego [m/s].
        """
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
        return leader, stop

    def pass_time(self, time_step: float, speed: float) -> None:
        """Let the others drive on while SUMO does not step.

        Args:
            time_step: [s].
            speed: of the ego [m/s].
        """
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
