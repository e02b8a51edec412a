"""What the traces tell before any fit: the steps that count, and a sensor's lag."""

import numpy as np
import pytest

from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.measurements import Measurements, sensor_lag

STEP = 0.05
TIME = np.arange(0.0, 8.0 + STEP / 2, STEP)


def trace(speed, position):
    zero = np.zeros(speed.size)
    return Trace(STEP, np.full(speed.size - 1, 500.0), position, speed, zero, zero[1:], ())


def filtered(lag):
    """A speed of 5 + sin t, shown through a lag, beside the exact position."""
    gain = 1.0 / (1.0 + lag**2)
    shown = 5.0 + gain * (np.sin(TIME) - lag * np.cos(TIME))
    return trace(shown, 5.0 * TIME - np.cos(TIME))


@pytest.mark.parametrize("lag", [0.1, 0.4])
def test_a_filtered_speed_is_told_by_its_position(lag):
    assert sensor_lag([filtered(lag)]) == pytest.approx(lag, rel=0.01)


def test_speeds_and_positions_that_agree_have_no_lag():
    assert abs(sensor_lag([filtered(0.0)])) < 1e-3
    speed = 5.0 + np.sin(TIME)
    steps = np.concatenate(([0.0], np.cumsum(STEP * speed[:-1])))
    assert sensor_lag([trace(speed, steps)]) == pytest.approx(-0.5 * STEP)  # forward Euler
    means = np.concatenate(([0.0], np.cumsum(0.5 * STEP * (speed[1:] + speed[:-1]))))
    assert sensor_lag([trace(speed, means)]) is None  # integrated: it tells nothing


def test_neither_the_first_second_nor_a_standstill_counts():
    speed = np.maximum(4.0 - TIME, 0.0)
    measured = Measurements.of([trace(speed, 0.0 * speed)], map_friction=50.0, full=(400.0, 1.0))
    used = np.flatnonzero(measured.used[0])
    assert used[0] == round(1.0 / STEP)
    assert used[-1] * STEP < 4.0 - 0.6
    assert measured.commands[0].max() == 400.0
    assert measured.acceleration == pytest.approx(-1.0)
