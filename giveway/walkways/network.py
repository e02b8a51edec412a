"""The walkable part of a SUMO network: lanes, routes and walls."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
import shapely

from giveway.walkways.area import sidewalk_area, walkable_area, walls
from giveway.walkways.gates import Array
from giveway.walkways.graph import WalkGraph
from giveway.walkways.reading import Signal, Survey, survey
from giveway.walkways.route import Router, WalkRoute


class NearestLane(NamedTuple):
    """The pedestrian lane nearest to a place."""

    edge: str
    lane: str
    position: float  # [m] place along the lane, in SUMO's metres
    distance: float  # [m] distance from the centre line


class WalkNetwork:
    """The places where people can walk in a SUMO network.

    Attributes:
        signals: Traffic-light links that govern crossings.
        gap_crossings: Edges of the crossings at which people wait for a gap. On routes, number k
            of them is the signal ``len(signals) + k``.
        has_walkingareas: True if the network has any.
        has_sidewalks: True if there is a lane that pedestrians may use and cars may not.
        boundary: Extent x_min, y_min, x_max, y_max [m] of the network.
    """

    signals: tuple[Signal, ...]
    gap_crossings: tuple[str, ...]
    has_walkingareas: bool
    has_sidewalks: bool
    boundary: tuple[float, float, float, float]

    def __init__(self, found: Survey) -> None:
        self._survey = found
        self._graph = WalkGraph(found)
        self._router = Router(found, self._graph)
        self.signals = tuple(self._graph.signals)
        self.gap_crossings = tuple(self._graph.gap_crossings)
        self.has_walkingareas = bool(found.walkingareas)
        self.has_sidewalks = found.has_sidewalks
        self.boundary = found.boundary or _extent(found)

    @classmethod
    def read(cls, net_file: Path) -> WalkNetwork:
        """Read a file ``.net.xml`` or ``.net.xml.gz``.

        Raises:
            ScenarioError: the file is unreadable or no SUMO network.
        """
        return cls(survey(net_file))

    def route(
        self,
        edges: Sequence[str],
        *,
        position: tuple[float, float],
        lane: str,
        arrival_position: float,
        offset_side: float | None = None,
    ) -> WalkRoute:
        """Return the route from where a person is to the end of the walk; it never fails.

        Args:
            edges: Remaining edges, the present one first. For a person in a walkingarea or on a
                crossing, the first is the edge that was left, as SUMO lists them.
            position: Place x, y [m] of the person.
            lane: Id of the present lane in SUMO, which may be a walkingarea's or a crossing's.
            arrival_position: End of the walk on the last edge, in SUMO's metres; a negative one
                counts from the edge's end.
            offset_side: Side of the walkway, from -1 (right end of its usable width) to 1 (left),
                that decides round which corners the person goes. With None it is the side on which
                the person is now.
        """
        return self._router.route(edges, position, lane, arrival_position, offset_side)

    @property
    def centre_lines(self) -> dict[str, Array]:
        """The centre lines (k, 2) [m] of the edges on which people walk, by SUMO's id."""
        return {edge: line.points for edge, line in self._graph.lines.items()}

    def nearest_lane(self, x: float, y: float) -> NearestLane | None:
        """Return the nearest lane outside of junctions on which SUMO lets people walk, or None."""
        edges, tree = self._index
        if not edges:
            return None
        edge = edges[int(tree.nearest(shapely.Point(x, y)))]
        lane, line = self._survey.edges[edge].lane, self._graph.lines[edge]
        station, _ = line.project(x, y)
        position = station / line.length * lane.length if line.length > 0.0 else 0.0
        distance = shapely.LineString(line.points).distance(shapely.Point(x, y))
        return NearestLane(edge, lane.id, position, float(distance))

    def nearest_place(self, x: float, y: float) -> tuple[float, float] | None:
        """Return x, y [m] of the nearest point on the centre line of a lane for people, or None."""
        edges, tree = self._index
        if not edges:
            return None
        line = tree.geometries[int(tree.nearest(shapely.Point(x, y)))]
        found = line.interpolate(line.project(shapely.Point(x, y)))
        return float(found.x), float(found.y)

    @cached_property
    def _index(self) -> tuple[list[str], shapely.STRtree]:
        lines = self._graph.lines
        shapes = [shapely.LineString(line.points) for line in lines.values()]
        return list(lines), shapely.STRtree(shapes)

    @cached_property
    def walkable(self) -> shapely.MultiPolygon:
        """The area where people may walk: lanes, walkingareas, crossings, other junctions."""
        return walkable_area(self._survey)

    def sidewalks(self, place: shapely.Geometry) -> shapely.MultiPolygon:
        """Return the sidewalks and walkingareas that reach into a place, without roads."""
        return sidewalk_area(self._survey, place)

    @cached_property
    def wall_segments(self) -> Array:
        """Return the edge of the walkable area as segments (k, 4) x0, y0, x1, y1 [m].

        The walkable side is on the left.
        """
        return walls(self.walkable)


def _extent(found: Survey) -> tuple[float, float, float, float]:
    """Return the extent [m] of the walkable area, for a file without its own extent."""
    shapes = [edge.lane.shape for edge in found.edges.values()]
    points = np.vstack([*shapes, *found.junctions.values()] or [np.zeros((1, 2))])
    (x_min, y_min), (x_max, y_max) = points.min(axis=0), points.max(axis=0)
    return float(x_min), float(y_min), float(x_max), float(y_max)
