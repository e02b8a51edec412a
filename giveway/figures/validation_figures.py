"""The pictures of a validation: growth of the error, predicted tracks, places of errors."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.transforms import Affine2D

from giveway.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LIGHT_GREY,
    ORANGE,
    PURPLE,
    SKY_BLUE,
    VERMILION,
    quiet_grid,
    styled,
)
from giveway.geometry.kernel import Array

_LOOKS: dict[str, tuple[str, Any]] = {  # Label and colour of each predictor in every picture
    "VCI": (BLUE, "-"),
    "VCI at own pace": (SKY_BLUE, "--"),
    "VCI without f_v": (PURPLE, "-."),
    "CV": (VERMILION, ":"),
    "goalCV": (GREEN, (0, (5, 1))),
}
_OTHER: tuple[str, Any] = (ORANGE, (0, (1, 1)))
_REACH = 8.0  # Distance [m] shown around the vehicle
_CELL = 1.0  # Cell size [m]
_FEWEST = 3  # Smallest number of errors in a cell that is coloured


@dataclass(frozen=True, eq=False)
class Curve:
    """A mean error over time with its interval, (H,) [m] each."""

    mean: Array
    low: Array
    high: Array


@dataclass(frozen=True, eq=False)
class Body:
    """The pose of a vehicle: x, y [m], heading [rad], and its size around that point [m]."""

    x: float
    y: float
    heading: float
    front: float
    rear: float
    width: float

    def patch(self, axes: Axes, **looks: Any) -> Rectangle:
        """Return the outline as a patch."""
        turned = Affine2D().rotate(self.heading).translate(self.x, self.y)
        outline = Rectangle(
            (-self.rear, -self.width / 2), self.front + self.rear, self.width, **looks
        )
        outline.set_transform(turned + axes.transData)
        return outline


@styled
def growth_figure(time: Array, panels: Mapping[str, Mapping[str, Curve]], title: str) -> Figure:
    """Draw the displacement error over the horizon, one panel per group of pedestrians.

    Args:
        time: Prediction times ahead (H,) [s].
        panels: Curves of each panel, one per predictor.
        title: Title of the whole figure.
    """
    figure = Figure(figsize=(4.2 * len(panels), 3.6), layout="constrained")
    grid = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for axes, (group, curves) in zip(grid, panels.items(), strict=True):
        for name, curve in curves.items():
            colour, line = _LOOKS.get(name, _OTHER)
            axes.fill_between(time, curve.low, curve.high, color=colour, alpha=0.12, linewidth=0)
            axes.plot(time, curve.mean, color=colour, linestyle=line, label=name)
        axes.set(title=group, xlabel="time ahead [s]", xlim=(0.0, time[-1]))
        quiet_grid(axes)
    grid[0].set(ylim=(0.0, None), ylabel="mean displacement error [m]")
    grid[0].legend(loc="upper left")
    figure.suptitle(title)
    return figure


@styled
def tracks_figure(
    observed: Array, predicted: Mapping[str, Array], vehicle: Sequence[Body], title: str
) -> Figure:
    """Draw the predicted and the observed tracks of one window.

    Args:
        observed: Observed positions (H + 1, n, 2) [m], from the start on.
        predicted: Predicted positions of each predictor, in the same shape.
        vehicle: Poses of the vehicle at the start, on the way and at the end; may be empty.
        title: Title of the figure.
    """
    figure = Figure(figsize=(6.4, 5.4), layout="constrained")
    axes = figure.subplots()
    for number, body in enumerate(vehicle):
        shade = 0.25 + 0.5 * number / max(len(vehicle) - 1, 1)
        axes.add_patch(body.patch(axes, facecolor=LIGHT_GREY, edgecolor=GREY, alpha=shade))
    axes.plot(observed[:, :, 0], observed[:, :, 1], color=BLACK, linewidth=2.0, alpha=0.8)
    axes.plot(observed[0, :, 0], observed[0, :, 1], "o", color=BLACK, markersize=4)
    handles = [Line2D([], [], color=BLACK, linewidth=2.0, label="observed")]
    for name, tracks in predicted.items():
        colour, line = _LOOKS.get(name, _OTHER)
        axes.plot(tracks[:, :, 0], tracks[:, :, 1], color=colour, linestyle=line, linewidth=1.2)
        axes.plot(tracks[-1, :, 0], tracks[-1, :, 1], "x", color=colour, markersize=4)
        handles.append(Line2D([], [], color=colour, linestyle=line, label=name))
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="x [m]", ylabel="y [m]")
    quiet_grid(axes)
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    figure.suptitle(title)
    return figure


@styled
def places_figure(place: Array, errors: Mapping[str, Array], body: Body, title: str) -> Figure:
    """Draw the mean final error by the pedestrian's place, seen from the vehicle.

    Args:
        place: Place (R, 2) [m] ahead and to the left of the vehicle, or nan without a vehicle.
        errors: Errors (R,) [m] by predictor, or nan without an error.
        body: Body of the vehicle at the origin.
        title: Title of the whole figure.
    """
    edges = np.arange(-_REACH, _REACH + _CELL / 2, _CELL)
    means = {name: _cell_means(place, values, edges) for name, values in errors.items()}
    known = [float(np.nanmax(m)) for m in means.values() if not np.isnan(m).all()]
    worst = max(known, default=1.0)
    figure = Figure(figsize=(3.2 * len(errors) + 0.8, 3.8), layout="constrained")
    grid = figure.subplots(1, len(errors), sharex=True, sharey=True, squeeze=False)[0]
    for axes, (name, mean) in zip(grid, means.items(), strict=True):
        shown = axes.pcolormesh(
            edges, edges, mean.T, cmap="viridis_r", vmin=0.0, vmax=math.ceil(worst * 10.0) / 10.0
        )
        axes.add_patch(body.patch(axes, facecolor="white", edgecolor=BLACK, zorder=3))
        axes.set(title=name, aspect="equal", xlabel="ahead of the vehicle [m]")
    grid[0].set_ylabel("to its left [m]")
    figure.colorbar(shown, ax=list(grid), label="mean final error [m]", shrink=0.8)
    figure.suptitle(title)
    return figure


def _cell_means(place: Array, values: Array, edges: Array) -> Array:
    """Return the mean of ``values`` in each cell, (k, k), and nan for too few values."""
    good = ~(np.isnan(place).any(axis=1) | np.isnan(values))
    x, y = place[good].T
    count, _, _ = np.histogram2d(x, y, [edges, edges])
    total, _, _ = np.histogram2d(x, y, [edges, edges], weights=values[good])
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(count >= _FEWEST, total / count, np.nan)
