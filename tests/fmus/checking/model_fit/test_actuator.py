"""The mean force of a step behind dead time and lag, against a fine integration."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus.checking.model_fit.actuator import mean_force

STEP = 0.05
forces = st.lists(st.floats(-8000, 8000), min_size=2, max_size=30).map(np.array)
lags = st.sampled_from([0.0, 1e-3, 0.02, 0.2, 1.5])
delays = st.floats(0.0, 0.6)


def integrated(force, lag, delay, pieces=400):
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
    expected = integrated(force, lag, delay)
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
