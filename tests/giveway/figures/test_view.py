"""The rectangle of the plane that a picture shows."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.figures.view import SLENDEREST, Box

POINTS = np.array([(0.0, 1.0), (10.0, -3.0), (4.0, 6.0)])


def test_it_holds_the_points_and_the_margin() -> None:
    box = Box.around(POINTS, 2.0)
    assert box == (-2.0, -5.0, 12.0, 8.0)
    assert box.size == (14.0, 13.0)
    assert box.aspect == pytest.approx(13 / 14)


def test_round_a_centre_it_has_the_size_asked_for() -> None:
    assert Box.centred(np.array([1.0, 2.0]), (4.0, 6.0)) == (-1.0, -1.0, 3.0, 5.0)


@given(st.floats(0.1, 500.0), st.floats(0.1, 500.0))
def test_widened_it_is_not_too_slender_and_holds_what_it_held(width: float, height: float) -> None:
    box = Box(0.0, 0.0, width, height)
    wide = box.less_slender()
    assert 1.0 / (2.0 * SLENDEREST) - 1e-9 <= wide.aspect <= SLENDEREST + 1e-9
    assert wide.left <= box.left
    assert wide.top >= box.top
    assert wide.less_slender() == pytest.approx(wide)


def test_it_touches_what_reaches_into_it() -> None:
    box = Box(0.0, 0.0, 5.0, 5.0)
    assert box.touches(POINTS)
    assert not box.touches(POINTS + [20.0, 0.0])
    assert not box.touches(POINTS + [0.0, 20.0])
