"""Sub-steps, and the errors that the steps of all models share."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pedestrian_model import Crowd, Vehicles
from pedestrian_model._jit import kernel
from pedestrian_model.errors import ParameterError
from pedestrian_model.stepping import FINE, LONGEST_STEP, divergence, first_insane, substeps


@kernel
def insane(position: np.ndarray, velocity: np.ndarray) -> int:
    return first_insane(position, velocity)


@given(st.floats(1e-4, 10.0))
def test_sub_steps_are_as_few_as_the_longest_step_allows(time_step: float) -> None:
    count = substeps(time_step)
    assert time_step / count <= LONGEST_STEP * (1.0 + 1e-6)
    assert count == 1 or time_step / (count - 1) > LONGEST_STEP


@pytest.mark.parametrize("time_step", [0.0, -0.1, math.nan, math.inf])
def test_a_time_step_that_is_none_is_refused(time_step: float) -> None:
    with pytest.raises(ParameterError, match="time_step"):
        substeps(time_step)


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e13])
def test_the_first_state_that_is_not_sane_is_found(bad: float) -> None:
    position, velocity = np.zeros((4, 2)), np.ones((4, 2))
    assert insane(position, velocity) == FINE
    velocity[2, 1] = position[3, 0] = bad
    assert insane(position, velocity) == 2


def test_a_vehicle_that_is_not_finite_is_named_before_the_person() -> None:
    crowd = Crowd.create([[0.0, 0.0]], [[1.0, 0.0]], 1.3, [np.array([[9.0, 0.0]])])
    car = Vehicles.create(5.0, 0.0, 0.0, 3.0, 1.0, 4.0, 1.0)
    assert "pedestrian 0" in str(divergence(0, crowd, car))
    car.array[0, 3] = np.nan
    assert str(divergence(0, crowd, car)).startswith("vehicle 0, column ")
