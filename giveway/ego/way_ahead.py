"""What bounds the way ahead of an ego: lights, stops, crossings and junctions."""

import math
from collections.abc import Mapping, Set

from giveway.ego.crossings import Crossings
from giveway.ego.giving_way import at_rest
from giveway.ego.kerbs import Kerbs
from giveway.ego.lights import Lights
from giveway.ego.merges import Merges
from giveway.ego.perception.leader import Leader
from giveway.ego.right_of_way import RightOfWay, Traffic
from giveway.ego.stops import Stops
from pedestrian_model import Crowd


class WayAhead:
    """Finds the first place at which an ego has to stop.

    Args:
        lights: the traffic lights on its path; None: it heeds none.
        stops: that it serves; None: none.
        crossings: at which it gives way; None: at none.
        right_of_way: at junctions; None: it keeps to none.
        merges: where it comes onto a lane together with others; None: nowhere.
        kerbs: beside its path; None: there is no sidewalk, or it is no matter.

    Attributes:
        systems: SUMO's ids of the traffic lights that matter.
        bounds: there is anything on its path that may bound it.
        visited: the junctions on the path, where it keeps to right of way.
        stop: station [m] at which it had to stop when it last asked; inf: nowhere.
    """

    def __init__(
        self,
        lights: Lights | None = None,
        stops: Stops | None = None,
        crossings: Crossings | None = None,
        right_of_way: RightOfWay | None = None,
        merges: Merges | None = None,
        kerbs: Kerbs | None = None,
    ) -> None:
        self.stops = stops
        self.kerbs = kerbs
        self.merges = merges
        self.stop = math.inf
        self._lights = lights
        self._crossings = crossings
        self._right_of_way = right_of_way
        self.visited = () if right_of_way is None else right_of_way.junctions
        kept_free = [] if crossings is None else crossings.kept_free
        kept_free += [] if right_of_way is None else right_of_way.kept_free
        self._kept_free = sorted(kept_free)
        parts = lights, stops, crossings, right_of_way, merges
        self.bounds = any(part is not None for part in parts)
        watched = [part for part in (lights, crossings, right_of_way, kerbs) if part is not None]
        self.systems = frozenset[str]().union(*(part.systems for part in watched))

    @property
    def beside(self) -> Set[str]:
        """The names of vehicles whose lanes lead them past the path, at the next junctions."""
        return frozenset() if self._right_of_way is None else self._right_of_way.beside

    @property
    def latest(self) -> float:
        """Station [m] beyond which no plan leads, before a crossing; inf: anywhere."""
        return math.inf if self._crossings is None else self._crossings.latest

    def junctions(self, front: float) -> frozenset[str]:
        """SUMO's ids of the junctions whose traffic matters to an ego at ``front`` [m]."""
        return frozenset() if self._right_of_way is None else self._right_of_way.look(front)

    def to_clear(self, front: float) -> float:
        """How far [m] it has to drive on to leave the crossings and junctions that it is on.

        Args:
            front: station of the front bumper [m].
        """
        left = 0.0
        for entry, leave in self._kept_free:
            if entry >= front:
                break
            left = max(left, leave - front)
        return left

    def look(
        self, time: float, front: float, speed: float, states: Mapping[str, str], traffic: Traffic
    ) -> None:
        """Take note of lights and traffic, once after each of SUMO's steps.

        Args:
            time: SUMO's clock [s].
            front: station of the front bumper [m].
            speed: [m/s].
            states: of each light system, one letter per movement (SUMO's).
            traffic: who approaches the junctions that :meth:`junctions` named.
        """
        if self._lights is not None:
            self._lights.update(states, front, speed)
        if self._crossings is not None:
            self._crossings.update(states)
        if self.kerbs is not None:
            self.kerbs.update(states)
        if self._right_of_way is not None:
            self._right_of_way.update(time, front, speed, states, traffic)

    def stop_at(
        self, front: float, speed: float, crowd: Crowd, leader: Leader
    ) -> tuple[float, str]:
        """Station [m] at which the front bumper has to stop first, and what for; (inf, "").

        Args:
            front: station of the front bumper [m].
            speed: [m/s].
            crowd: the pedestrians as the ego sees them.
            leader: the vehicle ahead.
        """
        place, cause = math.inf, ""
        if self._lights is not None:
            place, cause = self._lights.stop_at(front, speed), "light"
            leader = at_rest(leader, place)
        if self.stops is not None:
            place, cause = min((place, cause), (self.stops.stop_at(front, speed), "stop"))
        if self._crossings is not None:
            stop = self._crossings.stop_at(front, speed, crowd, leader)
            place, cause = min((place, cause), (stop, "yield"))
        if self._right_of_way is not None:
            stop = self._right_of_way.stop_at(front, speed, leader)
            place, cause = min((place, cause), (stop, "yield"))
        self.stop = place
        return place, cause if place < math.inf else ""

    def unhurried(
        self, front: float, speed: float, wanted: float, leader: Leader, gap: float
    ) -> float:
        """The speed [m/s] at which it arrives at a light when that is green; inf: any.

        Args:
            front: station of the front bumper [m].
            speed: now [m/s].
            wanted: speed [m/s] of a free ego.
            leader: the vehicle ahead.
            gap: [m] that is kept to it.
        """
        if self._lights is None:
            return math.inf
        return self._lights.unhurried(front, speed, wanted, leader, gap)

    def pass_time(self, front: float, speed: float, time_step: float) -> None:
        """Once after each control step of ``time_step`` [s]: has it halted, has it waited?

        Args:
            front: station of the front bumper [m].
            speed: [m/s].
            time_step: [s].
        """
        if self.stops is not None:
            self.stops.pass_time(front, speed)
        if self.merges is not None:
            self.merges.pass_time(time_step, speed)
