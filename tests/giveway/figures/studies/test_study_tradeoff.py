"""The trade-off figure: time against safety."""

from __future__ import annotations

import itertools

from giveway.figures.studies.study_tradeoff import TradeOffPoint, tradeoff_figure
from giveway.figures.style import BLUE, GREY


def lines(axes, label):
    return [line for line in axes.lines if line.get_label() == label]


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


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
