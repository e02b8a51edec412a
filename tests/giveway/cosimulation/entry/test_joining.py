"""Joining: a vehicle that is taken over beside its lane's centre line."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.cosimulation.entry.joining import join
from giveway.sumo.network.heights import Height
from giveway.sumo.network.lane_path import LanePath, Light, Passage, SpeedLimit
from giveway.sumo.vehicles import VehicleState

LANES = LanePath(
    points=np.column_stack([np.arange(0.0, 101.0, 5.0), np.zeros(21)]),
    lights=(Light(60.0, "J", 2),),
    first="ab_0",
    edges=(0.0, 65.0),
    limits=(SpeedLimit(0.0, 13.9), SpeedLimit(65.0, 8.3)),
    passages=(Passage(60.0, 65.0, (":J_0",), (62.0,)),),
    lanes=(("ab_0", "ab_0"), ("bc_0", "bc_0")),
    heights=(Height(0.0, 1.0), Height(65.0, 4.0)),
)


def vehicle(x: float, y: float) -> VehicleState:
    return VehicleState("car", "t", "passenger", ("ab", "bc"), 0, x, x, y, 0.0, 5.0, 5.0, 1.8, 50.0)


def test_on_the_line_nothing_changes() -> None:
    path, station, lanes = join(LANES, vehicle(22.0, 0.005))
    assert station == pytest.approx(22.0)
    assert path.length == pytest.approx(100.0)
    assert lanes is LANES


@given(st.floats(1.0, 30.0), st.floats(0.1, 3.5))
def test_beside_it_the_line_is_joined_within_20_m(x: float, aside: float) -> None:
    path, station, lanes = join(LANES, vehicle(x, aside))
    assert station == 0.0
    assert path.pose(0.0)[:2] == pytest.approx((x, aside))
    first = lanes.points[1]
    assert first[1] == 0.0
    assert 20.0 < first[0] - x <= 25.0
    assert path.length == pytest.approx(math.dist((x, aside), first) + 100.0 - first[0])


def test_what_lies_on_the_path_stays_where_it_was() -> None:
    path, _, lanes = join(LANES, vehicle(22.0, 3.2))
    for station, x in [
        (lanes.lights[0].station, 60.0),
        (lanes.edges[1], 65.0),
        (lanes.limits[1].station, 65.0),
        (lanes.passages[0].entry, 60.0),
        (lanes.passages[0].waiting[0], 62.0),
        (lanes.heights[1].station, 65.0),
    ]:
        assert path.pose(station)[:2] == pytest.approx((x, 0.0))
