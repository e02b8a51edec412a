"""The cost of each level to the ego and to the people: a panel per context."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from giveway.figures.studies.study_rows import wrapped
from giveway.figures.style import GREY, quiet_grid, styled
from giveway.run_data.writing import with_unit

_COLUMNS = 4  # Largest number of panels side by side
_PANEL = 2.5, 2.3  # Width and height of a panel [inch]


@dataclass(frozen=True)
class FrontPoint:
    """One level in one context.

    Attributes:
        level: Level of the compared factor.
        x, y: Means of both costs.
        x_interval, y_interval: Intervals (low, high); nan for too few runs.
        front: True if no other level is better on both sides.
    """

    level: str
    x: float
    y: float
    x_interval: tuple[float, float]
    y_interval: tuple[float, float]
    front: bool


@styled
def fronts_figure(
    panels: Sequence[tuple[str, Sequence[FrontPoint]]],
    colours: Mapping[str, str],
    *,
    x_label: tuple[str, str],
    y_label: tuple[str, str],
    title: str = "",
) -> Figure:
    """Draw the means of two costs against each other.

    A line joins the levels on the Pareto front.

    Args:
        panels: Heading and points of each context.
        colours: Colour of each level.
        x_label: Quantity and unit of the ego's cost.
        y_label: Label of the people's cost.
        title: Title of the figure.

    Raises:
        ValueError: there is no panel.
    """
    if not panels:
        raise ValueError("fronts: no panels; pass at least one context")
    columns = min(_COLUMNS, len(panels))
    rows = math.ceil(len(panels) / columns)
    size = max(columns * _PANEL[0], 4.5), rows * _PANEL[1] + 0.9
    figure = Figure(figsize=size, layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False)
    for axes, (heading, points) in zip(grid.flat, panels, strict=False):
        _panel(axes, heading, points, colours)
    for axes in list(grid.flat)[len(panels) :]:
        axes.set_visible(False)
    figure.supxlabel(with_unit(*x_label), fontsize=9)
    figure.supylabel(with_unit(*y_label), fontsize=9)
    figure.suptitle(title)
    levels = list(dict.fromkeys(point.level for _, points in panels for point in points))
    handles = [
        Line2D([], [], color=colours[level], marker="o", linewidth=1.4, label=wrapped(level, 40))
        for level in levels
    ]
    handles.append(Line2D([], [], color=GREY, linewidth=1.2, linestyle="--", label="Pareto front"))
    figure.legend(handles=handles, loc="outside upper center", ncols=min(len(handles), 5))
    return figure


def _panel(
    axes: Axes, heading: str, points: Sequence[FrontPoint], colours: Mapping[str, str]
) -> None:
    quiet_grid(axes)
    best = sorted((point.x, point.y) for point in points if point.front)
    axes.plot(*zip(*best, strict=True), color=GREY, linewidth=1.2, linestyle="--", zorder=1)
    for point in points:
        colour = colours[point.level]
        axes.plot(point.x_interval, (point.y, point.y), color=colour, linewidth=1.2, zorder=2)
        axes.plot((point.x, point.x), point.y_interval, color=colour, linewidth=1.2, zorder=2)
        axes.plot(
            point.x, point.y, "o", color=colour, markersize=6, zorder=3,
            markerfacecolor=colour if point.front else "white",
        )  # fmt: skip
    axes.set_title(wrapped(heading, 30), fontsize=8)
    axes.margins(0.15)
