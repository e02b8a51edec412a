"""Pictures of a study: what is drawn of the numbers, and what is said where there are none."""

from __future__ import annotations

import itertools
import math

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.colors import to_hex, to_rgb

from giveway.figures.studies.study_differences import (
    DifferenceColumn,
    Differences,
    bin_edges,
    differences_figure,
)
from giveway.figures.studies.study_distributions import DistributionColumn, distributions_figure
from giveway.figures.studies.study_forest import Estimate, ForestColumn, forest_figure
from giveway.figures.studies.study_pairs import PairSide, pair_figure
from giveway.figures.studies.study_rows import (
    Row,
    label_rows,
    level_colours,
    row_places,
)
from giveway.figures.studies.study_tradeoff import TradeOffPoint, tradeoff_figure
from giveway.figures.style import BLUE, GREY, ORANGE
from giveway.run_data.writing import digits_for, number

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


class TestTradeOff:
    """One point per cell."""

    def point(self, context, level, x, y):
        return TradeOffPoint(context, level, x, y, (x - 1, x + 2), (y - 0.1, y + 0.1))

    def test_points_intervals_and_the_line_of_a_context(self):
        points = [self.point("30", "mpc", 14.0, 0.2), self.point("30", "pid", 16.0, 0.1)]
        figure = tradeoff_figure(
            points, {"mpc": BLUE, "pid": GREY}, x_label=("time", "s"), y_label=("gap", "m")
        )
        axes = figure.axes[0]
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("time [s]", "gap [m]")
        assert lines(axes, "mpc")[0].get_xydata().tolist() == [[14.0, 0.2]]
        assert lines(axes, "context 30")[0].get_xydata().tolist() == [[14.0, 0.2], [16.0, 0.1]]
        assert [13.0, 16.0] in [list(line.get_xdata()) for line in axes.lines]
        assert not axes.texts  # one context needs no name
        assert legend(figure) == ["mpc", "pid"]

    def test_points_at_one_place_share_a_name(self):
        points = [self.point(c, "mpc", 14.0, 0.2) for c in ("10", "20")]
        points.append(self.point("30", "mpc", 18.0, 0.1))
        figure = tradeoff_figure(points, {"mpc": BLUE}, x_label=("t", "s"), y_label=("g", "m"))
        assert [text.get_text() for text in figure.axes[0].texts] == ["10, 20", "30"]

    def test_names_keep_clear_of_each_other(self):
        places = [(14.0 + 0.16 * i, 0.2 + 0.008 * (i % 2)) for i in range(5)]
        points = [self.point(f"context number {i}", "mpc", *at) for i, at in enumerate(places)]
        points += [self.point("far", "mpc", 16.0, 0.3)]
        figure = tradeoff_figure(points, {"mpc": BLUE}, x_label=("t", "s"), y_label=("g", "m"))
        figure.draw_without_rendering()
        boxes = [text.get_window_extent() for text in figure.axes[0].texts]
        assert len(boxes) == 6
        assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))


class TestPairs:
    """Both runs of a pair, side by side."""

    def test_speed_reference_gap_force_and_who_acts(self, run):
        sides = [PairSide(n, run(30, 1, n)[0], 8.0, 10.0) for n in ("mpc", "pid")]
        figure = pair_figure(sides, title="seed 1")
        grid = np.array(figure.axes).reshape(3, 2)
        for (speed, gap, force), side in zip(grid.T, sides, strict=True):
            assert speed.get_title() == side.label
            np.testing.assert_array_equal(lines(speed, "speed")[0].get_ydata(), side.ego.speed)
            reference = lines(speed, "reference speed")[0].get_ydata()
            np.testing.assert_array_equal(reference, side.ego.reference_speed)
            drawn, seen = lines(gap, "gap")[0].get_ydata(), np.isfinite(side.ego.gap)
            np.testing.assert_array_equal(drawn[np.isfinite(drawn)], side.ego.gap[seen])
            assert lines(gap, "d_safe")[0].get_ydata() == [8.0, 8.0]
            np.testing.assert_array_equal(
                lines(force, "force")[0].get_ydata(), side.ego.force / 1000.0
            )
            assert {patch.get_label() for patch in gap.patches} == set(side.ego.controller)
        assert len({axes.get_xlim() for axes in grid.flat}) == 1
        assert grid[1, 0].get_ylim() == grid[1, 1].get_ylim()
        assert grid[2, 0].get_ylim() == grid[2, 1].get_ylim()

    def test_each_side_has_its_own_distances(self, run):
        ego = run(5, 1, "pid")[0]
        figure = pair_figure([PairSide("a", ego, 4.0, 10.0), PairSide("b", ego, 12.0, 1.0)])
        safe = [lines(axes, "d_safe")[0].get_ydata()[0] for axes in figure.axes[2:4]]
        assert safe == [4.0, 12.0]


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
