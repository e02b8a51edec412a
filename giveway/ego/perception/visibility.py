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
from numpy.typing import NDArray

from controller.driving_constants import STANDING
from giveway.geometry.kernel import Array, inner, kernel

RADIUS = 0.27
"""Radius [m] of a body in the VCI model (TSAS 2020)."""

CHILD = 1.15
"""Height [m] of Euro NCAP's child target, a child of seven years."""

_ENOUGH = 0.5 - 1e-9  # share of a body's width from which on it is seen
_OWN = 1e-6  # share of the distance within which something is not in front of the body
_ROUNDING = 1e-12  # of cosines of angles
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
def eyes_of(mounts: Array, x: float, y: float, heading: float) -> Array:
    """Return the sensors (e, 6) where they are now.

    Args:
        mounts: Members of each :class:`Eye` in the frame of the ego.
        x: Coordinate [m] of the ego.
        y: Coordinate [m] of the ego.
        heading: Its heading [rad].
    """
    cos, sin, eyes = np.cos(heading), np.sin(heading), mounts.copy()
    eyes[:, 0] = x + mounts[:, 0] * cos - mounts[:, 1] * sin
    eyes[:, 1] = y + mounts[:, 0] * sin + mounts[:, 1] * cos
    eyes[:, 3] += heading
    return eyes


@kernel
def fill_shares(
    eyes: Array,
    bodies: tuple[Array, Array, float],
    walls: Array,
    enough: float,
    shares: Array,
) -> None:
    """Fill in the share (n,) of the width of each body that the sensor sees that sees most of it.

    It is 0 beyond the range and outside of the field of view.

    Args:
        eyes: Sensors (e, 6), the members of each :class:`Eye`.
        bodies: Centres (n, 2) [m], heights (n,) [m], and the radius [m] of all.
        walls: Walls (k, 5): x0, y0, x1, y1, height [m].
        enough: Share from which on no further sensor looks at a body.
        shares: Result; overwritten.
    """
    shares[:] = 0.0
    near, hidden = np.empty_like(walls), np.empty((walls.shape[0], 2))
    position, height, radius = bodies
    for e in range(eyes.shape[0]):
        x, y, z, heading, reach, half = eyes[e]
        to_x, to_y, least = np.cos(heading), np.sin(heading), np.cos(half) - _ROUNDING
        count = _walls_within((x, y, z, reach), walls, near)
        for i in range(position.shape[0]):
            d_x, d_y = position[i, 0] - x, position[i, 1] - y
            square = d_x * d_x + d_y * d_y
            if shares[i] >= enough or square > reach * reach:
                continue
            if half < np.pi and d_x * to_x + d_y * to_y < least * np.sqrt(square):
                continue
            share = _share((d_x, d_y, radius), height[i] - z, near[:count], hidden)
            shares[i] = max(shares[i], share)


def in_sight(eyes: Array, walls: Array, points: Array, heights: Array) -> NDArray[np.bool_]:
    """Return which bodies (k,) are in sight of a sensor: at least half of their width is.

    Args:
        eyes: Sensors (e, 6).
        walls: Walls (m, 5).
        points: Centres (k, 2) [m].
        heights: Heights (k,) [m].
    """
    shares = np.empty(len(points))
    fill_shares(eyes, (points, heights, RADIUS), walls, _ENOUGH, shares)
    return shares >= _ENOUGH


@inner
def _walls_within(eye: tuple[float, float, float, float], walls: Array, near: Array) -> int:
    """Fill in the walls, as seen from a sensor, that are not wholly beyond its range."""
    x, y, z, reach = eye
    count = 0
    for k in range(walls.shape[0]):
        a_x, a_y = walls[k, 0] - x, walls[k, 1] - y
        b_x, b_y = walls[k, 2] - walls[k, 0], walls[k, 3] - walls[k, 1]
        size = b_x * b_x + b_y * b_y
        at = 0.0
        if size > 0.0:
            at = min(max(-(a_x * b_x + a_y * b_y) / size, 0.0), 1.0)
        n_x, n_y = a_x + at * b_x, a_y + at * b_y
        if n_x * n_x + n_y * n_y <= reach * reach:
            near[count, 0], near[count, 1] = a_x, a_y
            near[count, 2], near[count, 3] = walls[k, 2] - x, walls[k, 3] - y
            near[count, 4] = walls[k, 4] - z
            count += 1
    return count


@inner
def _share(body: tuple[float, float, float], rises: float, walls: Array, hidden: Array) -> float:
    """Return the share of a body's width that no wall hides.

    Args:
        body: Centre of the body relative to the sensor, x, y [m], and its radius [m].
        rises: Height [m] of the body above the sensor.
        walls: Walls (k, 5), relative to the sensor.
        hidden: Scratch (k, 2).
    """
    d_x, d_y, radius = body
    square = d_x * d_x + d_y * d_y
    if square <= radius * radius:
        return 1.0
    distance = np.sqrt(square)
    across, slope = 1.0 / (radius * distance), distance / radius
    count = 0
    for k in range(walls.shape[0]):
        a_x, a_y, b_x, b_y = walls[k, 0], walls[k, 1], walls[k, 2], walls[k, 3]
        along_a, along_b = a_x * d_x + a_y * d_y, b_x * d_x + b_y * d_y
        if max(along_a, along_b) <= 0.0 or min(along_a, along_b) >= square:
            continue
        aside_a, aside_b = a_y * d_x - a_x * d_y, b_y * d_x - b_x * d_y
        if min(aside_a * slope - along_a, aside_b * slope - along_b) > 0.0:
            continue  # to the left of the body
        if max(aside_a * slope + along_a, aside_b * slope + along_b) < 0.0:
            continue
        u_a, u_b, w_a, w_b = along_a / square, along_b / square, aside_a * across, aside_b * across
        above = walls[k, 4]
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
def walls_of(outlines: Array, bodies: Array, heights: Array, but: int) -> tuple[Array, int]:
    """Return what hides people: outlines, the sides of vehicles at rest, and those of others.

    Args:
        outlines: Walls (k, 5).
        bodies: Poses (m, 7), as in :class:`~giveway.ego.perception.truth.Truth`.
        heights: Heights (m,) [m].
        but: Row that is left out.

    Returns:
        Walls (k + 4 (m - 1), 5), and the number of those that stand.
    """
    walls = np.empty((outlines.shape[0] + 4 * bodies.shape[0], 5))
    count = standing = outlines.shape[0]
    walls[:count] = outlines
    for moving in (False, True):
        standing = count
        for row in range(bodies.shape[0]):
            if row != but and (bodies[row, 3] >= STANDING) == moving:
                count = _add_sides(bodies[row], heights[row], walls, count)
    return walls[:count], standing


@inner
def _add_sides(body: Array, height: float, walls: Array, count: int) -> int:
    x, y, cos, sin = body[0], body[1], np.cos(body[2]), np.sin(body[2])
    front, rear, half = body[4], -body[5], 0.5 * body[6]
    for side in range(4):
        along = front if side in (0, 3) else rear
        aside = half if side < 2 else -half
        onwards = front if side in (2, 3) else rear
        across = half if side in (0, 3) else -half
        walls[count, 0] = x + along * cos - aside * sin
        walls[count, 1] = y + along * sin + aside * cos
        walls[count, 2] = x + onwards * cos - across * sin
        walls[count, 3] = y + onwards * sin + across * cos
        walls[count, 4] = height
        count += 1
    return count


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
