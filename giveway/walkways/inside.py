"""The shortest route inside a walkingarea, which need not be convex."""

import heapq
import math
from functools import cached_property

import numpy as np
import shapely
import shapely.ops
from numpy.typing import NDArray

from giveway.walkways.gates import BODY_RADIUS, NO_GATES, Array, places
from giveway.walkways.reading import PedLane

_TOLERANCE = 0.05  # Largest distance [m] of a route outside of the area
_SLIGHT = math.sin(math.radians(0.5))  # Sine of the angle below which a corner does not jut in
_INSET = 0.02  # Distance [m] by which routes pass inside a corner of the area


def polygon_of(area: PedLane) -> shapely.Polygon | shapely.MultiPolygon:
    """Return a walkingarea's outline as a valid polygon.

    An outline that crosses itself or is thinner than a body would fall into pieces, and gets room
    for a body along it. An outline without an area is widened to the width of its lane.
    """
    if not is_line(area):
        polygon = shapely.make_valid(shapely.Polygon(area.shape))
        outline = shapely.LinearRing(area.shape)
        if outline.is_simple and polygon.area > BODY_RADIUS * outline.length:
            return polygon
        room = outline.buffer(BODY_RADIUS, join_style="mitre")
        return shapely.union_all([polygon, room])
    line = shapely.Point(area.shape[0]) if len(area.shape) < 2 else shapely.LineString(area.shape)
    return line.buffer(area.width / 2)


def is_line(area: PedLane) -> bool:
    """Return whether a walkingarea's outline has no area, as at the dead end of a road."""
    if len(area.shape) < 3:
        return True
    return bool(shapely.make_valid(shapely.Polygon(area.shape)).area <= 0.01)


def rings(polygon: shapely.Polygon) -> list[Array]:
    """Return the closed rings (k, 2) [m] of a polygon, the inside on their left."""
    found = []
    for i, ring in enumerate((polygon.exterior, *polygon.interiors)):
        points = np.asarray(ring.coords)[:, :2]
        found.append(points if shapely.is_ccw(ring) == (i == 0) else points[::-1])
    return found


class Interior:
    """The inside of one walkingarea and its corners that jut in.

    Args:
        area: The walkingarea.
    """

    def __init__(self, area: PedLane) -> None:
        self.polygon = polygon_of(area)
        self._room = self.polygon.buffer(_TOLERANCE)
        shapely.prepare(self._room)
        self._corners, self._inwards = _corners(self.polygon)

    def gate_within(self, row: Array, depth: float) -> Array:
        """Return a gate (1, 7) on the area's edge moved ``depth`` [m] inwards, as wide as fits.

        In a shallow corner it is moved less.
        """
        widest = -1.0, row
        for share in (1.0, 0.5, 0.1):
            moved = row.copy()
            moved[0, :2] += share * depth * row[0, 4:6]
            fitted, room = self._fitted(moved)
            if room > 2 * BODY_RADIUS:
                return fitted
            widest = max(widest, (room, fitted), key=lambda pair: pair[0])
        return widest[1]

    def _fitted(self, row: Array) -> tuple[Array, float]:
        """Return a gate narrowed to where a body has room, and the room [m] there."""
        middle, direction = row[0, :2], row[0, 4:6]
        half = float(np.hypot(*row[0, 2:4])) + BODY_RADIUS
        left = np.array([-direction[1], direction[0]])
        across = shapely.LineString([middle - half * left, middle + half * left])
        piece = self._piece_near(middle, across)
        if piece.is_empty:
            return row, 0.0
        ends = np.einsum("ij,j", np.asarray(piece.coords)[:, :2] - middle, left)
        low, high = ends.min() + BODY_RADIUS, ends.max() - BODY_RADIUS
        fitted = row.copy()
        fitted[0, :2] += (low + high) / 2 * left
        fitted[0, 2:4] = max(0.0, high - low) / 2 * left
        return fitted, float(piece.length)

    def between(self, start: Array, end: Array, side: float) -> Array:
        """Return the gates (k, 7) of the route from one gate (1, 7) to another, without those two.

        Args:
            start: Gate from which people come.
            end: Gate to which they go.
            side: Side [-1, 1] of the people.
        """
        if not len(self._corners):
            return NO_GATES
        order = self._shortest(places(start, side)[0], places(end, side)[0])
        if not order:
            return NO_GATES
        width = 2 * BODY_RADIUS + 2 * max(np.hypot(*start[0, 2:4]), np.hypot(*end[0, 2:4]))
        return self._round(order, start[0, :2], end[0, :2], width)

    def _sees(self, a: Array, b: Array) -> bool:
        """Return whether the straight line between two points is inside."""
        return bool(self._room.covers(shapely.LineString([a, b])))

    def _inside(self, place: Array) -> Array:
        """Return the place, or the nearest one inside: SUMO's persons cut corners a little."""
        point = shapely.Point(place)
        if self._room.covers(point):
            return place
        nearest, _ = shapely.ops.nearest_points(self.polygon, point)
        return np.array(nearest.coords[0])

    def _round(self, order: list[int], start: Array, end: Array, width: float) -> Array:
        """Return gates from each corner inwards, at most ``width`` [m] wide."""
        stops = [start, *(self._corners[i] for i in order), end]
        gates = np.empty((len(order), 7))
        for j, corner in enumerate(order):
            vertex, inwards = self._corners[corner], self._inwards[corner]
            room = min(self._reach(vertex, inwards), width)
            half = max(0.0, room / 2 - BODY_RADIUS)
            onwards = stops[j + 2] - stops[j]
            left = 1.0 if onwards[0] * inwards[1] - onwards[1] * inwards[0] > 0.0 else -1.0
            spread = left * half * inwards
            direction = left * np.array([inwards[1], -inwards[0]])
            gates[j] = *(vertex + room / 2 * inwards), *spread, *direction, -1.0
        return gates

    def _reach(self, vertex: Array, inwards: Array) -> float:
        """Return the distance [m] from a corner straight inwards to the other side."""
        ray = shapely.LineString([vertex + 1e-3 * inwards, vertex + 100.0 * inwards])
        return float(self._piece_near(vertex, ray).length)

    def _piece_near(self, place: Array, line: shapely.LineString) -> shapely.Geometry:
        """Return the part of a line inside the area that is nearest to a place."""
        inside = self.polygon.intersection(line)
        start = shapely.Point(place)
        pieces = [piece for piece in getattr(inside, "geoms", [inside]) if piece.length > 0.0]
        return min(pieces, key=lambda piece: piece.distance(start), default=shapely.LineString())

    @cached_property
    def _visible(self) -> NDArray[np.bool_]:
        """Return a matrix (k, k) of flags: the straight line between two corners is inside."""
        near = self._near_corners
        k = len(near)
        ends = np.stack([np.repeat(near, k, axis=0), np.tile(near, (k, 1))], axis=1)
        seen = shapely.covers(self._room, shapely.linestrings(ends))
        return np.asarray(seen).reshape(k, k)

    @cached_property
    def _near_corners(self) -> Array:
        return self._corners + _INSET * self._inwards

    def _shortest(self, a: Array, b: Array) -> list[int]:
        """Return the corners round which the shortest route from a to b goes (visibility graph)."""
        a, b = self._inside(a), self._inside(b)
        if self._sees(a, b):
            return []
        near = self._near_corners
        k = len(near)
        seen_from = [
            np.asarray(
                shapely.covers(
                    self._room,
                    shapely.linestrings(np.stack([np.broadcast_to(p, near.shape), near], axis=1)),
                )
            )
            for p in (a, b)
        ]
        heap = [(float(np.hypot(*(near[i] - a))), int(i), -1) for i in np.flatnonzero(seen_from[0])]
        heapq.heapify(heap)
        came_from: dict[int, int] = {}
        while heap:
            distance, i, previous = heapq.heappop(heap)
            if i in came_from:
                continue
            came_from[i] = previous
            if i == k:
                break
            for j in np.flatnonzero(self._visible[i]):
                if j not in came_from:
                    onwards = distance + float(np.hypot(*(near[j] - near[i])))
                    heapq.heappush(heap, (onwards, int(j), i))
            if seen_from[1][i]:
                heapq.heappush(heap, (distance + float(np.hypot(*(b - near[i]))), k, i))
        route: list[int] = []
        i = came_from.get(k, -1)
        while i >= 0:
            route.append(i)
            i = came_from[i]
        return route[::-1]


def _corners(polygon: shapely.Polygon | shapely.MultiPolygon) -> tuple[Array, Array]:
    """Return the vertices (k, 2) that jut into a polygon, and their unit bisectors (k, 2)."""
    vertices: list[Array] = []
    inwards: list[Array] = []
    simple = polygon.simplify(_TOLERANCE)
    for part in getattr(simple, "geoms", [simple]):
        for points in rings(part):
            points = points[:-1]
            back = points - np.roll(points, 1, axis=0)
            forth = np.roll(points, -1, axis=0) - points
            back /= np.maximum(np.hypot(*back.T), 1e-12)[:, None]
            forth /= np.maximum(np.hypot(*forth.T), 1e-12)[:, None]
            turn = back[:, 0] * forth[:, 1] - back[:, 1] * forth[:, 0]
            jut = turn < -_SLIGHT
            along = (back + forth)[jut]
            size = np.hypot(*along.T)
            along = np.where(size[:, None] > 1e-6, along, back[jut])
            along /= np.maximum(np.hypot(*along.T), 1e-12)[:, None]
            vertices.append(points[jut])
            inwards.append(np.column_stack([-along[:, 1], along[:, 0]]))
    return np.vstack(vertices or [np.empty((0, 2))]), np.vstack(inwards or [np.empty((0, 2))])
