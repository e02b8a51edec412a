"""People who wait for a gap are not pushed onto the roadway, by any model."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from giveway.crowd.motion.at_kerb import HeldAtKerb
from pedestrian_model import (
    PLAIN_MODELS,
    SIM,
    Crowd,
    CrowdModel,
    PlainModel,
    Surroundings,
    Vehicles,
)

STEP = 0.05
SIDEWALK = shapely.box(-5.0, -2.0, 5.0, 0.0)


def models() -> list:
    return [CrowdModel(SIM, STEP), *(PlainModel(name, SIM, STEP) for name in PLAIN_MODELS)]


@pytest.mark.parametrize("model", models(), ids=["vci", *PLAIN_MODELS])
@pytest.mark.parametrize("waits", [True, False])
def test_who_waits_stays_on_the_sidewalk(model, waits: bool) -> None:
    crowd = Crowd.create(
        [(0.0, -0.1), (0.0, 1.0)],
        [(0.0, 1.2), (0.0, -1.0)],
        1.2,
        [[(0.0, 0.2), (0.0, 9.0)]] * 2,
        signals=[[1, -1]] * 2,
    )
    surroundings = Surroundings(closed=np.array([False, waits]))
    held = HeldAtKerb(model, 1, 1, SIDEWALK)
    assert held.time_step == STEP
    for _ in range(6):
        held.advance(crowd, Vehicles.empty(), surroundings)
    assert bool(crowd.position[0, 1] <= 0.0) is waits
    if waits:  # who stands on the roadway may walk, so as to come back
        assert crowd.position[1, 1] < 1.0


def test_who_has_come_to_the_kerb_is_not_pushed_to_and_fro() -> None:
    moved = []
    for held in (True, False):
        crowd = Crowd.create(
            [(0.0, -0.3), (0.4, -0.3)],
            [(0.0, 0.0)] * 2,
            1.2,
            [[(0.0, -0.3), (0.0, 9.0)], [(0.4, -0.3), (0.4, 9.0)]],
            signals=[[0, -1]] * 2,
        )
        model = CrowdModel(SIM, STEP)
        model = HeldAtKerb(model, 0, 1, SIDEWALK) if held else model
        model.advance(crowd, Vehicles.empty(), Surroundings(closed=np.array([True])))
        moved.append(abs(crowd.position[0, 0]))
    assert 0.0 < moved[0] < 0.5 * moved[1]


@pytest.mark.parametrize("near", [True, False])
def test_who_does_not_cross_steps_back_from_where_cars_turn(near: bool) -> None:
    """The first waits, the second walks along, the third crosses, the fourth comes from there."""
    swept = shapely.box(-5.0, -0.5, 5.0, 0.0)
    crowd = Crowd.create(
        [(-2.0, -0.4), (0.0, -0.4), (2.0, -0.4), (4.0, -0.4)],
        [(0.0, 0.0)] * 4,
        1.2,
        [[(-2.0, -0.2), (-2.0, 9.0)], [(0.0, -0.2)], [(2.0, -0.4), (2.0, 9.0)], [(4.0, -3.0)]],
        signals=[[0, -1], [-1], [1, -1], [-1]],
    )
    car = Vehicles.create(0.0, 6.0 if near else 90.0, 0.0, 4.0)
    held = HeldAtKerb(PlainModel("social-force", SIM, STEP), 0, 1, SIDEWALK, swept)
    assert held.free.bounds == (-5.0, -2.0, 5.0, -0.5)
    for _ in range(8):
        held.advance(crowd, car, Surroundings(closed=np.array([True, False])))
    y = crowd.position[:, 1]
    assert bool(y[0] <= -0.5) is near
    assert bool(y[1] <= -0.5) is near
    assert y[2] > -0.4
    assert y[3] < -0.5


def test_who_does_not_cross_is_not_pushed_onto_a_crossing() -> None:
    """People who walk along the sidewalk meet in front of a crossing; one of them crosses."""
    crossing = shapely.box(-2.0, -1.0, 2.0, 7.0)
    crowd = Crowd.create(
        [(-2.0, -0.05), (2.0, -0.1), (0.0, -0.5)],
        [(1.2, 0.4), (-1.2, 0.4), (0.0, 0.0)],
        1.2,
        [[(4.0, 0.1)], [(-4.0, 0.1)], [(0.0, -0.2), (0.0, 9.0)]],
        signals=[[-1], [-1], [1, -1]],
    )
    held = HeldAtKerb(CrowdModel(SIM, STEP), 0, 1, SIDEWALK, crossings=crossing)
    highest = np.full(3, -np.inf)
    for _ in range(60):
        held.advance(crowd, Vehicles.empty(), Surroundings(closed=np.array([True, False])))
        on = np.abs(crowd.position[:, 0]) < 2.0
        highest = np.where(on, np.maximum(highest, crowd.position[:, 1]), highest)
    assert (highest[:2] <= 0.0).all()
    assert highest[2] > 0.5
    assert (np.abs(crowd.position[:2, 0]) > 0.5).all()  # they pass
