"""The picture of recorded and simulated behaviour."""

from __future__ import annotations

import numpy as np

from giveway.figures.behaviour_figure import Panel, behaviour_figure

LEVELS = np.linspace(0.0, 1.0, 5)


def panel(recorded: list[float], simulated: list[float]) -> Panel:
    band = np.linspace(0.0, 1.0, 5)
    values = (np.array(recorded), np.array(simulated))
    return Panel("speed [m/s]", "1.2 times", *values, band, band + 0.1, LEVELS)


def test_each_panel_has_both_cumulative_distributions() -> None:
    figure = behaviour_figure([panel([2.0, 1.0], [3.0, 1.0, 2.0])] * 6, "made")
    assert len(figure.axes) == 6
    recorded, simulated = figure.axes[0].lines
    assert recorded.get_xydata().tolist() == [[1.0, 0.5], [2.0, 1.0]]
    assert simulated.get_xdata().tolist() == [1.0, 2.0, 3.0]
    assert [text.get_text() for text in figure.legends[0].get_texts()][1:] == [
        "recorded",
        "simulated",
    ]


def test_a_panel_without_values_is_empty() -> None:
    figure = behaviour_figure([panel([], [])], "made")
    assert all(len(line.get_xdata()) == 0 for line in figure.axes[0].lines)
