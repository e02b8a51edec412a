"""The convergence of a risk: the estimate by runs, or the levels of each repeat."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from giveway.figures.style import BLACK, BLUE, GREY, SKY_BLUE, VERMILION, quiet_grid, styled

_SIZE = 5.5, 3.4  # Width and height [inch]
_LOWEST = 0.3  # Smallest drawn probability, as a share of the smallest one above 0


@dataclass(frozen=True)
class Bounds:
    """An estimate after some runs: the runs, the probability, and its interval."""

    runs: int
    probability: float
    low: float
    high: float


@styled
def convergence_figure(bounds: Sequence[Bounds], title: str) -> Figure:
    """Draw the estimate and its interval against the number of runs.

    Args:
        bounds: Estimates in the order of their runs.
        title: Title of the figure.
    """
    figure, axes = _panel(title)
    runs = [one.runs for one in bounds]
    floor = _floor([value for one in bounds for value in (one.probability, one.low, one.high)])
    axes.fill_between(
        runs,
        [max(one.low, floor) for one in bounds],
        [one.high for one in bounds],
        color=SKY_BLUE,
        alpha=0.4,
        linewidth=0.0,
        label="interval",
    )
    # an estimate of 0 has no place on a logarithmic axis
    axes.plot(runs, [one.probability or nan for one in bounds], color=BLUE, label="estimate")
    axes.set_xscale("log")
    axes.set_xlabel("runs")
    axes.set_ylabel("probability in a run")
    axes.legend(loc="upper right")
    return figure


@styled
def levels_figure(
    repeats: Sequence[Sequence[tuple[float, float]]], interval: tuple[float, float], title: str
) -> Figure:
    """Draw the probability to be beyond each level, a line for each repeat.

    Args:
        repeats: Level and probability of each stage, repeat by repeat.
        interval: Interval of the probability of the event.
        title: Title of the figure.
    """
    figure, axes = _panel(title)
    for stages in repeats:
        points = [(level, share) for level, share in stages if share > 0.0]
        axes.plot(*zip(*points, strict=True), color=BLUE, alpha=0.6, linewidth=1.0, marker=".")
    low, high = interval
    axes.axhspan(max(low, high * 1e-3), high, color=SKY_BLUE, alpha=0.4, linewidth=0.0)
    axes.axvline(0.0, color=BLACK, linewidth=0.8)
    axes.annotate(
        "event", (0.0, 1.0), xytext=(-4, 0), textcoords="offset points", ha="right", color=GREY
    )
    axes.set_xlabel("criticality")
    axes.set_ylabel("probability in a run to exceed it")
    return figure


@styled
def region_figure(
    others: NDArray[np.float64], events: NDArray[np.float64], names: tuple[str, str], title: str
) -> Figure:
    """Draw the runs with the event among the others in the plane of two inputs.

    Args:
        others: Values (n, 2) of runs without the event.
        events: Values (m, 2) of runs with it.
        names: Names of the inputs.
        title: Title of the figure.
    """
    figure, axes = _panel(title)
    axes.set_yscale("linear")
    axes.scatter(
        others[:, 0], others[:, 1], s=6.0, color=GREY, alpha=0.5, linewidth=0.0, label="no event"
    )
    axes.scatter(
        events[:, 0],
        events[:, 1],
        s=14.0,
        color=VERMILION,
        marker="x",
        linewidth=0.9,
        label="event",
    )
    axes.set_xlabel(names[0])
    axes.set_ylabel(names[1])
    axes.legend(loc="upper right")
    return figure


def _panel(title: str) -> tuple[Figure, Axes]:
    figure = Figure(figsize=_SIZE, layout="constrained")
    axes = figure.add_subplot()
    axes.set_yscale("log")
    axes.set_title(title)
    quiet_grid(axes)
    return figure, axes


def _floor(values: Sequence[float]) -> float:
    return _LOWEST * min((value for value in values if value > 0.0), default=1.0)
