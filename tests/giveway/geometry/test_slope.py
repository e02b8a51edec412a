"""How steep a path is under a body."""

from __future__ import annotations

import math

import pytest

from giveway.geometry.slope import Slope

HILL = [(0.0, 2.0), (10.0, 2.0), (10.0, 2.0), (30.0, 3.0), (50.0, 2.0)]


def test_a_level_path_has_none():
    assert Slope.through([]) is None
    assert Slope.through([(0.0, 7.0), (10.0, 7.0)]) is None


def test_the_grade_is_that_of_the_line_from_rear_to_front():
    slope = Slope.through(HILL)
    assert slope is not None
    assert slope.grade(8.0, 4.0) == 0.0
    assert slope.grade(20.0, 4.0) == pytest.approx(math.atan(0.05))
    assert slope.grade(12.0, 4.0) == pytest.approx(math.atan(0.025))
    assert slope.grade(32.0, 4.0) == pytest.approx(0.0)  # over the top
    assert slope.grade(45.0, 4.0) == pytest.approx(-math.atan(0.05))
    assert slope.steepest == pytest.approx(math.atan(0.05))


def test_what_stands_beyond_an_end_does_not_count():
    slope = Slope.through([(0.0, 0.0), (10.0, 1.0)])
    assert slope is not None
    assert slope.grade(2.0, 5.0) == pytest.approx(math.atan(0.1))
    assert slope.grade(12.0, 5.0) == pytest.approx(math.atan(0.1))
    assert slope.grade(20.0, 5.0) == 0.0
