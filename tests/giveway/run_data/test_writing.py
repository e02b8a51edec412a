"""The format of numbers and units in pictures and on pages."""

import math

import pytest

from giveway.run_data.writing import digits_for, number, pretty_unit, with_unit


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (-0.574, 2, "−0.57"),
        (-0.001, 2, "0.00"),
        (12.0, 0, "12"),
        (math.nan, 2, "N.A."),
        (math.inf, 2, "N.A."),
    ],
)
def test_a_number_has_a_true_minus_and_no_negative_zero(
    value: float, digits: int, text: str
) -> None:
    assert number(value, digits) == text


@pytest.mark.parametrize(
    ("width", "digits"),
    [(0.0, 2), (math.inf, 2), (0.012, 3), (0.3, 2), (5.0, 2), (40.0, 0), (1e-9, 4), (5000.0, 0)],
)
def test_a_width_is_shown_with_two_digits_or_more(width: float, digits: int) -> None:
    assert digits_for(width) == digits


def test_units_are_printed_as_in_a_book() -> None:
    assert pretty_unit("m/s^2") == "m/s²"
    assert pretty_unit("N.s/m") == "N·s/m"
    assert with_unit("Time", "s") == "Time [s]"
    assert with_unit("Contacts", "") == "Contacts"
