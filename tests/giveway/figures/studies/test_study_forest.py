"""The forest figure: one line per pair and metric."""

from __future__ import annotations

import math

import matplotlib.pyplot as plt

from giveway.figures.studies.study_forest import Estimate, ForestColumn, forest_figure
from giveway.figures.studies.study_rows import (
    Row,
    label_rows,
)

NAN = math.nan


def lines(axes, label):
    return [line for line in axes.lines if line.get_label() == label]


class TestForest:
    """Mean differences with intervals."""

    rows = (Row("mpc", "dense"), Row("tuned", "dense"), Row("mpc", "sparse"))

    def draw(self, estimates):
        return forest_figure(self.rows, [ForestColumn("completion time", "s", "lower", estimates)])

    def test_mean_and_interval_are_drawn_in_their_row(self):
        figure = self.draw({(0, "general"): Estimate(-1.0, -2.0, -0.5, published=-1.5)})
        axes = figure.axes[0]
        (mean,) = lines(axes, "general")
        (interval,) = lines(axes, "general interval")
        (published,) = lines(axes, "published")
        assert mean.get_xdata() == [-1.0]
        assert list(interval.get_xdata()) == [-2.0, -0.5]
        assert published.get_xdata() == [-1.5]
        heading, first = (label.get_text() for label in axes.get_yticklabels()[:2])
        assert (heading, first) == ("dense", "mpc")
        assert mean.get_ydata() == [axes.get_yticks()[1]]

    def test_what_is_not_shown_is_hollow(self):
        figure = self.draw(
            {(0, "general"): Estimate(-1, -2, 1, shown=False), (1, "general"): Estimate(-1, -2, 0)}
        )
        hollow, filled = lines(figure.axes[0], "general")
        assert hollow.get_markerfacecolor() != hollow.get_color()
        assert filled.get_markerfacecolor() == filled.get_color()

    def test_not_available_is_said(self):
        figure = self.draw({(2, "non-stop"): Estimate(NAN, NAN, NAN)})
        assert [text.get_text() for text in figure.axes[0].texts] == ["N.A."]

    def test_rows_of_different_contexts_and_levels_name_both(self):
        def names(*rows):
            figure, axes = plt.subplots()
            label_rows(axes, rows)
            plt.close(figure)
            return [label.get_text() for label in axes.get_yticklabels()]

        assert names(Row("mpc", "dense"), Row("slow", "thin")) == ["dense: mpc", "thin: slow"]
        assert names(Row("mpc", "dense"), Row("mpc", "thin")) == ["dense", "thin"]

    def test_the_better_side_is_named(self):
        figure = self.draw({(0, "general"): Estimate(-1, -2, 0)})
        assert figure.axes[0].get_xlabel() == "difference [s]\n← treatment better"
