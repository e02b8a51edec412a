"""Trade-off between time and distance: one point per cell, intervals both ways."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from giveway.figures.study_rows import with_unit, wrapped
from giveway.figures.style import GREY, quiet_grid, styled

SAME_PLACE = 0.05  # of the picture's width and height


@dataclass(frozen=True)
class TradeOffPoint:
    """One cell.

    Attributes:
        context: short label of the other factors' levels.
        level: of the compared factor.
        x, y: means.
        x_interval, y_interval: their intervals (low, high).
    """

    context: str
    level: str
    x: float
    y: float
    x_interval: tuple[float, float]
    y_interval: tuple[float, float]


@styled
def tradeoff_figure(
    points: Sequence[TradeOffPoint],
    colours: Mapping[str, str],
    *,
    x_label: tuple[str, str],
    y_label: tuple[str, str],
    title: str = "",
) -> Figure:
    """Means of two metrics against each other; a thin line joins the cells of one context.

    Args:
        points: in the order of the legend.
        colours: by level.
        x_label: quantity and unit of the first metric.
        y_label: of the second.
        title: of the figure.

    Raises:
        ValueError: there is no point.
    """
    if not points:
        raise ValueError("trade-off: no points; pass at least one cell")
    figure = Figure(figsize=(6.6, 4.4), layout="constrained")
    axes = figure.subplots()
    quiet_grid(axes)
    contexts = list(dict.fromkeys(point.context for point in points))
    for context in contexts:
        group = [point for point in points if point.context == context]
        axes.plot(
            [p.x for p in group], [p.y for p in group], color=GREY, linewidth=0.8, alpha=0.6,
            zorder=1, label=f"context {context}",
        )  # fmt: skip
    for point in points:
        colour = colours[point.level]
        axes.plot(point.x_interval, (point.y, point.y), color=colour, linewidth=1.4, zorder=2)
        axes.plot((point.x, point.x), point.y_interval, color=colour, linewidth=1.4, zorder=2)
        axes.plot(point.x, point.y, "o", color=colour, markersize=6, zorder=3, label=point.level)
    if len(contexts) > 1:
        for (x, y), text in tags(points):
            axes.annotate(
                wrapped(text), (x, y), (5, 5), textcoords="offset points", fontsize=7,
                color="#505050", zorder=4,
            )  # fmt: skip
    axes.set_xlabel(with_unit(*x_label))
    axes.set_ylabel(with_unit(*y_label))
    axes.margins(0.08)
    levels = list(dict.fromkeys(point.level for point in points))
    handles = [
        Line2D([], [], color=colours[level], marker="o", linewidth=1.4, label=wrapped(level, 40))
        for level in levels
    ]
    figure.suptitle(title)
    figure.legend(handles=handles, loc="outside lower center", ncols=min(len(handles), 3))
    return figure


def tags(points: Sequence[TradeOffPoint]) -> list[tuple[tuple[float, float], str]]:
    """Places and names of the contexts; points close to each other share one."""
    width = max(p.x for p in points) - min(p.x for p in points)
    height = max(p.y for p in points) - min(p.y for p in points)
    found: list[tuple[TradeOffPoint, list[str]]] = []
    for point in points:
        for there, names in found:
            close = abs(point.x - there.x) <= SAME_PLACE * width
            if close and abs(point.y - there.y) <= SAME_PLACE * height:
                names.append(point.context)
                break
        else:
            found.append((point, [point.context]))
    return [((p.x, p.y), ", ".join(dict.fromkeys(names))) for p, names in found]
