"""The errors of the MPC's prediction in a drive."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.prediction import position_errors, simulate, speed_errors

STEP, MASS, FRICTION = 0.05, 1000.0, 100.0
FORCE = np.repeat([2000.0, -1500.0, 800.0], 40)


@given(st.floats(0.0, 8.0))
def test_speeds_of_the_model_never_fall_below_zero(speed: float) -> None:
    position, velocity = simulate(FORCE, STEP, MASS, FRICTION, speed)
    assert (velocity >= 0.0).all()
    assert (np.diff(position) >= 0.0).all()


def test_by_hand_one_step_of_the_model() -> None:
    position, velocity = simulate(np.array([500.0]), STEP, MASS, FRICTION, 4.0)
    assert position == pytest.approx([0.0, 0.2])
    assert velocity == pytest.approx([4.0, 4.0 + 0.05 / 1000.0 * (500.0 - 400.0)])


def driven(force: np.ndarray, mass: float, speed: float = 4.0) -> Trace:
    """The drive of a car that is the MPC's model with another mass."""
    position, velocity = simulate(force, STEP, mass, FRICTION, speed)
    nothing = np.zeros(velocity.size)
    return Trace(STEP, force, position, velocity, nothing, nothing[1:], ())


def test_a_car_that_is_the_model_is_predicted_without_error() -> None:
    trace = driven(FORCE, MASS)
    assert speed_errors(trace, MASS, FRICTION) == pytest.approx(0.0, abs=1e-12)
    assert position_errors(trace, MASS, FRICTION, 15) == pytest.approx(0.0, abs=1e-9)


def test_a_heavier_car_is_predicted_to_speed_up_too_much() -> None:
    force = np.full(60, 2000.0)
    trace = driven(force, 1200.0)
    errors = speed_errors(trace, MASS, FRICTION)
    expected = STEP * (force - FRICTION * trace.speed[:-1]) * (1 / MASS - 1 / 1200.0)
    assert errors == pytest.approx(expected)
    assert len(position_errors(trace, MASS, FRICTION, 15)) == 60 - 15 + 1


def test_at_a_standstill_there_is_no_error_of_speed() -> None:
    trace = driven(np.full(20, -3000.0), MASS, speed=0.0)
    assert speed_errors(trace, MASS, FRICTION).size == 0
