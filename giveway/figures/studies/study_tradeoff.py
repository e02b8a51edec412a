"""The trade-off between time and distance: one point per cell, with intervals on both axes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

from giveway.figures.studies.study_rows import wrapped
from giveway.figures.style import GREY, quiet_grid, styled
from giveway.run_data.writing import with_unit

# Distance below which two points share a label, as a share of the picture's size
SAME_PLACE = 0.05
DOT = 4.0  # Radius [pt] of a point
PLACES: tuple[tuple[tuple[float, float], str], ...] = tuple(
    ((sign * across, up), side)
    for reach in (1, 2, 4)
    for up in (5.0 * reach, -5.0 * reach - 7.0)
    for sign, side, across in ((1, "left", 5.0), (-1, "right", 5.0))
)
"""Offsets [pt] of a name from its point, and the name's alignment there, the best first."""


@dataclass(frozen=True)
class TradeOffPoint:
    """One cell.

    Attributes:
        context: Short label of the other factors' levels.
        level: Level of the compared factor.
        x, y: Means of both costs.
        x_interval, y_interval: Intervals of the means (low, high).
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
    """Draw the means of two metrics against each other.

    A thin line joins the cells of one context.

    Args:
        points: Points in the order of the legend.
        colours: Colour of each level.
        x_label: Quantity and unit of the first metric.
        y_label: Label of the second metric.
        title: Title of the figure.

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
        named = [
            axes.annotate(
                wrapped(text), place, PLACES[0][0], textcoords="offset points", fontsize=7,
                color="#505050", zorder=4,
            )
            for place, text in tags(points)
        ]  # fmt: skip
    axes.set(xlabel=with_unit(*x_label), ylabel=with_unit(*y_label))
    axes.margins(0.08)
    levels = list(dict.fromkeys(point.level for point in points))
    handles = [
        Line2D([], [], color=colours[level], marker="o", linewidth=1.4, label=wrapped(level, 40))
        for level in levels
    ]
    figure.suptitle(title)
    figure.legend(handles=handles, loc="outside lower center", ncols=min(len(handles), 3))
    if len(contexts) > 1:
        _move_apart(figure, axes, named, points)
    return figure


def _move_apart(
    figure: Figure, axes: Axes, named: Sequence[Annotation], points: Sequence[TradeOffPoint]
) -> None:
    """Put each name at the first of ``PLACES`` that is free of names, points and intervals."""
    figure.draw_without_rendering()  # after this the layout is known
    dot = figure.dpi / 72.0 * DOT
    centres = axes.transData.transform([(point.x, point.y) for point in points])
    taken = [Bbox.from_bounds(x - dot, y - dot, 2 * dot, 2 * dot) for x, y in centres]
    for point in points:
        x, y = point.x_interval, point.y_interval
        for ends in ([(x[0], point.y), (x[1], point.y)], [(point.x, y[0]), (point.x, y[1])]):
            (left, low), (right, high) = axes.transData.transform(ends)
            taken.append(Bbox.from_extents(left - 1, low - 1, right + 1, high + 1))
    frame = axes.get_window_extent()
    for name in named:
        best: tuple[float, int, Bbox] | None = None
        for number, (offset, side) in enumerate(PLACES):
            name.set(position=offset, horizontalalignment=side)
            box = name.get_window_extent()
            covered = sum(_common(box, other) for other in taken)
            outside = box.width * box.height - _common(box, frame)
            cost = covered + outside
            if best is None or cost < best[0] - 1e-6:
                best = cost, number, box
        assert best is not None
        offset, side = PLACES[best[1]]
        name.set(position=offset, horizontalalignment=side)
        taken.append(best[2])


def _common(one: Bbox, other: Bbox) -> float:
    """Return the area [px^2] that two boxes share."""
    both = Bbox.intersection(one, other)
    return 0.0 if both is None else float(both.width * both.height)


def tags(points: Sequence[TradeOffPoint]) -> list[tuple[tuple[float, float], str]]:
    """Return positions and names of the contexts.

    Points close to each other share one name.
    """
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
