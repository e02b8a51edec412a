"""The route of one person: way-points from the present place to the end of the walk."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.walkways import gates as g
from giveway.walkways.gates import Array, Place
from giveway.walkways.graph import WalkGraph
from giveway.walkways.hops import Pieces, Stretch
from giveway.walkways.polyline import usable_half_width
from giveway.walkways.reading import Survey
from giveway.walkways.starts import Starts

_TOGETHER = 0.05  # Distance [m] below which two way-points are one


@dataclass(frozen=True)
class WalkRoute:
    """The route ahead of one person; the last way-point is the end of the walk.

    Attributes:
        waypoints: Way-points (k, 2) [m] in the middle of the walkway, without the present place.
        passages: Unit direction in which a way-point's line is crossed, and distance [m] beside the
            way-point up to which a crossing of the line counts as a passage (k, 3).
        signals: Index (k,) into ``WalkNetwork.signals`` where people wait for green, a larger one
            where they wait for a gap, else -1.
        gaps: Number of missing connections, over which the route goes straight on.
    """

    waypoints: Array
    passages: Array
    signals: NDArray[np.int64]
    gaps: int


class _Candidate(NamedTuple):
    """One of the routes that a person could take."""

    gaps: int
    length: float  # [m] length
    side: float  # [-1, 1] present side of the person, seen in walking direction
    gates: Callable[[float], list[Array]]  # function of the person's side that returns the gates


class Router:
    """Puts routes together from pieces, which it builds once.

    Args:
        survey: Contents of the network file.
        graph: Walkingareas and crossings of the network.
    """

    def __init__(self, survey: Survey, graph: WalkGraph) -> None:
        self._edges = survey.edges
        self._lines = graph.lines
        self._pieces = Pieces(survey, graph)
        self._starts = Starts(survey, graph)

    def route(
        self,
        edges: Sequence[str],
        position: Place,
        lane: str,
        arrival_position: float,
        side: float | None,
    ) -> WalkRoute:
        """Return the route; see :meth:`giveway.walkways.WalkNetwork.route`."""
        known, gaps = self._known(edges)
        if not known:
            return _stay(position, max(gaps, 1))
        place = lane[: lane.rfind("_")]
        arrival = self._arrival(known[-1], arrival_position)
        begin = self._from_junction if lane.startswith(":") else self._from_lane
        candidates = begin(known, place, position, arrival)
        best = min(candidates, key=lambda candidate: (candidate.gaps, candidate.length))
        side = min(1.0, max(-1.0, best.side if side is None else side))
        return _finished(np.concatenate(best.gates(side)), position, gaps + best.gaps)

    def _known(self, edges: Iterable[str]) -> tuple[list[str], int]:
        """Return the edges that people can walk, once each, and the number of the others."""
        known: list[str] = []
        gaps = 0
        for edge in edges:
            if edge.startswith(":"):
                continue  # a walkingarea or crossing, which is found again from its neighbours
            if edge not in self._edges:
                gaps += 1
            elif not known or known[-1] != edge:
                known.append(edge)
        return known, gaps

    def _arrival(self, edge: str, position: float) -> float:
        """Return the station [m] on the centre line of a position in SUMO's metres."""
        length = self._edges[edge].lane.length
        if position < 0.0:
            position += length
        share = position / length if length > 0.0 else 0.0
        return min(1.0, max(0.0, share)) * self._lines[edge].length

    def _from_lane(
        self, edges: list[str], place: str, position: Place, arrival: float
    ) -> Iterator[_Candidate]:
        """Yield the routes of a person on the lane of the first edge, or beside all lanes."""
        pieces = self._pieces
        if place in edges:
            edges = edges[edges.index(place) :]
        station, left = self._lines[edges[0]].project(*position)
        half_width = usable_half_width(self._edges[edges[0]].lane.width)
        left = left / half_width if half_width > 0.0 else 0.0
        if len(edges) == 1:
            only = Stretch(edges[0], arrival >= station)
            goal = pieces.partly(only, station, arrival)
            side = left if only.forward else -left
            yield _Candidate(0, abs(arrival - station), side, lambda _: [goal])
            return
        for stretches in pieces.directed(edges):
            first = stretches[0]
            gaps, length = pieces.measure(stretches, arrival)
            end = pieces.station(first.exit)
            bends = pieces.partly(first, station, end)[:-1]
            length += abs(end - station)

            def gates(
                side: float, bends: Array = bends, stretches: list[Stretch] = stretches
            ) -> list[Array]:
                return [bends, *pieces.gates(stretches, arrival, side)]

            yield _Candidate(gaps, length, left if first.forward else -left, gates)

    def _from_junction(
        self, edges: list[str], place: str, position: Place, arrival: float
    ) -> Iterator[_Candidate]:
        """Yield the routes of a person in a walkingarea, on a crossing or in a junction."""
        pieces = self._pieces
        junction = place[1 : place.rfind("_")]
        for whole in pieces.directed(edges):
            stretches = pieces.behind(whole, junction)
            first = stretches[0]
            start = self._starts.into(place, position, first.entry)
            gaps, length = pieces.measure(stretches, arrival)
            goes_on = len(stretches) > 1
            end = pieces.station(first.exit) if goes_on else arrival
            bends = pieces.partly(first, None, end)[: -1 if goes_on else None]

            def gates(
                side: float,
                begin: Callable[[float], Array] = start.gates,
                bends: Array = bends,
                stretches: list[Stretch] = stretches,
            ) -> list[Array]:
                return [begin(side), bends, *pieces.gates(stretches, arrival, side)]

            length += start.length + abs(end - pieces.station(first.entry))
            yield _Candidate(gaps + (not start.connected), length, start.side, gates)


def _finished(rows: Array, position: Place, gaps: int) -> WalkRoute:
    points = rows[:, :2].copy()
    if len(points) > 1:
        apart = np.abs(np.diff(points, axis=0)).max(axis=1) > _TOGETHER
        # Of several way-points in one place, the one with a signal is kept, else the last one.
        keep = np.append(apart, True) | (rows[:, 6] >= 0)
        rows, points = rows[keep], points[keep]
    return WalkRoute(points, g.passages(rows, position), g.signals(rows), gaps)


def _stay(position: Place, gaps: int) -> WalkRoute:
    """Return the route to the present place, for a network that knows none of the edges."""
    place = np.array([position], dtype=np.float64)
    return WalkRoute(place, np.zeros((1, 3)), np.array([-1], dtype=np.int64), gaps)
