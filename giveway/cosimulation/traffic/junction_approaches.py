"""The vehicles that approach the junctions on the egos' paths, egos included."""

from collections.abc import Mapping, Sequence, Set
from typing import NamedTuple

import numpy as np

from giveway.ego.ego import Ego
from giveway.ego.rules.junctions import Approach, Traffic
from giveway.sumo.background import BackgroundVehicles
from giveway.sumo.session import SumoSession

_RANGE = 150.0  # Distance [m] from an ego up to which other vehicles are considered
_STANDING = 0.1  # Speed [m/s] below which a vehicle stands
_FORGET = 4  # Remembered routes per vehicle, above which all are forgotten


class _Visit(NamedTuple):
    """A junction ahead of a vehicle."""

    junction: str
    number: int  # number of the movement through the junction
    station: float  # station [m] of its stop line, from the beginning of the present lane


class TrafficWatch:
    """Finds the vehicles that approach a junction, once after each SUMO step.

    Args:
        session: The running simulation.
    """

    def __init__(self, session: SumoSession) -> None:
        self._session = session
        self._visits: dict[tuple[str, str, str], tuple[_Visit, ...]] = {}
        self._inside: dict[str, _Visit] = {}  # position of each known lane inside a junction
        self._known: set[str] = set()
        self._stands: dict[str, float] = {}  # time [s] at which each vehicle came to a stop

    def of(self, background: BackgroundVehicles, egos: Sequence[Ego]) -> Traffic:
        """The approaching vehicles of each junction ahead of an ego, egos included, nearest first.

        Args:
            background: The background vehicles now.
            egos: Egos on the road now.
        """
        found: dict[str, list[Approach]] = {}
        for ego in egos:
            found |= {junction: [] for junction in ego.rules.near_junctions(ego.front)}
        if found:
            self._learn(found.keys())
            self._add_background(background, egos, found)
            self._add_egos(egos, found)
            for approaches in found.values():
                approaches.sort(key=lambda approach: (approach.distance, approach.name))
        return found

    def _learn(self, junctions: Set[str]) -> None:
        """Find the lanes inside junctions that are not known yet."""
        lanes = self._session.lanes
        for junction in junctions - self._known:
            for movement in self._session.junctions.of(junction).values():
                station = 0.0
                for lane in movement.inside:
                    self._inside[lane] = _Visit(junction, movement.number, station)
                    station += lanes.length(lane)
            self._visits.clear()
            self._known.add(junction)

    def _add_background(
        self,
        background: BackgroundVehicles,
        egos: Sequence[Ego],
        found: Mapping[str, list[Approach]],
    ) -> None:
        if len(self._visits) > _FORGET * len(background.ids):
            self._visits.clear()
        near = np.zeros(len(background.ids), dtype=bool)
        for ego in egos:
            x, y, _ = ego.pose
            near |= np.hypot(background.x - x, background.y - y) < _RANGE
        vehicles = self._session.vehicles
        for i in np.flatnonzero(near):
            name, speed = background.ids[i], float(background.speed[i])
            lane, route, position = vehicles.whereabouts(name)
            if not lane:
                continue
            key = name, lane, route
            visits = self._visits.get(key)
            if visits is None:
                visits = self._visits[key] = self._find(name, lane)
            standing = self._standing(name, speed)
            for junction, number, station in visits:
                if junction in found:
                    distance, length = station - position, float(background.length[i])
                    approach = Approach(name, number, distance, speed, length, standing)
                    found[junction].append(approach)

    def _find(self, name: str, lane: str) -> tuple[_Visit, ...]:
        """The junctions ahead of a vehicle; stations are SUMO's positions on its lane."""
        lanes, vehicles = self._session.lanes, self._session.vehicles
        visits, begin = [], 0.0
        for each in vehicles.lanes_ahead(name, lane, _RANGE):
            inside = self._inside.get(each)
            if inside is not None and (inside.station == 0.0 or each == lane):
                visits.append(inside._replace(station=begin - inside.station))
            begin += vehicles.lane_length(lane) if each == lane else lanes.length(each)
        return tuple(visits)

    def _add_egos(self, egos: Sequence[Ego], found: Mapping[str, list[Approach]]) -> None:
        for ego in egos:
            speed = ego.vehicle.speed
            standing = self._standing(ego.id, speed)
            for place in ego.rules.junctions:
                distance = place.entry - ego.front
                if place.movement.junction in found and distance < _RANGE:
                    own = place.movement
                    approach = Approach(
                        ego.id, own.number, distance, speed, ego.shape.length, standing
                    )
                    found[own.junction].append(approach)

    def _standing(self, name: str, speed: float) -> float:
        """The time [s] for which a vehicle has stood, or 0 if it moves."""
        if speed >= _STANDING:
            self._stands.pop(name, None)
            return 0.0
        now = self._session.time
        return now - self._stands.setdefault(name, now)
