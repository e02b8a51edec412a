"""The overlap of vehicles' rectangles, compared with shapely's."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from giveway.geometry.overlap import rectangles_overlap

CAR = np.array([0.0, 0.0, 0.0, 5.0, 2.0])
places = st.tuples(
    st.floats(-8.0, 8.0), st.floats(-8.0, 8.0), st.floats(-math.pi, math.pi),
    st.floats(1.0, 12.0), st.floats(0.5, 3.0),
)  # fmt: skip


def outline(x: float, y: float, heading: float, length: float, width: float) -> shapely.Polygon:
    c, s = math.cos(heading), math.sin(heading)
    corners = [(0.0, 0.5), (0.0, -0.5), (-length, -0.5), (-length, 0.5)]
    return shapely.Polygon(
        [(x + a * c - b * width * s, y + a * s + b * width * c) for a, b in corners]
    )


@given(places)
def test_it_is_that_of_the_polygons(other: tuple[float, ...]) -> None:
    one, two = outline(*CAR), outline(*other)
    depth = one.intersection(two).area
    assume(depth == 0.0 or depth > 0.2)  # rectangles that just touch are a matter of rounding
    assume(depth > 0.0 or one.distance(two) > 0.01)
    assert bool(rectangles_overlap(CAR, np.array(other), 0.0)) == (depth > 0.0)


@pytest.mark.parametrize(("gap", "overlaps"), [(0.1, False), (-0.005, False), (-0.02, True)])
def test_a_centimetre_is_a_touch_only(gap: float, overlaps: bool) -> None:
    behind = CAR - [5.0 + gap, 0.0, 0.0, 0.0, 0.0]
    assert bool(rectangles_overlap(CAR, behind)) == overlaps


def test_pairs_are_broadcast() -> None:
    others = np.array([CAR, CAR + [0.0, 4.0, 0.0, 0.0, 0.0]])
    assert rectangles_overlap(CAR, others).tolist() == [True, False]
