"""The beginning of the route of a person who is inside a junction.

The person goes on from there: nobody is sent back to a kerb, and a person on a crossing does not
wait for its light.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from giveway.walkways import gates as g
from giveway.walkways.gates import Array, Place
from giveway.walkways.graph import End, Tree, WalkGraph
from giveway.walkways.polyline import usable_half_width
from giveway.walkways.reading import Survey


class Start(NamedTuple):
    """The route from a place to the end of a lane, with the gate across that end."""

    length: float  # [m] length
    connected: bool
    side: float  # [-1, 1] present side of the person, seen in walking direction
    gates: Callable[[float], Array]  # function of the person's side that returns the gates


class Starts:
    """Finds routes out of junctions.

    Args:
        survey: Contents of the network file.
        graph: Walkingareas and crossings of the network.
    """

    def __init__(self, survey: Survey, graph: WalkGraph) -> None:
        self._survey = survey
        self._graph = graph

    def into(self, place: str, position: Place, entry: End) -> Start:
        """Return the route from a place [m] inside a junction, or on an edge, to a lane's end."""
        graph = self._graph
        tree = graph.towards(entry)
        paved = True
        start = None
        if place in self._survey.crossings:
            start = self._off_crossing(place, position, tree)
        elif place in self._survey.walkingareas:
            start = self._out_of_area(place, position, tree)
        else:
            paved = bool(graph.portals_of(entry))
        if start is not None:
            return start
        straight = g.turned(graph.lane_end(entry))
        length = math.dist(position, straight[0, :2])
        return Start(length, not paved, g.side_at(straight, position), lambda _: straight)

    def _out_of_area(self, area: str, position: Place, tree: Tree) -> Start | None:
        """Return the route out of a walkingarea, through the portal that makes it shortest."""
        graph = self._graph
        exits = [
            (tree.leaving[i].distance + math.dist(position, graph.portal(i).gate[0, :2]), i)
            for i in graph.portals_in(area)
            if i in tree.leaving
        ]
        if not exits:
            return None
        length, i = min(exits)
        way_out = g.turned(graph.portal(i).gate)
        here = g.gate(position, way_out[0, 4:6])

        def gates(side: float) -> Array:
            between = graph.interior(area).between(here, way_out, side)
            return np.concatenate([between, graph.leave(i, tree, g.track_of(side))])

        return Start(length, True, g.side_at(way_out, position), gates)

    def _off_crossing(self, crossing: str, position: Place, tree: Tree) -> Start | None:
        """Return the route on from the middle of a crossing, without waiting for its light."""
        graph = self._graph
        line = graph.line(crossing)
        station, left = line.project(*position)
        exits = [
            (tree.coming[i].distance + (line.length - station if last else station), i, last)
            for last in (False, True)
            for i in graph.portals_of(End(crossing, last))
            if i in tree.coming
        ]
        if not exits:
            return None
        length, i, last = min(exits)
        half_width = usable_half_width(graph.lane(crossing).width)
        bends, stations = line.gates(half_width)[1:-1], np.array(line.stations[1:-1])
        ahead = bends[stations > station] if last else g.turned(bends[stations < station])

        def gates(side: float) -> Array:
            onwards = graph.follow(i, tree, g.track_of(side))
            return np.concatenate([ahead, graph.portal(i).gate, onwards])

        side = left / half_width if half_width > 0.0 else 0.0
        return Start(length, True, side if last else -side, gates)
