"""The ego's path: a polyline along which its FMU's one-dimensional motion is laid out.

A *station* is the arc length [m] along the polyline. The ego's station is that of the centre of its
front bumper, which is also SUMO's reference point of a vehicle. Beyond its ends the path goes on
straight. A *heading* is in radians, counter-clockwise from +x; SUMO's navigational *angle* is in
degrees, clockwise from north.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from giveway.errors import ScenarioError
from giveway.geometry.kernel import Array, inner, kernel


class Pose(NamedTuple):
    """A place and a direction in the network's frame."""

    x: float  # [m]
    y: float  # [m]
    heading: float  # [rad] counter-clockwise from +x


_SEARCH = 20.0  # Largest difference [m] between SUMO's position along a lane and the polyline's


@dataclass(frozen=True)
class EgoPath:
    """A polyline with its stations and headings.

    Attributes:
        vertices: Vertices (k + 1, 2) [m].
        stations: Arc length (k + 1,) [m] at each vertex, from 0.
        headings: Headings (k,) [rad] of each segment.
    """

    vertices: Array
    stations: Array
    headings: Array

    @classmethod
    def through(cls, points: ArrayLike) -> EgoPath:
        """Return the path through ``points`` (k, 2) [m], without repeated points.

        Raises:
            ScenarioError: there are fewer than two distinct finite points.
        """
        vertices = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        if len(vertices):
            moved = np.hypot(*np.diff(vertices, axis=0).T) > 1e-9
            vertices = np.ascontiguousarray(vertices[np.concatenate([[True], moved])])
        if len(vertices) < 2 or not np.isfinite(vertices).all():
            raise ScenarioError(
                f"ego path: {len(vertices)} distinct points; expected at least two finite ones"
            )
        steps = np.diff(vertices, axis=0)
        return cls(vertices, stations_of(vertices), directions(steps))

    @property
    def length(self) -> float:
        """The arc length [m]."""
        return float(self.stations[-1])

    def points(self, stations: Array) -> Array:
        """Return the points (n, 2) [m] at ``stations`` (n,) [m]; beyond an end, the end."""
        return points_at(self.vertices, self.stations, stations)

    def pose(self, station: float, length: float = 0.0) -> Pose:
        """Return the pose of a body whose front and rear both have their middle on the path.

        Args:
            station: Station of the front's middle [m].
            length: Length of the body [m]; 0 gives the path's own direction.
        """
        return Pose(*body_pose(self.vertices, self.stations, self.headings, station, length))

    def locate(self, x: float, y: float, *, near: float) -> tuple[float, float]:
        """Return station [m] and lateral offset [m] of (x, y), near the station ``near``."""
        first = segment_at(self.stations, near - _SEARCH)
        part = slice(first, segment_at(self.stations, near + _SEARCH) + 2)
        station, lateral = project(self.vertices[part], self.stations[part], x, y)
        return station, lateral

    def project(self, points: ArrayLike) -> tuple[Array, Array]:
        """Return stations (n,) and lateral offsets (n,) [m, left positive] of ``points``."""
        points = np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 2)
        frenet = np.empty((2, len(points)))
        project_all(self.vertices, self.stations, points, frenet)
        return frenet[0], frenet[1]


def stations_of(vertices: Array) -> Array:
    """Return arc lengths (k,) [m] from a polyline's beginning to its ``vertices`` (k, 2) [m]."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(vertices, axis=0).T))])


def points_at(vertices: Array, stations: Array, at: Array) -> Array:
    """Return the points (..., 2) [m] of a polyline at the arc lengths ``at`` (...) [m].

    Args:
        vertices: Points (k, 2) [m] of the polyline.
        stations: Stations (k,) [m] of its vertices.
        at: Arc lengths [m]; beyond an end, the end is taken.
    """
    return np.stack([np.interp(at, stations, column) for column in vertices.T], axis=-1)


def fine_near(near: Array, reach: float, begin: float, end: float, step: float) -> Array:
    """Return stations [m] from ``begin`` by ``step`` within ``reach`` of any of ``near``.

    The last one is before ``end``. If a long path passes a place twice, the part in between is left
    out.

    Args:
        near: Stations (n,) [m] in rising order, at least one.
        reach: Distance [m] from them.
        begin: First station [m]; all others are whole steps away.
        end: Station [m] before which they end.
        step: Distance [m] between two of them.
    """
    stations = np.arange(begin, min(near[-1] + reach, end), step)
    after = np.minimum(np.searchsorted(near, stations), len(near) - 1)
    off = np.minimum(abs(stations - near[after - 1]), abs(stations - near[after]))
    close: Array = stations[off <= reach]
    return close


@kernel
def segment_at(stations: Array, station: float) -> int:
    """Return the index of the segment at ``station`` [m], the first or last beyond the ends."""
    i: int = np.searchsorted(stations, station, side="right") - 1  # type: ignore[assignment]
    return min(max(i, 0), len(stations) - 2)


@inner
def point_on(vertices: Array, stations: Array, i: int, station: float) -> tuple[float, float]:
    """Return x, y [m] at ``station`` [m] on the line through segment i."""
    along = station - stations[i]
    length = stations[i + 1] - stations[i]
    x = vertices[i, 0] + along * ((vertices[i + 1, 0] - vertices[i, 0]) / length)
    y = vertices[i, 1] + along * ((vertices[i + 1, 1] - vertices[i, 1]) / length)
    return x, y


@kernel
def body_pose(
    vertices: Array, stations: Array, headings: Array, station: float, length: float
) -> tuple[float, float, float]:
    """Return x, y [m] of the front's middle and the heading [rad] of a body.

    The path goes on straight beyond its ends. The heading is that of the line from rear to front,
    as SUMO draws vehicles.
    """
    i = segment_at(stations, station)
    x, y = point_on(vertices, stations, i, station)
    j = segment_at(stations, station - length)
    if i == j:
        return x, y, headings[i]
    x_r, y_r = point_on(vertices, stations, j, station - length)
    if (x - x_r) ** 2 + (y - y_r) ** 2 < 1e-12:  # the path returns to where it was
        return x, y, headings[i]
    return x, y, np.arctan2(y - y_r, x - x_r)


@kernel
def project(vertices: Array, stations: Array, x: float, y: float) -> tuple[float, float]:
    """Return station and signed lateral offset [m] of the path's point nearest to (x, y)."""
    best_distance = np.inf
    best_station = 0.0
    best_lateral = 0.0
    last = len(vertices) - 2
    for i in range(last + 1):
        x_0, y_0 = vertices[i, 0], vertices[i, 1]
        length = stations[i + 1] - stations[i]
        e_x, e_y = (vertices[i + 1, 0] - x_0) / length, (vertices[i + 1, 1] - y_0) / length
        along = (x - x_0) * e_x + (y - y_0) * e_y
        if along < 0.0 and i > 0:  # the first and the last segment continue without end
            along = 0.0
        if along > length and i < last:
            along = length
        d_x, d_y = x - (x_0 + along * e_x), y - (y_0 + along * e_y)
        distance = d_x * d_x + d_y * d_y
        if distance < best_distance:
            best_distance = distance
            best_station = stations[i] + along
            best_lateral = np.sqrt(distance)
            if e_x * d_y - e_y * d_x < 0.0:
                best_lateral = -best_lateral
    return best_station, best_lateral


@kernel
def project_all(vertices: Array, stations: Array, points: Array, frenet: Array) -> None:
    """Fill ``frenet`` (2, n) with stations and signed lateral offsets [m] of ``points`` (n, 2)."""
    for i in range(len(points)):
        frenet[0, i], frenet[1, i] = project(vertices, stations, points[i, 0], points[i, 1])


def directions(vectors: Array) -> Array:
    """Return the headings (n,) [rad] of ``vectors`` (n, 2), the same on every processor.

    They come from the C library: numpy's arctan2 has other last digits where AVX-512 is missing.
    """
    return np.fromiter(map(math.atan2, vectors[:, 1], vectors[:, 0]), float, len(vectors))


def heading_to_angle(heading: float) -> float:
    """Return the navigational angle [deg] of a heading [rad]."""
    return (90.0 - math.degrees(heading)) % 360.0


def angle_to_heading(angle: float) -> float:
    """Return the heading [rad] of a navigational angle [deg]."""
    return math.radians(90.0 - angle)


def angles_to_headings(angles: Array) -> Array:
    """Return the headings (n,) [rad] of navigational angles (n,) [deg]."""
    headings: Array = np.radians(90.0 - angles)
    return headings


def headings_to_angles(headings: Array) -> Array:
    """Return the navigational angles (n,) [deg] of headings (n,) [rad], rounded as in tables."""
    return np.mod(np.round(90.0 - np.degrees(headings), 6), 360.0)


@inner
def angle_of_velocity(v_x: float, v_y: float) -> float:
    """Return the navigational angle [deg] of a velocity's direction."""
    return float((90.0 - np.degrees(np.arctan2(v_y, v_x))) % 360.0)
