"""The way-points of one person's walk, from where the person is to where the walk ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from giveway.walkways import gates as g
from giveway.walkways.hops import Stretch, Ways
from giveway.walkways.polyline import usable_half_width
from giveway.walkways.starts import Starts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from numpy.typing import NDArray

    from giveway.walkways.graph import WalkGraph
    from giveway.walkways.reading import Survey

    Array = NDArray[np.float64]
    Place = tuple[float, float]

_TOGETHER = 0.05  # [m] way-points nearer to each other than this are one


@dataclass(frozen=True)
class WalkRoute:
    """The way ahead of one person; at least one way-point, the last is the walk's end.

    Attributes:
        waypoints: (k, 2) [m], the present place left out.
        passages: (k, 3) unit direction in which a way-point's line is crossed, and how far [m]
            beside the point, the way's middle, one may cross it and have passed.
        signals: (k,) index into ``WalkNetwork.signals`` where one waits for green, else -1.
        gaps: how many times the network knows no way on and the route goes straight.
    """

    waypoints: Array
    passages: Array
    signals: NDArray[np.int64]
    gaps: int


class _Way(NamedTuple):
    """One of the ways somebody could go."""

    gaps: int
    length: float  # [m]
    side: float  # [-1, 1] on which one is now, seen in walking direction
    gates: Callable[[float], list[Array]]  # by the side that one keeps to


class Router:
    """Puts ways together from pieces that it builds once.

    Args:
        survey: what the network file says.
        graph: its walkingareas and crossings.
    """

    def __init__(self, survey: Survey, graph: WalkGraph) -> None:
        self._edges = survey.edges
        self._lines = graph.lines
        self._ways = Ways(survey, graph)
        self._starts = Starts(survey, graph)

    def route(
        self,
        edges: Sequence[str],
        position: Place,
        lane: str,
        arrival_position: float,
        side: float | None,
    ) -> WalkRoute:
        """See :meth:`giveway.walkways.WalkNetwork.route`."""
        walk, gaps = self._known(edges)
        if not walk:
            return _stay(position, max(gaps, 1))
        place = lane[: lane.rfind("_")]
        arrival = self._arrival(walk[-1], arrival_position)
        begin = self._from_junction if lane.startswith(":") else self._from_lane
        best = min(begin(walk, place, position, arrival), key=lambda way: (way.gaps, way.length))
        side = min(1.0, max(-1.0, best.side if side is None else side))
        return _finished(np.concatenate(best.gates(side)), position, gaps + best.gaps)

    def _known(self, edges: Iterable[str]) -> tuple[list[str], int]:
        """The edges that can be walked, without repetitions, and how many others there were."""
        walk: list[str] = []
        gaps = 0
        for edge in edges:
            if edge.startswith(":"):
                continue  # a walkingarea or crossing: found again from its neighbours
            if edge not in self._edges:
                gaps += 1
            elif not walk or walk[-1] != edge:
                walk.append(edge)
        return walk, gaps

    def _arrival(self, edge: str, position: float) -> float:
        """The station [m] on the centre line of a position in SUMO's metres."""
        length = self._edges[edge].lane.length
        if position < 0.0:
            position += length
        share = position / length if length > 0.0 else 0.0
        return min(1.0, max(0.0, share)) * self._lines[edge].length

    def _from_lane(
        self, walk: list[str], place: str, position: Place, arrival: float
    ) -> Iterator[_Way]:
        """The ways of somebody on the lane of the first edge, or beside all lanes."""
        ways = self._ways
        if place in walk:
            walk = walk[walk.index(place) :]
        station, left = self._lines[walk[0]].project(*position)
        half_width = usable_half_width(self._edges[walk[0]].lane.width)
        left = left / half_width if half_width > 0.0 else 0.0
        if len(walk) == 1:
            only = Stretch(walk[0], arrival >= station)
            goal = ways.partly(only, station, arrival)
            yield _Way(0, abs(arrival - station), left if only.forward else -left, lambda _: [goal])
            return
        for stretches in ways.directed(walk):
            first = stretches[0]
            gaps, length = ways.measure(stretches, arrival)
            end = ways.station(first.exit)
            bends = ways.partly(first, station, end)[:-1]

            def gates(
                side: float, bends: Array = bends, stretches: list[Stretch] = stretches
            ) -> list[Array]:
                return [bends, *ways.gates(stretches, arrival, side)]

            yield _Way(gaps, length + abs(end - station), left if first.forward else -left, gates)

    def _from_junction(
        self, walk: list[str], place: str, position: Place, arrival: float
    ) -> Iterator[_Way]:
        """The ways of somebody in a walkingarea, on a crossing or elsewhere inside a junction."""
        ways = self._ways
        junction = place[1 : place.rfind("_")]
        for whole in ways.directed(walk):
            stretches = ways.behind(whole, junction)
            first = stretches[0]
            start = self._starts.into(place, position, first.entry)
            gaps, length = ways.measure(stretches, arrival)
            goes_on = len(stretches) > 1
            end = ways.station(first.exit) if goes_on else arrival
            bends = ways.partly(first, None, end)[: -1 if goes_on else None]

            def gates(
                side: float,
                begin: Callable[[float], Array] = start.gates,
                bends: Array = bends,
                stretches: list[Stretch] = stretches,
            ) -> list[Array]:
                return [begin(side), bends, *ways.gates(stretches, arrival, side)]

            length += start.length + abs(end - ways.station(first.entry))
            yield _Way(gaps + (not start.connected), length, start.side, gates)


def _finished(rows: Array, position: Place, gaps: int) -> WalkRoute:
    points = rows[:, :2].copy()
    if len(points) > 1:
        apart = np.abs(np.diff(points, axis=0)).max(axis=1) > _TOGETHER
        # Of several in one place the one with a signal stays, else the last.
        keep = np.append(apart, True) | (rows[:, 6] >= 0)
        rows, points = rows[keep], points[keep]
    return WalkRoute(points, g.passages(rows, position), g.signals(rows), gaps)


def _stay(position: Place, gaps: int) -> WalkRoute:
    """One way-point where one is: the network knows none of the edges."""
    place = np.array([position], dtype=np.float64)
    return WalkRoute(place, np.zeros((1, 3)), np.array([-1], dtype=np.int64), gaps)
