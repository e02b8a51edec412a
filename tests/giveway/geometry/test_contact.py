"""Contact of a rectangle and a circle, compared with the polygon grown by the radius."""

import math

import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from giveway.geometry.contact import contact_interval, signed_distance, to_frame
from giveway.geometry.kernel import kernel

contact_interval = kernel(contact_interval)
signed_distance = kernel(signed_distance)
to_frame = kernel(to_frame)
L, W, R = 2.5, 1.0, 0.27  # [m] half length, half width, radius
RECTANGLE = shapely.box(-L, -W, L, W)
near = st.floats(-6.0, 6.0)


@given(near, near)
def test_the_distance_is_that_to_the_outline(x: float, y: float) -> None:
    point = shapely.Point(x, y)
    inside = RECTANGLE.contains(point)
    expected = -RECTANGLE.exterior.distance(point) if inside else RECTANGLE.distance(point)
    assert signed_distance(x, y, L, W) == pytest.approx(expected, abs=1e-9)


@given(near, near, st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
def test_contact_begins_and_ends_at_the_radius(x: float, y: float, u: float, v: float) -> None:
    assume(math.hypot(u, v) > 0.1)
    first, last = contact_interval(x, y, u, v, L, W, R)
    if first == math.inf:
        line = shapely.LineString([(x - 99 * u, y - 99 * v), (x + 99 * u, y + 99 * v)])
        assert RECTANGLE.distance(line) >= R - 1e-6
    else:
        for t in (first, last):
            assert signed_distance(x + u * t, y + v * t, L, W) == pytest.approx(R, abs=1e-6)
        middle = 0.5 * (first + last)
        assert signed_distance(x + u * middle, y + v * middle, L, W) <= R + 1e-6


def test_at_rest_there_is_contact_for_ever_or_never() -> None:
    assert contact_interval(L + 0.2, 0.0, 0.0, 0.0, L, W, R) == (-math.inf, math.inf)
    assert contact_interval(L + 0.3, 0.0, 0.0, 0.0, L, W, R) == (math.inf, -math.inf)


@given(near, near, st.floats(-math.pi, math.pi))
def test_a_frame_keeps_lengths_and_its_own_axis(x: float, y: float, heading: float) -> None:
    c, s = math.cos(heading), math.sin(heading)
    assert math.hypot(*to_frame(x, y, c, s)) == pytest.approx(math.hypot(x, y))
    assert to_frame(c, s, c, s) == pytest.approx((1.0, 0.0))
