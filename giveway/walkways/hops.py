"""The route along a sequence of edges: bends on the edges, and hops over the junctions."""

import itertools
import math
from functools import cache
from typing import NamedTuple

import numpy as np

from giveway.walkways import gates as g
from giveway.walkways.gates import Array
from giveway.walkways.graph import End, WalkGraph
from giveway.walkways.polyline import usable_half_width
from giveway.walkways.reading import Survey

_ROUND = 0.6  # Distance [m] behind the dead end of a road at which people turn round
_AT_END = 1.0  # Distance [m] up to which two lanes' ends meet


class Stretch(NamedTuple):
    """An edge of a route and the direction in which it is walked."""

    edge: str
    forward: bool

    @property
    def entry(self) -> End:
        """The end at which the edge is entered."""
        return End(self.edge, not self.forward)

    @property
    def exit(self) -> End:
        """The end at which the edge is left."""
        return End(self.edge, self.forward)


class Hop(NamedTuple):
    """The route over a junction from one lane's end to another's."""

    portal: int | None  # portal at its beginning, or None if it goes straight across
    length: float  # [m] length
    connected: bool


class Pieces:
    """The pieces of routes; each is built when it is first needed.

    Args:
        survey: Contents of the network file.
        graph: Walkingareas and crossings of the network.
    """

    def __init__(self, survey: Survey, graph: WalkGraph) -> None:
        self._edges = survey.edges
        self._graph = graph
        self._hop = cache(self._new_hop)
        self._over = cache(self._gates_of_hop)
        self.bends = cache(self._bends)  # gates of an edge's bends, by its stretch

    def directed(self, edges: list[str]) -> list[list[Stretch]]:
        """Return the edges with directions, which follow from the junctions that they share."""
        routes = []
        for forward in (True, False):
            stretches = [Stretch(edges[0], forward)]
            meets = 0
            for edge in edges[1:]:
                exit_ = stretches[-1].exit
                junction = self.junction(exit_)
                begins, ends = self._edges[edge].junctions
                meets += junction in (begins, ends)
                if junction in (begins, ends):
                    stretches.append(Stretch(edge, junction == begins))
                else:
                    stretches.append(Stretch(edge, self._nearer_end(exit_, edge)))
            routes.append((meets, stretches))
        most = max(meets for meets, _ in routes)
        return [stretches for meets, stretches in routes if meets == most]

    def _nearer_end(self, exit_: End, edge: str) -> bool:
        """Return whether the beginning of an edge is nearer than its end."""
        here = self._graph.lane_end(exit_)[0, :2]
        line = self._graph.lines[edge].points
        return math.dist(here, line[0]) <= math.dist(here, line[-1])

    def behind(self, stretches: list[Stretch], junction: str) -> list[Stretch]:
        """Return the part of a route behind the junction that the person is in."""
        for i, stretch in enumerate(stretches[:-1]):
            if self.junction(stretch.exit) == junction:
                return stretches[i + 1 :]
        return stretches

    def measure(self, stretches: list[Stretch], arrival: float) -> tuple[int, float]:
        """Return gaps and length [m] from the exit of the first stretch to the arrival."""
        if len(stretches) == 1:
            return 0, 0.0
        hops = [self._hop(a.exit, b.entry) for a, b in itertools.pairwise(stretches)]
        length = sum(hop.length for hop in hops)
        length += sum(self._graph.lines[there.edge].length for there in stretches[1:-1])
        length += abs(arrival - self.station(stretches[-1].entry))
        return sum(not hop.connected for hop in hops), length

    def gates(self, stretches: list[Stretch], arrival: float, side: float) -> list[Array]:
        """Return the gates from the exit of the first stretch to the arrival on the last."""
        track = g.track_of(side)
        pieces = []
        for here, there in itertools.pairwise(stretches):
            last = there is stretches[-1]
            onwards = self.partly(there, None, arrival) if last else self.bends(there)
            pieces += [self._over(here.exit, there.entry, track), onwards]
        return pieces

    def _new_hop(self, start: End, end: End) -> Hop:
        graph = self._graph
        tree = graph.towards(end)
        starts = [(tree.coming[i].distance, i) for i in graph.portals_of(start) if i in tree.coming]
        if starts:
            distance, i = min(starts)
            return Hop(i, distance, connected=True)
        distance = math.dist(graph.lane_end(start)[0, :2], graph.lane_end(end)[0, :2])
        meets = self.junction(start) == self.junction(end)
        # Without walkingareas, people go straight over the junction.
        open_ground = not graph.portals_of(start) and not graph.portals_of(end)
        return Hop(None, distance, (meets and open_ground) or distance < _AT_END)

    def _gates_of_hop(self, start: End, end: End, track: int) -> Array:
        """Return the gates of a hop, with those across the ends of both lanes."""
        graph, portal = self._graph, self._hop(start, end).portal
        if portal is None:
            onwards = g.turned(graph.lane_end(end))
        else:
            onwards = graph.follow(portal, graph.towards(end), track)
        gates = np.concatenate([graph.lane_end(start), onwards])
        if graph.at_dead_end(start) and graph.at_dead_end(end):
            gates[:, :2] += _ROUND * gates[0, 4:6]  # not before the cars that begin there
        return gates

    def junction(self, end: End) -> str:
        """Return the junction at an end."""
        return self._edges[end.edge].junctions[end.last]

    def station(self, end: End) -> float:
        """Return the station [m] of an end on its edge's centre line."""
        return self._graph.lines[end.edge].length if end.last else 0.0

    def _bends(self, stretch: Stretch) -> Array:
        """Return the gates of an edge's bends, without its ends."""
        half_width = usable_half_width(self._edges[stretch.edge].lane.width)
        found = self._graph.lines[stretch.edge].gates(half_width)[1:-1]
        return found if stretch.forward else g.turned(found)

    def partly(self, stretch: Stretch, start: float | None, end: float) -> Array:
        """Return the gates of an edge after ``start`` [m] (None: its entry) up to ``end`` [m]."""
        line = self._graph.lines[stretch.edge]
        if start is None:
            start = self.station(stretch.entry)
        goal = line.gate_at(end, usable_half_width(self._edges[stretch.edge].lane.width))
        if not stretch.forward:
            goal = g.turned(goal)
        bends = self.bends(stretch)
        if not len(bends):
            return goal
        stations = np.array(line.stations[1:-1])
        if not stretch.forward:
            stations = stations[::-1]
        low, high = (start, end) if stretch.forward else (end, start)
        return np.concatenate([bends[(stations > low) & (stations < high)], goal])
