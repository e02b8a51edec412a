"""Centre lines of walkways: stations, and gates across them."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from giveway.walkways.gates import BODY_RADIUS
from giveway.walkways.polyline import Polyline, usable_half_width

CORNER = Polyline.through(np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 8.0)]))


def test_a_body_keeps_its_radius_from_the_edge() -> None:
    assert usable_half_width(2.0) == pytest.approx(1.0 - BODY_RADIUS)
    assert usable_half_width(0.4) == 0.0


def test_nearly_straight_vertices_are_left_out() -> None:
    wavy = np.array([(0.0, 0.0), (3.0, 0.04), (6.0, -0.04), (10.0, 0.0), (10.0, 8.0)])
    line = Polyline.through(wavy)
    assert line.points.tolist() == CORNER.points.tolist()
    assert line.stations == pytest.approx([0.0, 10.0, 18.0])


@given(st.floats(-2.0, 14.0), st.floats(-4.0, 10.0))
def test_the_nearest_station_is_that_of_shapely(x: float, y: float) -> None:
    line = shapely.LineString(CORNER.points)
    point = shapely.Point(x, y)
    station, _ = CORNER.project(x, y)
    found = line.interpolate(station)
    assert found.distance(point) == pytest.approx(line.distance(point), abs=1e-9)


@pytest.mark.parametrize(("y", "left"), [(1.5, 1.5), (-1.5, -1.5)])
def test_left_of_the_line_is_positive(y: float, left: float) -> None:
    assert CORNER.project(4.0, y) == pytest.approx((4.0, left))


def test_the_gate_in_a_bend_lies_on_the_bisector_and_is_longer() -> None:
    gates = CORNER.gates(1.0)
    lengths = np.hypot(gates[:, 2], gates[:, 3])
    assert lengths == pytest.approx([1.0, np.sqrt(2.0), 1.0])
    assert gates[1, 2:4] == pytest.approx([-1.0, 1.0])
    assert gates[1, 4:6] == pytest.approx(np.sqrt([0.5, 0.5]))


def test_a_gate_lies_across_the_line_where_it_is_asked_for() -> None:
    (gate,) = CORNER.gate_at(13.0, 0.5)
    assert gate[:2] == pytest.approx([10.0, 3.0])
    assert gate[2:4] == pytest.approx([-0.5, 0.0])
    assert gate[4:6] == pytest.approx([0.0, 1.0])
