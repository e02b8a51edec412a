"""The figure of differences: intervals, families of tests, what is left out."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.colors import to_hex, to_rgb

from giveway.figures.studies.study_differences import (
    DifferenceColumn,
    Differences,
    bin_edges,
    differences_figure,
)
from giveway.figures.style import BLUE, GREY, ORANGE

NAN = math.nan


TIME = DifferenceColumn("general", "completion time", "s")


CLEARANCE = DifferenceColumn("general", "minimum clearance", "m", better="higher")


def panel(values, *, mean=NAN, low=NAN, high=NAN, published=None):
    return Differences(np.asarray(values, dtype=float), 1.0, mean, low, high, published)


def lines(axes, label):
    return [line for line in axes.lines if line.get_label() == label]


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


class TestDifferences:
    """Histograms of paired differences."""

    values = np.random.default_rng(1).normal(-1.0, 2.0, 300)

    def draw(self, *panels, column=TIME):
        rows = [(f"context {k}", [one]) for k, one in enumerate(panels)]
        return differences_figure([column], rows, source="They")

    def test_every_pair_is_counted_or_told_to_be_beyond(self):
        values = np.append(self.values, [-400.0, -300.0, 500.0])
        axes = self.draw(panel(values)).axes[0]
        drawn = sum(bar.get_height() for bar in axes.patches)
        told = [text.get_text() for text in axes.texts]
        beyond = [int(text.strip("‹› ")) for text in told if set(text) & set("‹›")]
        assert drawn + sum(beyond) == values.size
        assert min(beyond) >= 1

    @pytest.mark.parametrize(("column", "left"), [(TIME, BLUE), (CLEARANCE, ORANGE)])
    def test_the_side_where_the_treatment_is_better_is_blue(self, column, left):
        axes = self.draw(panel(self.values), column=column).axes[0]
        for bar in axes.patches:
            colour = left if bar.get_x() < 0 else ({BLUE, ORANGE} - {left}).pop()
            assert bar.get_facecolor()[:3] == to_rgb(colour)

    def test_one_tall_bin_does_not_hide_the_tail(self):
        """Then all panels count logarithmically, so that they can be compared."""
        spike = np.append(np.full(2000, -0.39), np.linspace(-15.0, -1.0, 60))
        axes = self.draw(panel(spike), panel(self.values)).axes
        assert {each.get_yscale() for each in axes} == {"symlog"}
        assert [text.get_text() for text in axes[0].get_yticklabels()] == [
            "0", "1", "10", "100", "1000"
        ]  # fmt: skip
        assert self.draw(panel(self.values)).axes[0].get_yscale() == "linear"

    def test_pairs_without_a_difference_are_on_neither_side(self):
        figure = self.draw(panel([-1.0, -1.0, 0.0, 0.0, -1e-9, 2.0, 2.0]))
        bars = {to_hex(bar.get_facecolor()): 0.0 for bar in figure.axes[0].patches}
        for bar in figure.axes[0].patches:
            bars[to_hex(bar.get_facecolor())] += bar.get_height()
        assert bars == {BLUE.lower(): 2.0, ORANGE.lower(): 2.0, GREY.lower(): 3.0}
        assert "no difference" in legend(figure)
        assert "no difference" not in legend(self.draw(panel([-1.0, 2.0])))

    def test_zero_mean_interval_and_published_mean_are_in_place(self):
        one = panel(self.values, mean=-1.1, low=-1.4, high=-0.8, published=-2.5)
        figure = self.draw(one)
        axes = figure.axes[0]
        for label, place in (("zero", 0.0), ("mean", -1.1), ("published", -2.5)):
            (line,) = lines(axes, label)
            assert list(line.get_xdata()) == [place, place]
        (span,) = [patch for patch in axes.patches if patch.get_label() == "interval"]
        assert (span.get_x(), span.get_width()) == (-1.4, pytest.approx(0.6))
        assert axes.get_title(loc="left") == "n = 300 (100 %): −1.10 [−1.40, −0.80] s"
        assert "They: mean" in legend(figure)

    def test_too_few_pairs_have_bars_and_no_mean(self):
        figure = self.draw(panel([-1.0, 2.0]))
        axes = figure.axes[0]
        assert sum(bar.get_height() for bar in axes.patches) == 2
        assert not lines(axes, "mean")
        assert axes.get_title(loc="left").endswith("N.A.")
        assert "mean" not in legend(figure)

    @pytest.mark.filterwarnings("error")
    def test_no_pair_is_said(self, tmp_path):
        figure = self.draw(panel([]), panel([0.0, 0.0]))
        figure.savefig(tmp_path / "picture.png")
        assert "no such pair" in [text.get_text() for text in figure.axes[0].texts]

    def test_contexts_share_their_axis(self):
        figure = self.draw(panel(self.values), panel(10.0 + self.values))
        limits = {axes.get_xlim() for axes in figure.axes}
        assert len(limits) == 1
        assert figure.axes[0].get_ylabel() == "context 0"

    @pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
    def test_zero_is_an_edge_of_the_bins(self, scale):
        edges = bin_edges([panel(scale * self.values)])
        assert np.abs(edges).min() == pytest.approx(0.0, abs=1e-9 * scale)
        assert 20 < edges.size < 140

    def test_nothing_is_refused(self):
        with pytest.raises(ValueError, match="no rows"):
            differences_figure([TIME], [])
