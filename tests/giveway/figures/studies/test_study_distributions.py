"""The figure of distributions: one curve per controller."""

from __future__ import annotations

import math

import numpy as np

from giveway.figures.studies.study_distributions import DistributionColumn, distributions_figure
from giveway.figures.studies.study_rows import (
    Row,
)
from giveway.figures.style import BLUE

NAN = math.nan


def lines(axes, label):
    return [line for line in axes.lines if line.get_label() == label]


class TestDistributions:
    """Spread of the runs, cell by cell."""

    def draw(self, *values):
        rows = [Row(f"cell {k}") for k in range(len(values))]
        column = DistributionColumn("RMS jerk", "m/s^3", [np.asarray(v, float) for v in values])
        return distributions_figure(rows, [BLUE] * len(values), [column]).axes[0]

    def test_percentiles_and_mean(self):
        values = np.arange(101.0) ** 2
        axes = self.draw(np.append(values, NAN))
        assert axes.get_xlabel() == "RMS jerk [m/s³]"
        assert list(lines(axes, "5-95 %")[0].get_xdata()) == [25.0, 9025.0]
        assert list(lines(axes, "quartiles")[0].get_xdata()) == [625.0, 5625.0]
        assert lines(axes, "median")[0].get_xdata() == [2500.0]
        assert lines(axes, "mean")[0].get_xdata() == [values.mean()]

    def test_a_cell_without_numbers_says_so(self):
        axes = self.draw([1.0], [NAN])
        assert [text.get_text() for text in axes.texts] == ["none"]
        assert len(lines(axes, "mean")) == 1
