"""The picture of recorded and simulated people: cumulative distributions of their behaviour."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from giveway.figures.style import BLACK, GREY, VERMILION, quiet_grid, styled
from giveway.geometry.kernel import Array

_COLUMNS = 3
_SHOWN = (0.5, 99.5)  # Percentiles of all values between which a panel extends


class Panel(NamedTuple):
    """One distribution of recorded and simulated people.

    Attributes:
        label: Label of the horizontal axis.
        title: Title.
        recorded: Values (R,) of recorded people.
        simulated: Values (S,) of simulated people.
        low, high: Band of the values (L,) at ``levels`` in halves of the recorded people.
        levels: Levels (L,) of the band, from 0 to 1.
    """

    label: str
    title: str
    recorded: Array
    simulated: Array
    low: Array
    high: Array
    levels: Array


@styled
def behaviour_figure(panels: Sequence[Panel], title: str) -> Figure:
    """Draw cumulative distributions of recorded and simulated people, one panel for each.

    Args:
        panels: Distributions.
        title: Title of the whole figure.
    """
    rows = -(-len(panels) // _COLUMNS)
    figure = Figure(figsize=(3.1 * _COLUMNS, 2.6 * rows + 0.6), layout="constrained")
    grid = figure.subplots(rows, _COLUMNS, sharey=True, squeeze=False)
    for axes in grid.flat[len(panels) :]:
        axes.set_axis_off()
    for axes, panel in zip(grid.flat, panels, strict=False):
        axes.fill_betweenx(
            panel.levels,
            panel.low,
            panel.high,
            color=GREY,
            alpha=0.3,
            linewidth=0,
            label="halves of the recorded people, 95 %",
        )
        axes.plot(*_cumulated(panel.recorded), color=BLACK, label="recorded")
        axes.plot(*_cumulated(panel.simulated), color=VERMILION, linestyle="--", label="simulated")
        axes.set(title=panel.title, xlabel=panel.label, ylim=(0.0, 1.0))
        everything = np.concatenate([panel.recorded, panel.simulated])
        if len(everything):
            left, right = np.percentile(everything, _SHOWN).tolist()
            if left < right:
                axes.set_xlim(left, right)
        quiet_grid(axes)
    for axes in grid[:, 0]:
        axes.set_ylabel("share of samples below")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    figure.suptitle(title)
    return figure


def _cumulated(values: Array) -> tuple[Array, Array]:
    """Return the sorted values, and the share of values up to each."""
    return np.sort(values), np.arange(1, len(values) + 1) / max(len(values), 1)
