"""Distance and contact times of the ego's rectangle and a pedestrian's circle, compiled.

Both are computed in the rectangle's frame: origin at its centre, X along the heading, Y to the
left. A circle of radius R touches the rectangle exactly when its centre lies in the rectangle grown
by R (the Minkowski sum: a rectangle with rounded corners), so that the circle becomes a point.
"""

from math import hypot, inf, sqrt

from giveway.geometry.kernel import inner

AT_REST = 1e-12
"""Relative speed [m/s] below which two bodies do not move relative to each other."""


@inner
def to_frame(x: float, y: float, cos: float, sin: float) -> tuple[float, float]:
    """Return a vector of the network in the frame of a vehicle with the heading (cos, sin)."""
    return x * cos + y * sin, y * cos - x * sin


@inner
def signed_distance(x: float, y: float, half_length: float, half_width: float) -> float:
    """Return the distance [m] of a point from the rectangle's edge, negative inside."""
    outside_x = abs(x) - half_length
    outside_y = abs(y) - half_width
    if outside_x > 0.0 and outside_y > 0.0:
        return hypot(outside_x, outside_y)
    return max(outside_x, outside_y)


@inner
def _slab(x: float, w: float, half: float) -> tuple[float, float]:
    """Return the times during which x + w t lies in [-half, half]; (inf, -inf) if never."""
    if w == 0.0:
        return (-inf, inf) if abs(x) <= half else (inf, -inf)
    one = (-half - x) / w
    other = (half - x) / w
    return min(one, other), max(one, other)


@inner
def _disc(x: float, y: float, w_x: float, w_y: float, radius: float) -> tuple[float, float]:
    """Return the times during which (x, y) + (w_x, w_y) t is in a disc about the origin."""
    speed_2 = w_x * w_x + w_y * w_y
    cross = x * w_y - y * w_x
    discriminant = speed_2 * radius * radius - cross * cross
    if discriminant < 0.0:
        return inf, -inf
    middle = -(x * w_x + y * w_y)
    root = sqrt(discriminant)
    return (middle - root) / speed_2, (middle + root) / speed_2


@inner
def contact_interval(
    x: float,
    y: float,
    w_x: float,
    w_y: float,
    half_length: float,
    half_width: float,
    radius: float,
) -> tuple[float, float]:
    """Return the first and last instant at which a moving circle touches the rectangle.

    The circle's centre is (x, y) + (w_x, w_y) t in the rectangle's frame. t may be any real number,
    so that both instants may be negative; they are (inf, -inf) if the two never touch.

    A line may enter the rectangle's bounding box, grown by ``radius``, through one of its four
    corner squares. Then it meets the rounded corner there or nothing, because a corner square's
    inner edges lie within the rounded rectangle. Therefore one slab test and at most two disc tests
    suffice.
    """
    if hypot(w_x, w_y) < AT_REST:
        touching = signed_distance(x, y, half_length, half_width) <= radius
        return (-inf, inf) if touching else (inf, -inf)
    in_x, out_x = _slab(x, w_x, half_length + radius)
    in_y, out_y = _slab(y, w_y, half_width + radius)
    first, last = max(in_x, in_y), min(out_x, out_y)
    if first > last:
        return inf, -inf

    at_x, at_y = x + w_x * first, y + w_y * first
    if abs(at_x) > half_length and abs(at_y) > half_width:
        corner_x = half_length if at_x > 0.0 else -half_length
        corner_y = half_width if at_y > 0.0 else -half_width
        first, _ = _disc(x - corner_x, y - corner_y, w_x, w_y, radius)
        if first == inf:
            return inf, -inf
    at_x, at_y = x + w_x * last, y + w_y * last
    if abs(at_x) > half_length and abs(at_y) > half_width:
        corner_x = half_length if at_x > 0.0 else -half_length
        corner_y = half_width if at_y > 0.0 else -half_width
        _, leaving = _disc(x - corner_x, y - corner_y, w_x, w_y, radius)
        # -inf here is due to rounding: the line has been inside already.
        last = max(leaving, first)
    return first, last
