"""The turning tests: the path of the car, and where its front meets the dummy.

The path is a clothoid, an arc and a clothoid back, as in the protocol. The middle of the front
follows it, and the middle of the rear does, as of all of giveway's vehicles.
"""

from math import cos, radians, sin

import numpy as np

from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.ncap.protocol import Dummy, Turn

BEGIN = 560.0
"""Station [m] at which the turn begins. The road before it lies on y = 0."""
_AFTER = 150.0  # Length [m] of the road behind the turn
_FINE = 0.1  # Distance [m] between points of the path in the turn
_ALMOST_STRAIGHT = 1500.0  # Radius [m] at the outer end of a clothoid


def path_of(turn: Turn, speed: int) -> EgoPath:
    """Return the path of the car at a speed [km/h] of the test."""
    (bend,) = (one for one in turn.bends if one.speed == speed)
    low, high = 1.0 / _ALMOST_STRAIGHT, 1.0 / bend.radius
    clothoid, arc = 2.0 * radians(bend.clothoid) / (low + high), radians(bend.arc) * bend.radius
    stations = np.linspace(0.0, 2.0 * clothoid + arc, round((2.0 * clothoid + arc) / _FINE) + 1)
    ends = np.array([0.0, clothoid, clothoid + arc, 2.0 * clothoid + arc])
    middle = (stations[1:] + stations[:-1]) / 2.0
    curvature = np.interp(middle, ends, [low, high, high, low])
    turned = np.cumsum(curvature * np.diff(stations))
    heading = turned - curvature * np.diff(stations) / 2.0
    way = 1.0 if turn.side == "left" else -1.0
    steps = np.diff(stations)[:, None] * np.column_stack([np.cos(heading), way * np.sin(heading)])
    points = np.concatenate([[[0.0, 0.0], [BEGIN, 0.0]], [BEGIN, 0.0] + np.cumsum(steps, axis=0)])
    last = np.array([cos(turned[-1]), way * sin(turned[-1])])
    return EgoPath.through(np.concatenate([points, [points[-1] + _AFTER * last]]))


def meeting(
    turn: Turn, path: EgoPath, dummy: Dummy, direction: float, length: float
) -> tuple[float, float, float]:
    """Return where the middle of the front reaches the dummy, which walks along x.

    Args:
        turn: Turn of the test.
        path: Path of the car.
        dummy: Dummy.
        direction: 1 if it walks along +x, -1 against it.
        length: Length [m] of the car.

    Returns:
        Station [m] of the front; x [m] of the middle of the dummy's box then; x [m] of the place
        at which the path crosses the dummy's line.
    """
    line = turn.line
    near, far = BEGIN, path.length - _AFTER / 2.0
    while far - near > 1e-9:
        station = (near + far) / 2.0
        point = _reference(path, dummy, direction, length, station)
        near, far = (near, station) if point[1] / line > 1.0 else (station, far)
    middle = point[0] + direction * dummy.reference
    crossed = np.interp(line, *_ordered(path.vertices[1:, 1], path.vertices[1:, 0]))
    return station, float(middle), float(crossed)


def _reference(
    path: EgoPath, dummy: Dummy, direction: float, length: float, station: float
) -> Array:
    """Return the place (2,) [m] of the point that is hit, if the front is at its box now."""
    pose = path.pose(station, length)
    c, s = cos(pose.heading), sin(pose.heading)
    box = (dummy.length * abs(c) + dummy.width * abs(s)) / 2.0
    ahead = box - dummy.reference * direction * c
    return np.array([pose.x + ahead * c, pose.y + ahead * s])


def _ordered(keys: Array, values: Array) -> tuple[Array, Array]:
    order = np.argsort(keys)
    return keys[order], values[order]
