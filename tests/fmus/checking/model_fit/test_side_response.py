"""The response of a side, against the first-order actuator and against fine integrations."""

import numpy as np
import pytest

from fmus.checking.model_fit.actuator import mean_force
from fmus.checking.model_fit.side_response import SideResponse

STEP = 0.05
COMMAND = np.repeat([[0.0, 2000.0, 0.0, 6000.0, 1000.0, 0.0]], 20, axis=1)
SPEED = np.full(COMMAND.shape, 10.0)


def integrated(rise, fall, rate, limit, pieces=500):
    """The mean force of each step, by small steps of the lag behind a limited rate."""
    target = force = 0.0
    means = []
    for command in COMMAND[0]:
        total = 0.0
        for _ in range(pieces):
            fine = STEP / pieces
            target += np.clip(min(command, limit) - target, -rate * fine, rate * fine)
            lag = rise if target > force else fall
            force += (target - force) * (1.0 - np.exp(-fine / lag)) if lag else target - force
            total += force / pieces
        means.append(total)
    return np.array(means)


@pytest.mark.parametrize(("lag", "delay"), [(0.0, 0.0), (0.3, 0.0), (0.0, 0.07), (0.2, 0.13)])
def test_lag_and_dead_time_are_exact(lag, delay):
    found = SideResponse(lag=lag, delay=delay).force(COMMAND, SPEED, STEP)
    assert found[0] == pytest.approx(mean_force(COMMAND[0], STEP, lag, delay), abs=1e-6)


def test_a_second_order_is_two_lags_in_a_row():
    twice = SideResponse(lag=0.9, second=0.14).force(COMMAND, SPEED, STEP)
    first = SideResponse(lag=0.2).force(COMMAND, SPEED, STEP)
    again = SideResponse(lag=0.7).force(first, SPEED, STEP)
    assert twice == pytest.approx(again, abs=20.0)  # the first lag's mean over each step
    shaken = SideResponse(lag=0.024, second=0.0063).force(COMMAND, SPEED, STEP)
    assert shaken.max() > 1.3 * COMMAND.max()


@pytest.mark.parametrize(
    ("rise", "fall", "rate", "limit"),
    [(0.0, 0.0, 5000.0, np.inf), (0.6, 0.2, np.inf, np.inf), (0.3, 0.3, np.inf, 4000.0)],
)
def test_limits_and_two_lags_are_those_of_fine_steps(rise, fall, rate, limit):
    release = fall if fall != rise else None
    response = SideResponse(lag=rise, release=release, rate=rate, limit=limit)
    found = response.force(COMMAND, SPEED, STEP)[0]
    bound = 1e9 if np.isinf(rate) else rate
    assert found == pytest.approx(integrated(rise, fall, bound, limit), abs=15.0)


def test_power_bounds_the_force_at_speed_only():
    response = SideResponse(limit=5000.0, power=30_000.0)
    assert response.force(COMMAND, SPEED, STEP).max() == pytest.approx(3000.0)
    assert response.force(COMMAND, 0.5 * SPEED, STEP).max() == pytest.approx(5000.0)


def test_a_pedal_that_is_not_linear_meets_the_linear_one_when_full():
    found = SideResponse(exponent=2.0, full=6000.0).force(COMMAND, SPEED, STEP)
    assert found.max() == pytest.approx(6000.0)
    assert found[0, 30] == pytest.approx(2000.0**2 / 6000.0)
