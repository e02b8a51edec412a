"""At walking pace, weight and creep are balanced, which the controllers do not know."""

from __future__ import annotations

from math import asin
from types import SimpleNamespace

import pytest

from fmus.checking import Standing
from giveway.ego.walking_pace import WalkingPace

MASS = 1000.0  # [kg]
HILL = asin(0.05)  # [rad] the weight pulls with 490.5 N
CREEPS = Standing(creep=1.0, creep_force=800.0, hold=3000.0)


def pace(rests=CREEPS, *, grades=False):
    return WalkingPace(MASS, rests, SimpleNamespace(knows_grades=grades)).force


@pytest.mark.parametrize(
    ("asked", "speed", "passed_on"),
    [
        (300.0, 0.5, -100.0),
        (-300.0, 0.5, -700.0),
        (-300.0, 1.2, -300.0),  # it creeps no faster than 1 m/s
        (-300.0, 0.0, -300.0),  # the brakes hold it
        (300.0, 0.0, 1.0),  # enough to let them go
        (1000.0, 0.0, 200.0),
    ],
)
def test_a_gearbox_that_creeps_is_balanced(asked, speed, passed_on):
    assert pace()(asked, speed) == pytest.approx(passed_on)


@pytest.mark.parametrize(
    ("asked", "speed", "grade", "passed_on"),
    [
        (200.0, 0.0, HILL, 690.5),  # it drives off without rolling back
        (200.0, 1.0, HILL, 690.5),
        (200.0, 1.5, HILL, 200.0 + 0.5 * 490.5),
        (200.0, 2.0, HILL, 200.0),
        (-200.0, 1.0, -HILL, -690.5),
        (200.0, 0.0, -HILL, 1.0),
        (0.0, 0.0, HILL, 0.0),
    ],
)
def test_the_weight_is_borne_below_two_metres_per_second(asked, speed, grade, passed_on):
    assert pace(Standing(), grades=True)(asked, speed, grade) == pytest.approx(passed_on)


def test_nothing_is_added_for_a_vehicle_that_stands_by_itself():
    assert pace(Standing())(123.4, 0.5, HILL) == 123.4


def test_a_vehicle_whose_brakes_are_not_held_keeps_the_controllers_force():
    assert pace(Standing(creep=1.0, creep_force=800.0))(123.4, 0.5) == 123.4
