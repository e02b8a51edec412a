"""The distributions of a study's runs, cell by cell: quartiles, tails and mean of each metric."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from giveway.figures.studies.study_rows import (
    LABEL_WIDTH,
    Row,
    horizontal_grid,
    label_rows,
    rows_height,
    wrapped,
)
from giveway.figures.style import BLACK, GREY, styled
from giveway.run_data.writing import with_unit

WHISKERS = (5.0, 25.0, 50.0, 75.0, 95.0)  # Percentiles that are drawn


@dataclass(frozen=True)
class DistributionColumn:
    """One metric: its name in words, its unit, and the runs' values per row."""

    quantity: str
    unit: str
    values: Sequence[NDArray[np.float64]]


@styled
def distributions_figure(
    rows: Sequence[Row],
    colours: Sequence[str],
    columns: Sequence[DistributionColumn],
    *,
    title: str = "",
) -> Figure:
    """Draw lines from the 5th to the 95th percentile, bars of quartiles, medians and means.

    Args:
        rows: Labels of the cells.
        colours: Colours of the cells.
        columns: Metrics, whose values are left out if they are not finite.
        title: Title of the whole figure.

    Raises:
        ValueError: there is no cell or no metric.
    """
    if not rows or not columns:
        raise ValueError("distributions: nothing to draw; pass at least one cell and one metric")
    figure = Figure(
        figsize=(2.5 * len(columns) + 2.0, rows_height(rows) + 1.3), layout="constrained"
    )
    grid = figure.subplots(1, len(columns), sharey=True, squeeze=False)[0]
    places = label_rows(grid[0], rows)
    for axes, column in zip(grid, columns, strict=True):
        horizontal_grid(axes)
        for y, colour, values in zip(places, colours, column.values, strict=True):
            _draw(axes, y, colour, values[np.isfinite(values)])
        axes.set_xlabel(wrapped(with_unit(column.quantity, column.unit), LABEL_WIDTH))
        axes.margins(x=0.06)
        axes.locator_params(axis="x", nbins=5)
        axes.tick_params(axis="y", length=0)
    figure.suptitle(title)
    figure.legend(handles=_legend(), loc="outside lower center", ncols=4)
    return figure


def _draw(axes: Axes, y: float, colour: str, values: NDArray[np.float64]) -> None:
    if not values.size:
        axes.text(
            0.02, y, "none", transform=axes.get_yaxis_transform(), va="center", fontsize=7,
            color=GREY,
        )  # fmt: skip
        return
    low, lower, median, upper, high = np.percentile(values, WHISKERS)
    axes.plot([low, high], [y, y], color=colour, linewidth=1.2, zorder=2, label="5-95 %")
    axes.plot(
        [lower, upper], [y, y], color=colour, linewidth=6.0, alpha=0.45, zorder=2.5,
        solid_capstyle="butt", label="quartiles",
    )  # fmt: skip
    axes.plot(
        median, y, "|", color=colour, markersize=9, markeredgewidth=2, zorder=3, label="median"
    )
    axes.plot(values.mean(), y, "o", color=BLACK, markersize=3, zorder=4, label="mean")


def _legend() -> list[Artist]:
    return [
        Line2D([], [], color=GREY, linewidth=1.2, label="5 to 95 % of the runs"),
        Line2D([], [], color=GREY, linewidth=6.0, alpha=0.45, label="middle half"),
        Line2D(
            [], [], color=GREY, marker="|", markersize=9, markeredgewidth=2, linewidth=0,
            label="median",
        ),
        Line2D([], [], color=BLACK, marker="o", markersize=3, linewidth=0, label="mean"),
    ]  # fmt: skip
