"""The footpaths of the running network: the lanes that people walk on, edge by edge."""

import itertools
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from giveway.sumo.network.lanes import admits

_IN_JUNCTION = re.compile(r"^:(.*)_[wc]?\d+$")  # the edge of a crossing, walkingarea or turn
_ASIDE = 1.0  # Distance [m] beside a lane, from which SUMO lets people walk back onto it
_HALF_BODY = 0.25  # Distance [m] that a person keeps from the lane's edge near its ends
_NEAR_END = 8.0  # Distance [m] to a lane's ends, from which on a person may be beside it
_LANE_END = 0.05  # Distance [m] that a person keeps from the lane's ends


@dataclass(frozen=True, slots=True)
class Foot:
    """The point of a lane that is nearest to some place."""

    lane: str
    position: float  # [m] place along the lane, in SUMO's metres
    lateral: float  # [m] offset to the left of the centre line, at most 1 m beside the lane
    distance: float  # [m] distance from the centre line
    apart: float = 0.0  # [m] distance from the place to which SUMO would move a person


@dataclass(frozen=True, slots=True)
class _Lane:
    """The remembered properties of a lane for pedestrians."""

    name: str
    shape: Sequence[tuple[float, float]]
    length: float  # [m] SUMO's nominal length
    metres: float  # [m] length of the polyline
    half_width: float  # [m] largest distance of a body's centre from the centre line

    @property
    def stretch(self) -> float:
        """The nominal length of 1 m of the polyline."""
        return self.length / max(self.metres, 1e-9)


class FootPaths:
    """The lanes that people walk on, edge by edge.

    Args:
        sumo: The libsumo module.
    """

    def __init__(self, sumo: Any) -> None:
        self._sumo = sumo
        self._lane = cache(self._find)
        self.junctions = cache(self._ends)  # junctions at both ends of an edge
        self._links_in, self._targets = cache(self._walks_in), cache(self._leads_to)

    def lane(self, edge: str) -> str | None:
        """Return the lane on which SUMO lets people walk along ``edge``, or None."""
        lane = self._lane(edge)
        return None if lane is None else lane.name

    def foot(self, edge: str, x: float, y: float) -> Foot | None:
        """Return the nearest point of the edge's footpath, or None without a footpath."""
        lane = self._lane(edge)
        if lane is None:
            return None
        best, passed = (math.inf, 0.0, 0.0), 0.0
        for (x0, y0), (x1, y1) in itertools.pairwise(lane.shape):
            dx, dy = x1 - x0, y1 - y0
            length = math.hypot(dx, dy)
            if length > 0.0:
                share = min(max(((x - x0) * dx + (y - y0) * dy) / length**2, 0.0), 1.0)
                distance = math.hypot(x - x0 - share * dx, y - y0 - share * dy)
                side = (dx * (y - y0) - dy * (x - x0)) / length
                best = min(best, (distance, passed + share * length, side))
            passed += length
        distance, along, side = best
        position = _inside(lane, along * lane.stretch)
        far = _NEAR_END < position < lane.length - _NEAR_END
        reach = lane.half_width + (_HALF_BODY + _ASIDE if far else 0.0)
        lateral = min(max(side, -reach), reach)
        there = _point(lane.shape, position / lane.stretch, lateral)
        return Foot(lane.name, position, lateral, distance, math.dist(there, (x, y)))

    def at(self, edge: str, position: float, lateral: float = 0.0) -> Foot | None:
        """The point at ``position`` [m] of the edge's footpath, moved onto it if outside."""
        lane = self._lane(edge)
        if lane is None:
            return None
        lateral = min(max(lateral, -lane.half_width), lane.half_width)
        return Foot(lane.name, _inside(lane, position), lateral, abs(lateral))

    def index(self, person: str, edges: Sequence[str], lane: str, arrival: float) -> int:
        """Return the index in ``edges`` (of its route) of the edge of a person on ``lane``.

        For a person inside a junction, it is the edge before the junction.
        """
        edge = lane.rpartition("_")[0]
        inside = _IN_JUNCTION.match(edge)
        if inside is None:
            found = [k for k, name in enumerate(edges) if name == edge]
        else:
            junction = inside.group(1)
            pairs = enumerate(itertools.pairwise(edges))
            found = [k for k, pair in pairs if all(junction in self.junctions(e) for e in pair)]
        if len(found) == 1:
            return found[0]
        return self._by_distance(person, edges, arrival, found or range(len(edges)))

    def _by_distance(
        self, person: str, edges: Sequence[str], arrival: float, candidates: Sequence[int]
    ) -> int:
        """Return the index of the edge from which the rest of the route is as long as the person's.

        This is for an edge that a route repeats. Where no footpaths join the edges, SUMO knows no
        distance, and the nearest candidate is taken.
        """
        sumo = self._sumo
        try:
            left = sumo.person.getWalkingDistance(person, edges[-1], arrival)
        except (sumo.TraCIException, sumo.FatalTraCIError):
            return self._nearest(edges, candidates, *sumo.person.getPosition(person))
        lengths = [self._sumo.lane.getLength(f"{edge}_0") for edge in edges]
        return min(candidates, key=lambda k: abs(sum(lengths[k + 1 : -1]) + arrival - left))

    def _nearest(self, edges: Sequence[str], candidates: Sequence[int], x: float, y: float) -> int:
        """Return the first candidate whose footpath is closest to a place [m]."""

        def distance(k: int) -> float:
            foot = self.foot(edges[k], x, y)
            return math.inf if foot is None else foot.distance

        return min(candidates, key=distance)

    def forward(self, edge: str, following: str) -> bool | None:
        """Return whether SUMO walks along an edge to its end, to reach the following one.

        SUMO does where the edge's end touches the following one. None: both ends touch it, so that
        people may also walk the other way.
        """
        begin, end = self.junctions(edge)
        touched = self.junctions(following)
        if begin in touched and end in touched:
            return None
        return end in touched

    def gap(self, edge: str, following: str) -> float:
        """Return the distance [m] from the end of a footpath to the beginning of the next one."""
        lane, there = self._lane(edge), self._lane(following)
        if lane is None or there is None:
            return math.inf
        last = self.forward(edge, following) is not False
        meets = self.junctions(edge)[last] == self.junctions(following)[0]
        return math.dist(lane.shape[-last], there.shape[0 if meets else -1])

    def joins(self, area: str, edge: str) -> bool:
        """Return whether people can walk inside a junction from a walkingarea to an edge's lane.

        Links of pedestrians are listed in one direction, and hold for both.
        """
        inside = _IN_JUNCTION.match(area)
        own = self.lane(edge)
        if inside is None or own is None:
            return True  # nothing is known
        links = self._links_in(inside.group(1))
        reached, ahead = {f"{area}_0"}, [f"{area}_0"]
        while ahead:
            lane = ahead.pop()
            if lane == own or own in links.get(lane, ()) or lane in self._targets(own):
                return True
            there = {*links.get(lane, ()), *(one for one, to in links.items() if lane in to)}
            ahead += [one for one in there - reached if one in links]
            reached |= there
        return False

    def _walks_in(self, junction: str) -> dict[str, frozenset[str]]:
        """Return the lanes onto which each walkingarea and crossing of a junction leads."""
        edges = self._sumo.edge.getIDList()
        found = [(edge, _IN_JUNCTION.match(edge)) for edge in edges if edge.startswith(":")]
        lanes = [f"{edge}_0" for edge, match in found if match and match[1] == junction]
        return {lane: self._targets(lane) for lane in lanes}

    def _leads_to(self, lane: str) -> frozenset[str]:
        """Return the lanes to which the links of a lane lead."""
        return frozenset(link[0] for link in self._sumo.lane.getLinks(lane))

    def is_straight(self, edge: str, position: float, reach: float) -> bool:
        """Return whether a footpath has no bend and no end within ``reach`` [m] of a position."""
        lane = self._lane(edge)
        if lane is None:
            return False
        start, end, along = _segment(lane.shape, position / lane.stretch)
        return reach < along < math.dist(start, end) - reach

    def end_at(self, edge: str, junction: str) -> float | None:
        """Return the position [m] of an edge's end at a junction, or None if it has none there."""
        lane, (begin, end) = self._lane(edge), self.junctions(edge)
        if lane is None or junction not in (begin, end):
            return None
        return lane.length if junction == end else 0.0

    def along(self, edge: str, position: float, way: tuple[float, float]) -> float:
        """Return the component [m] of a way x, y [m] along an edge's footpath at a position [m]."""
        lane = self._lane(edge)
        if lane is None:
            return 0.0
        start, end, _ = _segment(lane.shape, position / lane.stretch)
        length = math.dist(start, end)
        return (way[0] * (end[0] - start[0]) + way[1] * (end[1] - start[1])) / length

    def _ends(self, edge: str) -> tuple[str, str]:
        """Return the junctions at both ends of an edge."""
        edges = self._sumo.edge
        return edges.getFromJunction(edge), edges.getToJunction(edge)

    def _find(self, edge: str) -> _Lane | None:
        """Find the lane that SUMO uses: one for pedestrians alone, else the first to admit them."""
        sumo = self._sumo
        try:
            names = [f"{edge}_{i}" for i in range(sumo.edge.getLaneNumber(edge))]
        except sumo.TraCIException:
            return None
        names = [name for name in names if admits(sumo, name, "pedestrian")]
        if not names:
            return None
        alone = (n for n in names if tuple(sumo.lane.getAllowed(n)) == ("pedestrian",))
        name = next(alone, names[0])
        shape = tuple(sumo.lane.getShape(name))
        metres = math.fsum(math.dist(a, b) for a, b in itertools.pairwise(shape))
        half_width = max(sumo.lane.getWidth(name) / 2 - _HALF_BODY, 0.0)
        return _Lane(name, shape, sumo.lane.getLength(name), metres, half_width)


def _inside(lane: _Lane, position: float) -> float:
    """Return ``position`` [m], moved off the ends of the lane."""
    margin = min(_LANE_END, lane.length / 2)
    return min(max(position, margin), lane.length - margin)


def _segment(
    shape: Sequence[tuple[float, float]], station: float
) -> tuple[tuple[float, float], tuple[float, float], float]:
    """Return both ends of a line's piece at a station [m], and the station in the piece [m]."""
    pieces = [(a, b, math.dist(a, b)) for a, b in itertools.pairwise(shape) if a != b]
    for a, b, length in pieces:
        if station <= length:
            return a, b, station
        station -= length
    a, b, length = pieces[-1]
    return a, b, length


def _point(
    shape: Sequence[tuple[float, float]], station: float, lateral: float
) -> tuple[float, float]:
    """Return the point at a station [m] of a line, ``lateral`` [m] to its left."""
    (x0, y0), (x1, y1), station = _segment(shape, station)
    length = math.dist((x0, y0), (x1, y1))
    dx, dy = (x1 - x0) / length, (y1 - y0) / length
    return x0 + dx * station - dy * lateral, y0 + dy * station + dx * lateral
