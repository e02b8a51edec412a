"""Histograms of paired differences, three per context (Yang & Özgüner 2019, section 5).

A picture has a row per context and a column per situation. Bars on the side where the treatment is
better are blue, those on the other side orange. Pairs without a difference are at zero, in grey.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator, NullLocator
from numpy.typing import NDArray

from giveway.figures.studies.study_rows import PUBLISHED, wrapped
from giveway.figures.style import BLACK, BLUE, GREY, ORANGE, quiet_grid, styled
from giveway.run_data.writing import digits_for, number, pretty_unit

BINS = 48
TAIL = 2.5  # Share [%] of the differences at either end that may be outside of the picture
SPIKE = 30.0  # Height of a bin over the median height at which it would hide the others
EQUAL = 5e-7  # Differences below this are 0: tables have six decimals
DASHES = (0, (4, 2))


@dataclass(frozen=True)
class Differences:
    """The content of one panel.

    Attributes:
        values: Treatment minus baseline (n,), one per pair.
        share: Share of all pairs of the context, or nan if not known.
        mean: Mean of the values, or nan if it is not reported (N.A.).
        low, high: Ends of the interval of the mean.
        published: Mean in the literature, or None.
    """

    values: NDArray[np.float64]
    share: float
    mean: float
    low: float
    high: float
    published: float | None = None


@dataclass(frozen=True)
class DifferenceColumn:
    """The content of a column of panels: a situation, and one of its quantities."""

    title: str
    quantity: str
    unit: str
    better: str = "lower"


@styled
def differences_figure(
    columns: Sequence[DifferenceColumn],
    rows: Sequence[tuple[str, Sequence[Differences]]],
    *,
    title: str = "",
    source: str = "published",
) -> Figure:
    """Draw histograms of paired differences, one row of panels per context.

    Args:
        columns: Situation of each column.
        rows: Label of a context, and its panels in the order of the columns.
        title: Title of the whole figure.
        source: Source of the published means, for the legend.

    Raises:
        ValueError: there is no row.
    """
    if not rows:
        raise ValueError("differences: no rows; pass at least one context")
    height = 1.35 * len(rows) + 1.35
    figure = Figure(figsize=(3.15 * len(columns) + 0.3, height), layout="constrained")
    grid = figure.subplots(len(rows), len(columns), sharex="col", squeeze=False)
    logarithmic = any(
        _has_a_spike(panel, bin_edges([panels[place] for _, panels in rows]))
        for _, panels_of_row in rows
        for place, panel in enumerate(panels_of_row)
    )
    for place, column in enumerate(columns):
        panels = [panels[place] for _, panels in rows]
        edges = bin_edges(panels)
        for axes, panel in zip(grid[:, place], panels, strict=True):
            _draw(axes, panel, column, edges, logarithmic=logarithmic)
        grid[0, place].annotate(
            column.title, (0.0, 1.0), (0, 20), xycoords="axes fraction",
            textcoords="offset points", fontsize=10, fontweight="bold",
        )  # fmt: skip
        grid[-1, place].set_xlabel(f"Difference of {column.quantity} [{pretty_unit(column.unit)}]")
        grid[0, place].set_xlim(edges[0], edges[-1])
    for axes, (label, _) in zip(grid[:, 0], rows, strict=True):
        axes.set_ylabel(wrapped(label or "pairs", 18))
    figure.align_ylabels(grid[:, 0])
    figure.suptitle(wrapped(title, 80))
    handles = _legend([panel for _, panels in rows for panel in panels], source)
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def bin_edges(panels: Sequence[Differences]) -> NDArray[np.float64]:
    """Return equal bins for all panels of a column, with an edge at zero; tails may be beyond."""
    spans = [np.percentile(p.values, (TAIL, 100.0 - TAIL)) for p in panels if p.values.size]
    extra = [p.published for p in panels if p.published is not None]
    extra += [value for p in panels for value in (p.low, p.high) if math.isfinite(value)]
    low = min([0.0, *(float(span[0]) for span in spans), *extra])
    high = max([0.0, *(float(span[1]) for span in spans), *extra])
    if high - low < 1e-9:
        low, high = -1.0, 1.0
    width = _round_up((high - low) / BINS)
    first, last = math.floor(low / width) - 1, math.ceil(high / width) + 1
    return np.asarray(width * np.arange(first, last + 1), dtype=np.float64)


def _round_up(width: float) -> float:
    """Return the next of 1, 2, 2.5, 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(width))
    return power * next(step for step in (1.0, 2.0, 2.5, 5.0, 10.0) if step * power >= width)


def _has_a_spike(panel: Differences, edges: NDArray[np.float64]) -> bool:
    """Return whether one bin would hide all others.

    Most pairs may hardly differ while a few differ by much, and those make the mean.
    """
    counts, _ = np.histogram(panel.values, edges)
    filled = counts[counts > 0]
    return bool(filled.size and filled.max() > SPIKE * np.median(filled))


def _draw(
    axes: Axes,
    panel: Differences,
    column: DifferenceColumn,
    edges: NDArray[np.float64],
    *,
    logarithmic: bool,
) -> None:
    quiet_grid(axes)
    axes.grid(visible=False, axis="x")
    axes.set_title(_numbers(panel, column.unit), fontsize=7.5, loc="left", color="#505050", pad=3)
    if not panel.values.size:
        axes.text(
            0.5, 0.5, "no such pair", transform=axes.transAxes, ha="center", va="center", color=GREY
        )  # fmt: skip
        axes.set_yticks([])
        axes.axvline(0.0, color=GREY, linewidth=0.8)
        return
    equal = np.abs(panel.values) < EQUAL
    counts, _ = np.histogram(panel.values[~equal], edges)
    centres = (edges[:-1] + edges[1:]) / 2
    good, bad = (
        (centres < 0, centres > 0) if column.better == "lower" else (centres > 0, centres < 0)
    )
    for side, colour in ((good, BLUE), (bad, ORANGE)):
        axes.bar(
            centres[side], counts[side], width=0.9 * np.diff(edges)[side], color=colour, alpha=0.75,
            linewidth=0,
        )  # fmt: skip
    if equal.any():
        axes.bar(0.0, equal.sum(), width=0.8 * np.diff(edges)[0], color=GREY, linewidth=0)
    axes.axvline(0.0, color=BLACK, linewidth=0.8, label="zero")
    if math.isfinite(panel.low) and math.isfinite(panel.high):
        axes.axvspan(
            panel.low, panel.high, color=BLACK, alpha=0.18, linewidth=0, label="interval"
        )  # fmt: skip
    if math.isfinite(panel.mean):
        axes.axvline(panel.mean, color=BLACK, linewidth=1.6, label="mean")
    if panel.published is not None:
        axes.axvline(
            panel.published, color=PUBLISHED, linewidth=1.6, linestyle=DASHES, label="published"
        )  # fmt: skip
    _count_axis(axes, np.append(counts, equal.sum()), logarithmic=logarithmic)
    _count_beyond(axes, panel.values, edges)


def _count_axis(axes: Axes, counts: NDArray[np.intp], *, logarithmic: bool) -> None:
    """Set the axis of counts, from zero on."""
    highest = max(float(counts.max()), 1.0)
    if logarithmic:
        axes.set_yscale("symlog", linthresh=1.0, linscale=0.5)
        axes.set_ylim(0.0, 2.0 * highest)
        ticks = [0, *(10**power for power in range(math.floor(math.log10(highest)) + 1))]
        axes.set_yticks(ticks, labels=[f"{tick}" for tick in ticks])
        axes.yaxis.set_minor_locator(NullLocator())
        return
    axes.set_ylim(0.0, 1.12 * highest)
    axes.yaxis.set_major_locator(MaxNLocator(3, integer=True))


def _numbers(panel: Differences, unit: str) -> str:
    share = f" ({100.0 * panel.share:.0f} %)" if math.isfinite(panel.share) else ""
    counted = f"n = {panel.values.size}{share}"
    if not panel.values.size:
        return ""
    if not math.isfinite(panel.mean):
        return f"{counted}: N.A."
    digits = digits_for(panel.high - panel.low)
    interval = ", ".join(number(value, digits) for value in (panel.low, panel.high))
    return f"{counted}: {number(panel.mean, digits)} [{interval}] {pretty_unit(unit)}"


def _count_beyond(axes: Axes, values: NDArray[np.float64], edges: NDArray[np.float64]) -> None:
    """Write the number of pairs beyond the axis, at the side where they are."""
    for count, x, text, align in (
        (int((values < edges[0]).sum()), 0.01, "‹ {}", "left"),
        (int((values > edges[-1]).sum()), 0.99, "{} ›", "right"),
    ):
        if count:
            axes.text(
                x, 0.6, text.format(count), transform=axes.transAxes, ha=align, va="top",
                fontsize=8, color="#505050",
            )  # fmt: skip


def _legend(panels: Sequence[Differences], source: str) -> list[Artist]:
    handles: list[Artist] = [
        Patch(color=BLUE, alpha=0.75, linewidth=0, label="treatment better"),
        Patch(color=ORANGE, alpha=0.75, linewidth=0, label="baseline better"),
        Line2D([], [], color=BLACK, linewidth=0.8, label="zero"),
    ]
    if any((np.abs(panel.values) < EQUAL).any() for panel in panels):
        handles.insert(2, Patch(color=GREY, linewidth=0, label="no difference"))
    if any(math.isfinite(panel.mean) for panel in panels):
        handles.append(Line2D([], [], color=BLACK, linewidth=1.6, label="mean"))
        handles.append(Patch(color=BLACK, alpha=0.18, linewidth=0, label="its interval"))
    if any(panel.published is not None for panel in panels):
        look: dict[str, Any] = {"color": PUBLISHED, "linewidth": 1.6, "linestyle": DASHES}
        handles.append(Line2D([], [], label=f"{source}: mean", **look))
    return handles
