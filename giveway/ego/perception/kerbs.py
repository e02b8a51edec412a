"""The kerbs beside an ego's path, and the people on the sidewalks behind them.

The safety layer assumes that people on a sidewalk start towards the road less suddenly than people
on the road or on open ground (docs/safety.md). People beside a crossing are about to step on the
road, so they do not count as being on a sidewalk, unless their light is red.
"""

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import shapely
import shapely.ops
from numpy.typing import NDArray

from giveway.crowd.crossings import is_open
from giveway.ego.perception.kerb_kernels import LOOK, LOOKS, NEAR, drop_kerbs, fill_kerbs
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.sumo.network.pedestrian_crossings import Crossing
from giveway.sumo.signal_plans import ChangeOf, SignalChange, untold
from pedestrian_model import Crowd

NO_KERBS: Array = np.zeros((0, 3))
"""The kerbs (0, 3) if nobody is on a sidewalk."""

_PIECE = 2.0  # largest length [m] of a piece of kerb
_STRETCH = 20.0  # length [m] of the stretches of path that are searched for kerbs
_FACING = 0.5  # least cosine of the angle between the direction to the path and a kerb's normal
_BESIDE = 0.25  # distance [m] from the ego's side, within which nobody counts as on a sidewalk
_SOON = 3.0  # time [s] before green, within which people are about to use a crossing
_BEHIND, _AHEAD = 10.0, 60.0  # stretch [m] behind and ahead of the bumper on which people matter


class Kerbs:
    """The kerbs beside one ego's path.

    Args:
        path: Path of the ego.
        width: Width of its body [m].
        sidewalks: Function that returns the sidewalks of the network that reach into an area.
        crossings: Crossings of the network.
        change_of: Function that returns the next change of a traffic light by its id, or None if
            it is unknown.

    Attributes:
        systems: SUMO's ids of the traffic lights that govern the crossings.
    """

    def __init__(
        self,
        path: EgoPath,
        width: float,
        sidewalks: Callable[[shapely.Geometry], shapely.Geometry],
        crossings: Sequence[Crossing],
        change_of: ChangeOf = untold,
    ) -> None:
        line = shapely.LineString(path.vertices)
        strip = line.buffer(width / 2.0 + _BESIDE, cap_style="flat")
        area = sidewalks(line.buffer(NEAR)).difference(strip)
        pieces = [_pieces(np.asarray(ring.coords)[:, :2]) for ring in _rings(area)]
        edges = np.concatenate([*pieces, np.empty((0, 4))])
        edges = edges[line.distance(shapely.linestrings(edges.reshape(-1, 2, 2))) <= NEAR]
        passed, stations = _passed(line, edges)
        edges = edges[passed]
        middle = (edges[:, :2] + edges[:, 2:]) / 2.0
        away = path.points(stations) - middle
        away /= np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-9)[:, None]
        along = edges[:, 2:] - edges[:, :2]
        along /= np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-9)[:, None]
        facing = away[:, 0] * along[:, 1] - away[:, 1] * along[:, 0]  # the area is on the left
        order = np.argsort(stations, kind="stable")
        self._edges = np.ascontiguousarray(edges[order])
        self._stations = stations[order]
        self._kerb = np.ascontiguousarray((facing >= _FACING)[order])
        self._crossings = _near(crossings, line)
        self._mouths = self._open = self._opening = _mouths(self._crossings)
        self._change_of = change_of
        self.systems = frozenset(crossing.system for crossing in self._crossings) - {""}

    def __bool__(self) -> bool:
        return bool(self._kerb.any())

    def update(self, states: Mapping[str, str]) -> None:
        """Update the states of the traffic lights.

        Args:
            states: State of each signal system by its id, one of SUMO's letters per movement.
        """
        if self.systems:
            changes = {system: self._change_of(system) for system in self.systems}
            closed = np.array(
                [_closed_for(each, states, changes.get(each.system)) for each in self._crossings]
            )
            self._open = self._mouths[closed <= _SOON]
            self._opening = self._mouths[closed <= _SOON + LOOKS * LOOK]

    def of(self, position: Array, velocity: Array, front: float) -> Array:
        """The kerbs (n, 3) of people: unit vector to the kerb and distance [m]; 0 off sidewalks.

        Where a sidewalk becomes narrower, the nearest kerb may begin ahead of a person who walks
        along it. The line of this kerb then counts instead of its beginning, if all kerbs near the
        person are beyond the line and the person needs longer to reach it.

        Args:
            position: Positions (n, 2) [m] of the people.
            velocity: Velocities (n, 2) [m/s] of the people.
            front: Station of the ego's front bumper [m].
        """
        found = np.zeros((len(position), 3))
        first, last = np.searchsorted(self._stations, (front - _BEHIND, front + _AHEAD))
        edges, is_kerb = self._edges[first:last], self._kerb[first:last]
        fill_kerbs(position, velocity, edges, is_kerb, self._open, found)
        return found

    def kept(self, people: Crowd, kerbs: Array, whom: NDArray[np.bool_] | None) -> Array:
        """Return ``kerbs`` (n, 3) with 0 for people who will soon be about to use a crossing.

        These people get close to a crossing, or are close to one that is about to open. Plans
        assume that they may step on the road at once. Otherwise a person who gets there a few
        metres ahead of the ego would make it brake hard.

        Args:
            people: People (n,) as the ego perceives them. Their routes and velocities count.
            kerbs: Kerbs (m, 3) from :meth:`of`.
            whom: Marks (m,) of the rows of ``kerbs`` that belong to the people, or None for all.
        """
        kept = kerbs.copy() if whom is None else kerbs[whom]
        way = people.waypoints, people.waypoint_start, people.waypoint_index
        walks = people.position, people.velocity, people.desired_speed
        drop_kerbs(walks, way, self._opening, kept)
        return kept


def kerb_lines(position: Array, kerbs: Array) -> Array:
    """The lines (n, 3), a x + b y = c [m], of people's kerbs as straight lines.

    Args:
        position: Positions (n, 2) [m] of the people.
        kerbs: Kerbs (n, 3) of the people, from :meth:`Kerbs.of`.
    """
    if not len(kerbs):
        return NO_KERBS
    lines = kerbs.copy()
    lines[:, 2] += (kerbs[:, :2] * position).sum(axis=1)
    return lines


def _rings(area: shapely.Geometry) -> list[shapely.LinearRing]:
    """The rings of an area, which is on their left."""
    found = []
    for polygon in getattr(area, "geoms", [area]):
        if polygon.geom_type == "Polygon" and not polygon.is_empty:
            oriented = shapely.geometry.polygon.orient(polygon)
            found += [oriented.exterior, *oriented.interiors]
    return found


def _pieces(ring: Array) -> Array:
    """The segments (k, 4) of a ring, x0, y0, x1, y1 [m], each at most ``_PIECE`` long."""
    ways = np.diff(ring, axis=0)
    counts = np.maximum(1, np.ceil(np.hypot(ways[:, 0], ways[:, 1]) / _PIECE)).astype(np.int64)
    cut = [
        ring[i] + np.outer(np.arange(count + 1) / count, ways[i]) for i, count in enumerate(counts)
    ]
    return np.concatenate([np.hstack([points[:-1], points[1:]]) for points in cut])


def _passed(line: shapely.LineString, edges: Array) -> tuple[NDArray[np.int64], Array]:
    """Return the indices of the edges that a path passes, and the stations [m] where it does.

    An edge that the path passes twice is listed twice.
    """
    lines = shapely.STRtree(shapely.linestrings(edges.reshape(-1, 2, 2)))
    middles = shapely.points((edges[:, :2] + edges[:, 2:]) / 2.0)
    which, where = [np.empty(0, dtype=np.int64)], [np.empty(0)]
    for begin in np.arange(0.0, line.length, _STRETCH):
        first, last = max(0.0, begin - _STRETCH), begin + 2.0 * _STRETCH
        part = shapely.ops.substring(line, first, min(last, line.length))
        near = np.sort(lines.query(part, predicate="dwithin", distance=NEAR))
        stations = first + shapely.line_locate_point(part, middles[near])
        end = math.inf if begin + _STRETCH >= line.length else begin + _STRETCH
        here = (begin <= stations) & (stations < end)
        which.append(near[here])
        where.append(stations[here])
    return np.concatenate(which), np.concatenate(where)


def _near(crossings: Sequence[Crossing], line: shapely.LineString) -> list[Crossing]:
    """The crossings near a path."""
    ways = [(crossing, shapely.LineString(crossing.ends)) for crossing in crossings]
    return [crossing for crossing, way in ways if way.length > 0.0 and line.distance(way) <= NEAR]


def _mouths(crossings: Sequence[Crossing]) -> Array:
    """Return the crossings as rows (k, 7).

    Each row has a kerb [m], the unit vector to the other one, length and half width [m], and 1 if
    people have to wait for a gap there, else 0.
    """
    rows = []
    for crossing in crossings:
        kerb, other = crossing.ends
        length = float(np.hypot(*(other - kerb)))
        across = (other - kerb) / length
        waits = not (crossing.zebra or crossing.system)
        rows.append((*kerb, *across, length, crossing.width / 2.0, waits))
    return np.array(rows, dtype=np.float64).reshape(-1, 7)


def _closed_for(
    crossing: Crossing, states: Mapping[str, str], change: SignalChange | None
) -> float:
    """Return the time [s] for which people will have red at a crossing; 0 if it is open."""
    state = states.get(crossing.system, "")
    if not state or is_open(state, crossing.link, zebra=crossing.zebra):
        return 0.0
    if change is None or not is_open(change.state, crossing.link, zebra=crossing.zebra):
        return math.inf  # no change to green is known
    return change.time
