"""The influence figure: the vehicle's force on a standing pedestrian."""

from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.quiver import Quiver
from numpy.typing import NDArray

from giveway.figures.style import BLACK, BLUE, keep_panels, styled
from giveway.figures.view import NOSE
from giveway.geometry.bodies import VehicleShape

Influence = Callable[[NDArray[np.float64], float], NDArray[np.float64]]
"""Function from points (k, 2) [m] and vehicle speed [m/s] to forces (k, 2) [N] on persons there."""

# Levels [N] of the filled contours
LEVELS = (1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0, 10000.0)
DRAWN = (10.0, 100.0, 1000.0)  # Levels [N] of the contours that are drawn as lines
# Force [N] of the longest arrow, about 80 kg x 5 m/s^2: the model's largest force on a person
LONGEST_ARROW = 400.0
FAINTEST_ARROW = 20.0  # Smallest force [N] that has an arrow
RESOLUTION = 0.1  # Grid width [m] of the contours
ARROW_SPACING = 0.8  # Distance [m] between arrows
SIDE_MARGIN, REAR_MARGIN, FRONT_MARGIN = 4.5, 4.0, 4.5  # Margins [m] around the vehicle
FRONT_MARGIN_PER_SPEED = 1.4  # Growth [m per m/s] of the margin in front with the speed


@styled
def influence_figure(
    influence: Influence,
    *,
    speeds: Sequence[float] = (0.0, 1.0, 2.0, 4.0),
    shape: VehicleShape | None = None,
    title: str = "Vehicle influence on a standing pedestrian",
) -> Figure:
    """Draw magnitude (contours) and direction (arrows) of f_v round the vehicle, a panel per speed.

    Figure 2 of Yang & Özgüner 2019, seen from the vehicle: x ahead of its centre, y to its left.

    In figure 2 of Yang & Özgüner 2019, x is ahead of the vehicle's centre and y to its left.
        influence: Function of the model; the vehicle's centre must be at (0, 0), its heading 0.
        speeds: Speeds of the vehicle [m/s].
        shape: Rectangle of the vehicle, or None for the paper's 5 m x 2 m.
        title: Title of the whole figure.

    Raises:
        ValueError: no speed is given.
    """
    if not speeds:
        raise ValueError("influence figure: speeds is empty; pass at least one [m/s]")
    shape = shape or VehicleShape()
    ahead = FRONT_MARGIN + FRONT_MARGIN_PER_SPEED * max(abs(speed) for speed in speeds)
    behind = ahead if min(speeds) < 0.0 else REAR_MARGIN
    x = (-shape.length / 2 - behind, shape.length / 2 + ahead)
    y = (-shape.width / 2 - SIDE_MARGIN, shape.width / 2 + SIDE_MARGIN)

    columns = min(len(speeds), 2)
    rows = -(-len(speeds) // columns)
    panel = 4.6  # width [in]
    height = 0.9 * panel * (y[1] - y[0]) / (x[1] - x[0]) + 0.4
    figure = Figure(figsize=(columns * panel + 1.1, rows * height + 0.7), layout="compressed")
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    panels = keep_panels(grid, len(speeds), x="ahead of its centre [m]", y="to its left [m]")
    for axes, speed in zip(panels, speeds, strict=True):
        contours, lines = _draw_magnitude(axes, influence, speed, x, y)
        arrows = _draw_arrows(axes, influence, speed, x, y, shape)
        _draw_vehicle(axes, shape)
        axes.set(aspect="equal", xlim=x, ylim=y, title=f"{speed:g} m/s")
    bar = figure.colorbar(contours, ax=panels, label="Magnitude [N]", shrink=0.9, aspect=30)
    bar.add_lines(lines)
    bar.set_ticks(LEVELS, labels=[f"{level:g}" for level in LEVELS])
    key = f"{LONGEST_ARROW:g} N or more"
    panels[0].quiverkey(
        arrows,
        0.97,
        0.96,
        LONGEST_ARROW,
        key,
        labelpos="W",
        coordinates="figure",
        fontproperties={"size": 8},
    )
    figure.suptitle(title)
    return figure


def _sample(
    influence: Influence, speed: float, x: NDArray[np.float64], y: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the forces (rows, columns, 2) [N] on a grid."""
    across, up = np.meshgrid(x, y)
    points = np.column_stack((across.ravel(), up.ravel()))
    return influence(points, speed).reshape(*across.shape, 2)


def _draw_magnitude(
    axes: Axes, influence: Influence, speed: float, x: tuple[float, float], y: tuple[float, float]
) -> tuple[QuadContourSet, QuadContourSet]:
    xs = np.linspace(*x, round((x[1] - x[0]) / RESOLUTION) + 1)
    ys = np.linspace(*y, round((y[1] - y[0]) / RESOLUTION) + 1)
    # A magnitude of 0 has no logarithm; a value far below the lowest level stays blank.
    magnitude = np.maximum(np.linalg.norm(_sample(influence, speed, xs, ys), axis=2), 1e-6)
    filled = axes.contourf(
        xs, ys, magnitude, levels=LEVELS, norm=LogNorm(LEVELS[0], LEVELS[-1]), cmap="YlOrBr",
        extend="max",
    )  # fmt: skip
    lines = axes.contour(xs, ys, magnitude, levels=DRAWN, colors=BLACK, linewidths=0.6)
    return filled, lines


def _draw_arrows(
    axes: Axes,
    influence: Influence,
    speed: float,
    x: tuple[float, float],
    y: tuple[float, float],
    shape: VehicleShape,
) -> Quiver:
    xs = np.arange(x[0] + ARROW_SPACING / 2, x[1], ARROW_SPACING)
    half = np.arange(ARROW_SPACING / 2, y[1], ARROW_SPACING)
    ys = np.concatenate((-half[::-1], half))  # equally far to the left and to the right
    across, up = np.meshgrid(xs, ys)
    force = _sample(influence, speed, xs, ys)
    magnitude = np.linalg.norm(force, axis=2)
    outside = (abs(across) > shape.length / 2) | (abs(up) > shape.width / 2)
    shown = outside & (magnitude >= FAINTEST_ARROW)
    arrows = force[shown] * np.minimum(1.0, LONGEST_ARROW / magnitude[shown])[:, None]
    return axes.quiver(
        across[shown], up[shown], arrows[:, 0], arrows[:, 1], color=BLUE, pivot="tail",
        angles="xy", scale_units="xy", scale=LONGEST_ARROW / (1.2 * ARROW_SPACING), width=0.003,
        minlength=0.5, zorder=3,
    )  # fmt: skip


def _draw_vehicle(axes: Axes, shape: VehicleShape) -> None:
    corner = (-shape.length / 2, -shape.width / 2)
    axes.add_patch(
        Rectangle(corner, shape.length, shape.width, facecolor="#404040", edgecolor=BLACK, zorder=4)
    )
    nose = NOSE * (shape.length, shape.width)
    axes.fill(*(nose + corner).T, color="white", zorder=5)
