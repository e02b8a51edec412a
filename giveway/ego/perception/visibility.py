"""The geometry of sight: which share of a body is seen past walls, vehicles and other people.

Bodies are upright cylinders, of which a sensor sees the width at their upper end. Walls are upright
and end at a height of their own. In the frame of one body, u is the distance from the sensor as a
share of the distance to the body, and w the offset to the left in radii of the body. The line of
sight to the upper end of the body at w = t is w = t u, at the height z + (top - z) u. A wall hides
what lies behind its part in the triangle 0 < u < 1, |w| <= u that is higher than this line. All of
these limits are linear in the plane, so that the part is found exactly by clipping the wall.
"""

from typing import NamedTuple

import numpy as np

from giveway.geometry.kernel import Array, inner, kernel

RADIUS = 0.27
"""Radius [m] of a body in the VCI model (TSAS 2020)."""

CHILD = 1.15
"""Height [m] of Euro NCAP's child target, a child of seven years."""

_OWN = 1e-6  # share of the distance within which something is not in front of the body
_NEXT_TO = 1e-9  # share of the distance within which something is at the sensor itself


class Eye(NamedTuple):
    """A sensor at one instant.

    Attributes:
        x: Coordinate [m].
        y: Coordinate [m].
        z: Height above the ground [m].
        heading: Direction of the middle of its field of view [rad].
        range: Largest distance [m] of the centres of bodies.
        half_angle: Half of its field of view [rad].
    """

    x: float
    y: float
    z: float
    heading: float
    range: float
    half_angle: float


@kernel
def fill_shares(
    eye: tuple[float, float, float, float, float, float],
    bodies: tuple[Array, Array, float],
    walls: Array,
    shares: Array,
) -> None:
    """Fill in the share (n,) of the width of each body that a sensor sees.

    It is 0 beyond the range and outside of the field of view.

    Args:
        eye: Members of an :class:`Eye`.
        bodies: Centres (n, 2) [m], heights (n,) [m], and the radius [m] of all.
        walls: Walls (k, 5): x0, y0, x1, y1, height [m].
        shares: Result; overwritten.
    """
    (x, y, z, heading, reach, half), (position, height, radius) = eye, bodies
    near = walls_within((x, y, reach), walls)
    hidden = np.empty((near.shape[0], 2))
    for i in range(position.shape[0]):
        d_x, d_y = position[i, 0] - x, position[i, 1] - y
        shares[i] = 0.0
        if d_x * d_x + d_y * d_y > reach * reach:
            continue
        turned = np.arctan2(d_y, d_x) - heading
        turned -= 2.0 * np.pi * np.round(turned / (2.0 * np.pi))
        if abs(turned) > half:
            continue
        shares[i] = _share((d_x, d_y, radius), (x, y, z), height[i], near, hidden)


@inner
def walls_within(circle: tuple[float, float, float], walls: Array) -> Array:
    """Return the walls that are not wholly beyond a circle: x, y and radius [m]."""
    x, y, radius = circle
    near = np.empty_like(walls)
    count = 0
    for k in range(walls.shape[0]):
        a_x, a_y = walls[k, 0] - x, walls[k, 1] - y
        b_x, b_y = walls[k, 2] - walls[k, 0], walls[k, 3] - walls[k, 1]
        size = b_x * b_x + b_y * b_y
        at = 0.0
        if size > 0.0:
            at = min(max(-(a_x * b_x + a_y * b_y) / size, 0.0), 1.0)
        n_x, n_y = a_x + at * b_x, a_y + at * b_y
        if n_x * n_x + n_y * n_y <= radius * radius:
            near[count] = walls[k]
            count += 1
    return near[:count]


@inner
def _share(
    body: tuple[float, float, float],
    eye: tuple[float, float, float],
    top: float,
    walls: Array,
    hidden: Array,
) -> float:
    """Return the share of a body's width that no wall hides.

    Args:
        body: Centre of the body relative to the sensor, x, y [m], and its radius [m].
        eye: Position x, y and height z [m] of the sensor.
        top: Height [m] of the body.
        walls: Walls (k, 5).
        hidden: Scratch (k, 2).
    """
    (d_x, d_y, radius), (x, y, z) = body, eye
    square = d_x * d_x + d_y * d_y
    if square <= radius * radius:
        return 1.0
    across = 1.0 / (radius * np.sqrt(square))
    count = 0
    for k in range(walls.shape[0]):
        a_x, a_y, b_x, b_y = walls[k, 0] - x, walls[k, 1] - y, walls[k, 2] - x, walls[k, 3] - y
        u_a, u_b = (a_x * d_x + a_y * d_y) / square, (b_x * d_x + b_y * d_y) / square
        w_a, w_b = (a_y * d_x - a_x * d_y) * across, (b_y * d_x - b_x * d_y) * across
        above, rises = walls[k, 4] - z, top - z
        begin, end = _clipped(u_a - _NEXT_TO, u_b - _NEXT_TO, 0.0, 1.0)
        begin, end = _clipped(1.0 - _OWN - u_a, 1.0 - _OWN - u_b, begin, end)
        begin, end = _clipped(u_a - w_a, u_b - w_b, begin, end)
        begin, end = _clipped(u_a + w_a, u_b + w_b, begin, end)
        begin, end = _clipped(above - rises * u_a, above - rises * u_b, begin, end)
        if begin >= end:
            continue
        first = (w_a + begin * (w_b - w_a)) / (u_a + begin * (u_b - u_a))
        last = (w_a + end * (w_b - w_a)) / (u_a + end * (u_b - u_a))
        hidden[count, 0], hidden[count, 1] = min(first, last), max(first, last)
        count += 1
    return max(0.0, 1.0 - 0.5 * _covered(hidden, count))


@inner
def _clipped(value_a: float, value_b: float, begin: float, end: float) -> tuple[float, float]:
    """Clip the part from ``begin`` to ``end`` of a line where a linear value is not below 0.

    The value is ``value_a`` at 0 and ``value_b`` at 1. Nothing is left if end < begin.
    """
    if value_a < 0.0 and value_b < 0.0:
        return 1.0, 0.0
    if value_a < 0.0:
        begin = max(begin, value_a / (value_a - value_b))
    elif value_b < 0.0:
        end = min(end, value_a / (value_a - value_b))
    return begin, end


@inner
def _covered(intervals: Array, count: int) -> float:
    """Return the length that ``count`` intervals cover together; they are sorted."""
    for i in range(1, count):
        low, high = intervals[i, 0], intervals[i, 1]
        j = i - 1
        while j >= 0 and intervals[j, 0] > low:
            intervals[j + 1, 0], intervals[j + 1, 1] = intervals[j, 0], intervals[j, 1]
            j -= 1
        intervals[j + 1, 0], intervals[j + 1, 1] = low, high
    covered, until = 0.0, -1.0
    for i in range(count):
        low, high = max(intervals[i, 0], until), intervals[i, 1]
        if high > low:
            covered, until = covered + high - low, high
    return covered


@kernel
def sides_of(bodies: Array, heights: Array, but: int) -> Array:
    """Return the sides (4 (m - 1), 5) of vehicles as walls.

    Args:
        bodies: Poses (m, 7), as in :class:`~giveway.ego.perception.truth.Truth`.
        heights: Heights (m,) [m].
        but: Row that is left out.
    """
    sides = np.empty((4 * bodies.shape[0], 5))
    count = 0
    for row in range(bodies.shape[0]):
        if row == but:
            continue
        x, y, cos, sin = (
            bodies[row, 0],
            bodies[row, 1],
            np.cos(bodies[row, 2]),
            np.sin(bodies[row, 2]),
        )
        front, rear, half = bodies[row, 4], -bodies[row, 5], 0.5 * bodies[row, 6]
        for side in range(4):
            along = front if side in (0, 3) else rear
            aside = half if side < 2 else -half
            onwards = front if side in (2, 3) else rear
            across = half if side in (0, 3) else -half
            sides[count, 0], sides[count, 1] = (
                x + along * cos - aside * sin,
                y + along * sin + aside * cos,
            )
            sides[count, 2] = x + onwards * cos - across * sin
            sides[count, 3] = y + onwards * sin + across * cos
            sides[count, 4] = heights[row]
            count += 1
    return sides[:count]


def chords_of(position: Array, heights: Array, eye: Eye, radius: float) -> Array:
    """Return the people (n, 2) as walls across the lines of sight from a sensor.

    Args:
        position: Centres (n, 2) [m].
        heights: Heights (n,) [m].
        eye: The sensor.
        radius: Radius [m] of each body.
    """
    d = position - (eye.x, eye.y)
    far = np.maximum(np.hypot(d[:, 0], d[:, 1]), radius)
    half = radius * np.column_stack([-d[:, 1], d[:, 0]]) / far[:, None]
    return np.column_stack([position - half, position + half, heights])
