"""The forest plot: mean differences with intervals, per context, situation and metric."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from giveway.figures.studies.study_rows import (
    PUBLISHED,
    Row,
    horizontal_grid,
    label_rows,
    rows_height,
    wrapped,
)
from giveway.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, styled
from giveway.run_data.writing import with_unit

LOOKS = {  # colour and marker
    "general": (BLUE, "o"),
    "stop-and-wait": (VERMILION, "s"),
    "non-stop": (GREEN, "^"),
    "slowed": (ORANGE, "D"),
}
PAPER = "#ffffff"
SPREAD = 0.26  # Offset between the situations, as a share of a row


@dataclass(frozen=True)
class Estimate:
    """A mean difference.

    Attributes:
        mean: Mean difference, or nan if it is not reported (N.A.).
        low: Lower end of its interval.
        high: Upper end of its interval.
        shown: True if interval and test show a difference; the marker is hollow otherwise.
        published: Mean in the literature, or None.
    """

    mean: float
    low: float
    high: float
    shown: bool = True
    published: float | None = None


@dataclass(frozen=True)
class ForestColumn:
    """One metric of the plot.

    Attributes:
        quantity: Name of the metric in words.
        unit: Unit of the difference.
        better: "lower", "higher" or empty.
        estimates: Estimates by the number of the row and the situation.
    """

    quantity: str
    unit: str
    better: str
    estimates: Mapping[tuple[int, str], Estimate]


@styled
def forest_figure(
    rows: Sequence[Row],
    columns: Sequence[ForestColumn],
    *,
    title: str = "",
    source: str = "published",
) -> Figure:
    """Draw mean differences with intervals: a row per context and treatment, a panel per metric.

    Args:
        rows: Labels of the rows.
        columns: Metrics.
        title: Title of the whole figure.
        source: Source of the published numbers, for the legend.

    Raises:
        ValueError: there is no row or no metric.
    """
    if not rows or not columns:
        raise ValueError("forest: nothing to draw; pass at least one row and one metric")
    used = [name for name in LOOKS if any(key[1] == name for c in columns for key in c.estimates)]
    height = max(rows_height(rows), 0.42 * len(rows)) + 1.7
    figure = Figure(figsize=(2.2 * len(columns) + 2.2, height), layout="constrained")
    grid = figure.subplots(1, len(columns), sharey=True, squeeze=False)[0]
    places = label_rows(grid[0], rows)
    for axes, column in zip(grid, columns, strict=True):
        _draw(axes, column, places, used)
    figure.suptitle(wrapped(title, 80))
    figure.legend(handles=_legend(columns, used, source), loc="outside lower center", ncols=4)
    return figure


def _draw(axes: Axes, column: ForestColumn, places: list[float], used: list[str]) -> None:
    horizontal_grid(axes)
    axes.axvline(0.0, color=BLACK, linewidth=0.8, zorder=1, label="zero")
    for (row, situation), estimate in column.estimates.items():
        colour, marker = LOOKS[situation]
        offset = SPREAD * (used.index(situation) - (len(used) - 1) / 2)
        y = places[row] + offset
        if math.isfinite(estimate.mean):
            axes.plot(
                [estimate.low, estimate.high], [y, y], color=colour, linewidth=1.8, zorder=3,
                label=f"{situation} interval",
            )  # fmt: skip
            axes.plot(
                estimate.mean,
                y,
                marker,
                color=colour,
                markersize=5,
                zorder=4,
                label=situation,
                markerfacecolor=colour if estimate.shown else PAPER,
            )
        else:
            axes.annotate(
                "N.A.", (0.0, y), (3, 0), textcoords="offset points", va="center", fontsize=6,
                color=colour,
            )  # fmt: skip
        if estimate.published is not None:
            axes.plot(
                estimate.published, y, "D", markersize=6.5, markerfacecolor="none",
                markeredgecolor=PUBLISHED, markeredgewidth=1.3, zorder=5, label="published",
            )  # fmt: skip
    difference = with_unit("difference", column.unit)
    axes.set(title=column.quantity, xlabel=difference + _direction(column.better))
    axes.margins(x=0.08)
    axes.locator_params(axis="x", nbins=5)
    axes.tick_params(axis="y", length=0)


def _direction(better: str) -> str:
    return {"lower": "\n← treatment better", "higher": "\ntreatment better →"}.get(better, "\n ")


def _legend(columns: Sequence[ForestColumn], used: list[str], source: str) -> list[Artist]:
    def handle(colour: str, marker: str, label: str, **more: Any) -> Line2D:
        return Line2D([], [], color=colour, marker=marker, markersize=5, label=label, **more)

    handles: list[Artist] = [handle(*LOOKS[name], name, linewidth=1.8) for name in used]
    estimates = [e for column in columns for e in column.estimates.values()]
    if any(estimate.published is not None for estimate in estimates):
        handles.append(
            handle(
                PUBLISHED, "D", source, linewidth=0, markerfacecolor="none", markeredgewidth=1.3
            )
        )  # fmt: skip
    if not handles:
        handles.append(handle(GREY, "", "nothing to show"))
    return handles
