"""Rows of a figure: names, order and space."""

from __future__ import annotations

import math

import pytest

from giveway.figures.studies.study_rows import (
    Row,
    level_colours,
    row_places,
)
from giveway.figures.style import GREY
from giveway.run_data.writing import digits_for, number

NAN = math.nan


class TestRows:
    """Labels, numbers, colours."""

    def test_rows_under_one_heading_stand_together(self):
        places, headings, height = row_places([Row("a", "x"), Row("b", "x"), Row("a", "y")])
        assert [text for _, text in headings] == ["x", "y"]
        assert headings[0][0] < places[0] < places[1] < headings[1][0] < places[2] < height

    def test_headings_of_single_rows_are_their_labels(self):
        assert row_places([Row("", "x"), Row("", "y")])[1] == []

    def test_the_baseline_is_grey_and_the_others_differ(self):
        colours = level_colours(list("abcdef"), "c")
        assert colours["c"] == GREY
        assert len(set(colours.values())) == 6

    @pytest.mark.parametrize(
        ("value", "digits", "text"),
        [(-1.239, 2, "−1.24"), (-0.001, 2, "0.00"), (NAN, 2, "N.A."), (math.inf, 1, "N.A.")],
    )
    def test_numbers(self, value, digits, text):
        assert number(value, digits) == text

    @pytest.mark.parametrize(
        ("width", "digits"), [(0.05, 3), (0.5, 2), (5.0, 2), (50.0, 0), (0.0, 2), (NAN, 2)]
    )
    def test_digits_follow_the_interval(self, width, digits):
        assert digits_for(width) == digits
