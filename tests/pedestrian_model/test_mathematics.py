"""Elementary functions of the kernels, compared with those of the C library."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from pedestrian_model._jit import kernel
from pedestrian_model._mathematics import cosine_sine, exponential


@kernel
def exp(x: float) -> float:
    return exponential(x)


@kernel
def both(angle: float) -> tuple[float, float]:
    return cosine_sine(angle)


@given(st.floats(-700.0, 700.0))
def test_the_exponential_is_right_to_two_units_in_the_last_place(x: float) -> None:
    assert abs(exp(x) - math.exp(x)) <= 2.0 * math.ulp(math.exp(x))


@given(st.floats(-math.pi, math.pi))
def test_cosine_and_sine_are_right_to_a_few_roundings(angle: float) -> None:
    c, s = both(angle)
    assert abs(c - math.cos(angle)) < 1e-15
    assert abs(s - math.sin(angle)) < 1e-15


def test_a_step_of_the_exponential_never_falls() -> None:
    x = np.linspace(-1.0, 1.0, 20_001)
    values = np.array([exp(one) for one in x])
    assert (np.diff(values) > 0.0).all()
