"""What a safety layer takes people to be able to do, by name."""

import math
from dataclasses import replace

import pytest

from controller import ParameterError, WorstMotion, worst_motion
from controller.safety.worst_motion import RECORDED

SIMULATED = WorstMotion(acceleration=5.0, speed=2.5)


def test_the_worst_case_is_all_that_the_simulated_people_can_do():
    assert worst_motion("worst-case", SIMULATED) == SIMULATED


def test_the_recorded_motion_is_fixed_and_covers_their_speeds():
    faster = WorstMotion(acceleration=9.0, speed=4.0)
    for name in ("recorded-99.9", "responsible"):
        assert worst_motion(name, SIMULATED) == RECORDED[name]
        assert worst_motion(name, faster) == replace(RECORDED[name], speed=4.0)


def test_only_the_worst_case_is_equally_sudden_on_sidewalks():
    assert worst_motion("worst-case", SIMULATED).setting_out == math.inf
    for name in ("recorded-99.9", "responsible"):
        assert worst_motion(name, SIMULATED).setting_out == 0.6


def test_the_responsible_ones_do_less_than_the_recorded_ones():
    recorded, responsible = RECORDED["recorded-99.9"], RECORDED["responsible"]
    assert responsible.acceleration < recorded.acceleration < SIMULATED.acceleration
    assert responsible.speed < recorded.speed


@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf")])
def test_bounds_are_positive_numbers(value):
    with pytest.raises(ParameterError, match="acceleration"):
        WorstMotion(value, 2.5)
