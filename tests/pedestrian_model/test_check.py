"""Checks of arrays that come from outside: messages name the index and the value."""

import numpy as np
import pytest

from pedestrian_model._check import (
    LARGEST,
    as_floats,
    check_not_negative,
    check_shape,
    check_values,
)
from pedestrian_model.errors import CrowdError


def test_numbers_of_any_kind_become_floats() -> None:
    array = as_floats([[1, 2], [3, 4]], "position", CrowdError)
    assert array.dtype == np.float64
    assert array.flags.c_contiguous
    assert as_floats(array, "position", CrowdError) is array


def test_words_are_no_numbers() -> None:
    with pytest.raises(CrowdError, match=r"^speed: expected numbers, got 'fast'$"):
        as_floats("fast", "speed", CrowdError)


@pytest.mark.parametrize("shape", [(3,), (2, 2), (3, 1)])
def test_a_shape_that_does_not_fit_is_told_with_the_one_expected(shape: tuple[int, ...]) -> None:
    with pytest.raises(CrowdError, match=r"expected \(any, 2\)|expected \(3, 2\)"):
        check_shape(np.zeros(shape), (3, 2), "velocity", CrowdError)
    check_shape(np.zeros((3, 2)), (None, 2), "velocity", CrowdError)


@pytest.mark.parametrize("value", [np.nan, np.inf, -2.0 * LARGEST])
def test_the_first_value_without_sense_is_named(value: float) -> None:
    array = np.zeros((4, 2))
    array[2, 1] = array[3, 0] = value
    with pytest.raises(CrowdError, match=r"position\[2, 1\] = "):
        check_values(array, "position", CrowdError)


def test_the_first_negative_value_is_named() -> None:
    with pytest.raises(CrowdError, match=r"width\[1\] = -0.5, expected a value >= 0"):
        check_not_negative(np.array([0.0, -0.5, -1.0]), "width", CrowdError)
    check_not_negative(np.zeros(3), "width", CrowdError)
