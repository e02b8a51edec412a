"""The response of a side, against the first-order actuator and against fine integrations."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus.checking.model_fit.side_response import SideResponse

STEP = 0.05
COMMAND = np.repeat([[0.0, 2000.0, 0.0, 6000.0, 1000.0, 0.0]], 20, axis=1)
SPEED = np.full(COMMAND.shape, 10.0)


def mean_force(force, step, lag, delay):
    """The mean force of one drive behind a first-order lag and a dead time."""
    return SideResponse(lag=lag, delay=delay).force(force[None], np.ones((1, force.size)), step)[0]


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


# ---- lag and dead time ----

forces = st.lists(st.floats(-8000, 8000), min_size=2, max_size=30).map(np.array)
lags = st.sampled_from([0.0, 1e-3, 0.02, 0.2, 1.5])
delays = st.floats(0.0, 0.6)


def integrated_late(force, lag, delay, pieces=400):
    """The same by exact steps of the lag between the instants at which the input changes."""
    acting, means = 0.0, []
    fine = STEP / pieces
    for k in range(force.size):
        total = 0.0
        for i in range(pieces):
            at = (k + (i + 0.5) / pieces) * STEP - delay
            u = force[int(at / STEP)] if at >= 0.0 else 0.0
            keep = np.exp(-fine / lag) if lag else 0.0
            total += u * fine + (acting - u) * lag * (1.0 - keep)
            acting = u + (acting - u) * keep
        means.append(total / STEP)
    return np.array(means)


@given(forces)
def test_without_lag_and_dead_time_the_command_acts(force):
    assert mean_force(force, STEP, 0.0, 0.0) == pytest.approx(force, abs=1e-9)


@given(forces, lags, st.integers(0, 5))
def test_whole_steps_of_dead_time_shift_the_force(force, lag, steps):
    late = mean_force(force, STEP, lag, steps * STEP)
    prompt = mean_force(force, STEP, lag, 0.0)
    expected = np.concatenate((np.zeros(steps), prompt))[: force.size]
    assert late == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("lag", [0.0, 0.02, 0.2])
@pytest.mark.parametrize("delay", [0.0, 0.0125, 0.05, 0.13, 0.31])
def test_it_is_the_integral_of_the_lagged_force(lag, delay):
    force = np.random.default_rng(4).uniform(-8000, 8000, 15)
    expected = integrated_late(force, lag, delay)
    assert mean_force(force, STEP, lag, delay) == pytest.approx(
        expected, abs=60.0 if delay else 1e-6
    )


@given(forces, forces, lags, delays)
def test_it_is_linear(one, other, lag, delay):
    n = min(one.size, other.size)
    one, other = one[:n], other[:n]
    both = mean_force(one + 2.0 * other, STEP, lag, delay)
    apart = mean_force(one, STEP, lag, delay) + 2.0 * mean_force(other, STEP, lag, delay)
    assert both == pytest.approx(apart, abs=1e-6)


@given(lags, delays)
def test_no_impulse_is_lost(lag, delay):
    force = np.concatenate((np.full(20, 1000.0), np.zeros(400)))
    assert mean_force(force, STEP, lag, delay).sum() == pytest.approx(20_000.0, rel=2e-6)
