"""The driver of a brake test: a steady speed, and the foot off once the layer brakes."""

import numpy as np
import pytest

from controller import Observation, Setup
from controller.reference_drivers.speed_holder import SpeedHolder

SETUP = Setup(0.05, 1500.0, 100.0, 10.0, 8.0, 12000.0, 2.0)


def answer(driver, speed):
    return driver.control(Observation(0.0, speed, np.inf, np.empty(0)))


def test_a_car_with_another_drag_than_it_believes_keeps_the_speed():
    driver, v = SpeedHolder(SETUP), 10.0
    for _ in range(600):
        v += 0.05 * (answer(driver, v).value - 0.4)
    assert v == pytest.approx(10.0, abs=1e-3)


def test_once_the_layer_has_braked_it_asks_for_nothing():
    driver = SpeedHolder(SETUP)
    assert answer(driver, 10.0).value == 0.0
    driver.applied(-8000.0)
    assert answer(driver, 5.0) == (0.0, "released")
    driver.reset()
    assert answer(driver, 5.0).value > 0.0
