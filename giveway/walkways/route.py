"""The way-points of one person's walk, from where the person is to where the walk ends."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from giveway.walkways import gates as g
from giveway.walkways.graph import End
from giveway.walkways.hops import Hop, Stretch, Ways
from giveway.walkways.polyline import usable_half_width

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from giveway.walkways.graph import Tree, WalkGraph
    from giveway.walkways.reading import Survey

    Array = NDArray[np.float64]

_TOGETHER = 0.05  # [m] way-points nearer to each other than this are one


@dataclass(frozen=True)
class WalkRoute:
    """The way ahead of one person; at least one way-point, the last is the walk's end.

    Attributes:
        waypoints: (k, 2) [m], the present place left out.
        passages: (k, 3) unit direction in which a way-point's line is crossed, and how far [m]
            beside the point one may cross it and still have passed.
        signals: (k,) index into ``WalkNetwork.signals`` where one waits for green, else -1.
        gaps: how many times the network knows no way on and the route goes straight.
    """

    waypoints: Array
    passages: Array
    signals: NDArray[np.int64]
    gaps: int


class Router:
    """Puts ways together from pieces that it builds once.

    Args:
        survey: what the network file says.
        graph: its walkingareas and crossings.
    """

    def __init__(self, survey: Survey, graph: WalkGraph) -> None:
        self._edges = survey.edges
        self._survey = survey
        self._graph = graph
        self._ways = Ways(survey, graph)

    def route(
        self,
        edges: Sequence[str],
        position: tuple[float, float],
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
        if lane.startswith(":"):
            pieces, more = self._from_junction(walk, place, position, arrival)
        else:
            pieces, more = self._from_lane(walk, place, position, arrival)
        rows = np.concatenate(pieces)
        if side is None:
            side = self._side_now(place, position, rows)
        return _finished(rows, side, gaps + more)

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
        lane = self._edges[edge].lane
        if position < 0.0:
            position += lane.length
        share = position / lane.length if lane.length > 0.0 else 0.0
        return min(1.0, max(0.0, share)) * self._graph.lines[edge].length

    # --- where one begins ---------------------------------------------------------------------

    def _from_lane(
        self, walk: list[str], place: str, position: tuple[float, float], arrival: float
    ) -> tuple[list[Array], int]:
        """The way of somebody on the lane of the first edge, or beside all lanes."""
        if place in walk:
            walk = walk[walk.index(place) :]
        first = self._graph.lines[walk[0]]
        station, _ = first.project(*position)
        if len(walk) == 1:
            return [self._ways.partly(Stretch(walk[0], arrival >= station), station, arrival)], 0
        best: tuple[float, list[Array], int] | None = None
        for stretches in self._ways.directed(walk):
            ahead = first.length - station if stretches[0].forward else station
            pieces, length, gaps = self._ways.onwards(stretches, arrival)
            start = self._ways.partly(stretches[0], station, first.length * stretches[0].forward)
            if best is None or (gaps, ahead + length) < (best[2], best[0]):
                best = ahead + length, [start[:-1], *pieces], gaps
        assert best is not None
        return best[1], best[2]

    def _from_junction(
        self, walk: list[str], place: str, position: tuple[float, float], arrival: float
    ) -> tuple[list[Array], int]:
        """The way of somebody in a walkingarea, on a crossing or elsewhere inside a junction."""
        ways = self._ways
        junction = place[1 : place.rfind("_")]
        best: tuple[tuple[int, float], list[Array]] | None = None
        for whole in ways.directed(walk):
            stretches = self._behind(whole, junction)
            first = stretches[0]
            begin, distance, connected = self._into(place, position, first.entry)
            if len(stretches) == 1:
                rest, gaps = [ways.partly(first, None, arrival)], 0
                distance += abs(arrival - ways.station(first.entry))
            else:
                onwards, length, gaps = ways.onwards(stretches, arrival)
                rest = [ways.bends(first), *onwards]
                distance += self._graph.lines[first.edge].length + length
            order = gaps + (not connected), distance
            if best is None or order < best[0]:
                best = order, [begin, *rest]
        assert best is not None
        return best[1], best[0][0]

    def _behind(self, stretches: list[Stretch], junction: str) -> list[Stretch]:
        """The part of a walk behind a junction in which one is."""
        for i, stretch in enumerate(stretches[:-1]):
            if self._ways.junction(stretch.exit) == junction:
                return stretches[i + 1 :]
        return stretches

    def _into(self, place: str, position: tuple[float, float], entry: End) -> Hop:
        """The gates from a place in a junction to a lane's end."""
        graph = self._graph
        tree = graph.towards(entry)
        found = None
        if place in self._survey.crossings:
            found = self._off_crossing(place, position, tree)
        elif place in self._survey.walkingareas:
            found = self._out_of_area(place, position, tree)
        if found is not None:
            return Hop(*found, connected=True)
        straight = g.turned(graph.lane_end(entry))
        paved = place in self._survey.walkingareas or place in self._survey.crossings
        open_ground = not paved and not graph.portals_of(entry)
        return Hop(straight, math.dist(position, straight[0, :2]), connected=open_ground)

    def _out_of_area(
        self, place: str, position: tuple[float, float], tree: Tree
    ) -> tuple[Array, float] | None:
        """From the middle of a walkingarea: to the portal with the shortest way on."""
        graph = self._graph
        exits = [
            (tree.distance[i] + math.dist(position, graph.portal(i).gate[0, :2]), i)
            for i in graph.portals_in(place)
            if i in tree.distance and (i not in tree.leg or tree.leg[i].crossing)
        ]
        if not exits:
            return None
        distance, i = min(exits)
        way_out = g.turned(graph.portal(i).gate)
        here = g.gate(np.array(position), way_out[0, 4:6])
        between = graph.interior(place).between(here, way_out)
        onwards = graph.follow(i, tree) if i in tree.leg else way_out
        return np.concatenate([between, onwards]), distance

    def _off_crossing(
        self, place: str, position: tuple[float, float], tree: Tree
    ) -> tuple[Array, float] | None:
        """From the middle of a crossing: on in the direction of the walk, without waiting."""
        graph = self._graph
        line = graph.line(place)
        station, _ = line.project(*position)
        ways = []
        for last in (False, True):
            ahead = line.length - station if last else station
            for i in graph.portals_of(End(place, last)):
                if i not in tree.distance:
                    continue
                # The shortest way from this end leads back over the crossing?
                back = i in tree.leg and tree.leg[i].crossing
                ways.append((back, tree.distance[i] + ahead, i, last))
        if not ways:
            return None
        _, distance, i, last = min(ways)
        ahead_gates = line.gates(usable_half_width(graph.lane(place).width))[1:-1]
        stations = np.array(line.stations[1:-1])
        if last:
            ahead_gates = ahead_gates[stations > station]
        else:
            ahead_gates = g.turned(ahead_gates[stations < station])
        onwards = graph.follow(i, tree)
        return np.concatenate([ahead_gates, graph.portal(i).gate, onwards]), distance

    # --- the way on ---------------------------------------------------------------------------

    # --- the side -----------------------------------------------------------------------------

    def _side_now(self, place: str, position: tuple[float, float], rows: Array) -> float:
        """The side [-1, 1] of the way on which somebody is now, seen in walking direction."""
        graph = self._graph
        if place in self._survey.walkingareas or not graph.has_line(place):
            return g.side_at(rows, position)
        half_width = usable_half_width(graph.lane(place).width)
        if half_width == 0.0:
            return 0.0
        line = graph.line(place)
        station, left = line.project(*position)
        forward = float(line.gate_at(station, 0.0)[0, 4:6] @ rows[0, 4:6]) >= 0.0
        return (left if forward else -left) / half_width


def _finished(rows: Array, side: float, gaps: int) -> WalkRoute:
    side = min(1.0, max(-1.0, side))
    points = g.places(rows, side)
    if len(points) > 1:
        apart = np.abs(np.diff(points, axis=0)).max(axis=1) > _TOGETHER
        # Of several in one place the one with a signal stays, else the last.
        keep = np.append(apart, True) | (rows[:, 6] >= 0)
        rows, points = rows[keep], points[keep]
    return WalkRoute(points, g.passages(rows, side), g.signals(rows), gaps)


def _stay(position: tuple[float, float], gaps: int) -> WalkRoute:
    """One way-point where one is: the network knows none of the edges."""
    place = np.array([position], dtype=np.float64)
    return WalkRoute(place, np.zeros((1, 3)), np.array([-1], dtype=np.int64), gaps)
