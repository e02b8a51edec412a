"""The state figure: the ego's speed, gap and force over time, and the acting controller.

It follows the state figure of Yang & Özgüner 2019 (section 5), with one column per run: there the
MPC on the left and the PID on the right.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from giveway.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY_BLUE,
    VERMILION,
    NotebookFigure,
    quiet_grid,
    styled,
)
from giveway.run_data.tracks import EgoTrack

VEHICLE: dict[str, Any] = {"color": GREY, "linewidth": 1.4, "label": "to a vehicle"}
STOP: dict[str, Any] = {"color": PURPLE, "linewidth": 1.8, "label": "to its next stop"}
STOP_LINE: dict[str, Any] = {
    "color": BLACK, "linewidth": 0.9, "linestyle": (0, (1, 2)), "label": "to a stop line",
}  # fmt: skip
WAITS = {
    "light": (VERMILION, "stands at a red light"),
    "yield": (PURPLE, "stands to yield"),
    "person": (GREEN, "stands for a person"),
    "vehicle": (GREY, "stands behind a vehicle"),
    "stop": (BLACK, "scheduled stop"),
    "plan": (SKY_BLUE, "stands, people expected"),
    "none": (ORANGE, "stands, nothing in front"),
}
# Largest closing speed [m/s] of people; a faster change is another person's gap
FASTEST_WALK = 3.0
# Largest closing speed [m/s] of vehicles; a faster change is another vehicle's gap
FASTEST_VEHICLE = 60.0
# Colour and opacity of a phase.
SHADES = {
    "mpc": (SKY_BLUE, 0.14),
    "pid": (ORANGE, 0.28),
    "plug-in": (SKY_BLUE, 0.14),
    "safety": (PURPLE, 0.40),
}
NAMES = {
    "mpc": "MPC acts",
    "pid": "PID acts",
    "plug-in": "controller acts",
    "safety": "safety layer acts",
}
DASHES = (0, (4, 2))
DOTS = (0, (1, 2))
FARTHEST_SHOWN = 40.0  # Largest distance [m] to vehicles and stops that is shown
RESOLUTION = 1e-3  # Resolution [m] of recorded distances, rounded up
SHOWN_ALWAYS = 3  # Number of panels that are always shown
SINGLE_INSTANT = 0.5  # Time [s] shown to either side of a run of one instant


@styled
def state_figure(
    runs: EgoTrack | Sequence[tuple[str, EgoTrack]],
    *,
    safe_distance: float,
    buffer_distance: float,
    stop_lines: Sequence[float] = (),
    title: str = "",
) -> Figure:
    """Draw speed, gap and force of one run, or of several side by side on the same scales.

    If there are vehicles, stops or stop lines, a further panel shows the distances to them. A bar
    above the speed shows why the ego waits.

    Args:
        runs: Track of the ego, or pairs of a label and a track.
        safe_distance: Distance d_safe [m], drawn into the gap's panel.
        buffer_distance: Distance d_buffer [m], drawn on top of it if it is not 0.
        stop_lines: Positions [m] of the front bumper, as in the track, at which lights hold it.
        title: Title of the whole figure.

    Raises:
        ValueError: there is no run, or a run without an instant.
    """
    columns = [("", runs)] if isinstance(runs, EgoTrack) else list(runs)
    if not columns or any(not ego.time.size for _, ego in columns):
        raise ValueError("state figure: a run has no instants; pass tracks of at least one")
    egos = [ego for _, ego in columns]
    far = bool(stop_lines) or any(
        np.isfinite((ego.vehicle_gap, ego.stop_gap)).any() for ego in egos
    )
    names = ["Speed [m/s]", "Gap to closest pedestrian\nin front [m]"]
    names += ["Distance\nalong the way [m]"] * far + ["Force [kN]"]
    figure = NotebookFigure(
        figsize=(4.2 + 3.8 * len(columns), 6.2 + 1.6 * far), layout="constrained"
    )
    grid = figure.subplots(len(names), len(columns), sharex=True, sharey="row", squeeze=False)
    for column, (label, ego) in enumerate(columns):
        for axes in grid[:, column]:
            shade_phases(axes, ego)
            quiet_grid(axes)
        _draw_speed(grid[0, column], ego)
        draw_gap(grid[1, column], ego, safe_distance, buffer_distance)
        if far:
            _draw_distances(grid[2, column], ego, stop_lines)
        draw_force(grid[-1, column], ego)
        grid[0, column].set_title(label)
        grid[-1, column].set_xlabel("Time [s]")
    _scale(grid, egos, safe_distance + buffer_distance)
    for column, ego in enumerate(egos):
        _draw_waits(grid[0, column], ego)
    _name_distances(grid[1, -1], safe_distance, buffer_distance)
    for axes, name in zip(grid[:, 0], names, strict=True):
        axes.set_ylabel(name)
    figure.align_ylabels(grid[:, 0])
    figure.suptitle(title)
    figure.legend(handles=_legend(egos, bool(stop_lines)), loc="outside lower center", ncols=4)
    return figure


def phases(ego: EgoTrack) -> list[tuple[str, float, float]]:
    """Return the acting controllers, with beginning and end [s] of each uninterrupted phase.

    A command holds until the next instant, so the last one is not carried out. A run of one instant
    is shown ``SINGLE_INSTANT`` to either side.
    """
    if ego.time.size == 1:
        instant = float(ego.time[0])
        return [(str(ego.controller[0]), instant - SINGLE_INSTANT, instant + SINGLE_INSTANT)]
    return [
        (name, begin, end) for name, begin, end in _stretches(ego, ego.controller) if end > begin
    ]


def _stretches(ego: EgoTrack, column: NDArray[np.str_]) -> list[tuple[str, float, float]]:
    """Return each value of a column (T,) with begin and end [s] of the time that it holds."""
    edges = np.flatnonzero(column[1:] != column[:-1]) + 1
    bounds = [0, *edges, ego.time.size - 1]
    return [(str(column[k]), float(ego.time[k]), float(ego.time[j])) for k, j in pairwise(bounds)]


def shade_phases(axes: Axes, ego: EgoTrack) -> None:
    """Colour the background by the acting controller."""
    for acting, start, end in phases(ego):
        colour, opacity = SHADES[acting]
        axes.axvspan(start, end, color=colour, alpha=opacity, linewidth=0, label=acting, zorder=0)


def _draw_speed(axes: Axes, ego: EgoTrack) -> None:
    axes.step(
        ego.time, ego.reference_speed, where="post", color=BLACK, linewidth=0.9,
        linestyle=DASHES, label="reference speed", marker=_marker(ego), markersize=9,
        markerfacecolor="none", zorder=4,
    )  # fmt: skip
    axes.plot(ego.time, ego.speed, color=BLUE, label="speed", marker=_marker(ego), zorder=3)


def draw_gap(axes: Axes, ego: EgoTrack, safe_distance: float, buffer_distance: float) -> None:
    """Draw the gap to the pedestrian in front, a line for each person, and the safe distances."""
    draw_safe_distances(axes, safe_distance, buffer_distance)
    if not np.isfinite(ego.gap).any():
        axes.text(
            0.5, 0.25, "nobody in front", transform=axes.transAxes, ha="center", color=GREY
        )  # fmt: skip
    time, gap = strokes(ego, ego.gap, FASTEST_WALK)
    axes.plot(time, gap, color=GREEN, label="gap", zorder=3)
    # A single instant is drawn as a point, since it has no line.
    around = np.concatenate(([False], np.isfinite(gap), [False]))
    alone = around[1:-1] & ~around[:-2] & ~around[2:]
    axes.plot(time[alone], gap[alone], ".", color=GREEN, markersize=4, zorder=3)


def strokes(
    ego: EgoTrack, distance: NDArray[np.float64], fastest: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return times and distances [m] to draw, separated by nan where another object comes in front.

    Args:
        ego: Ego from which the distances are measured.
        distance: Distance (T,) [m] to the object in front, or inf without one.
        fastest: Largest speed [m/s] of an object along the path.
    """
    known = np.where(np.isfinite(distance), distance, np.nan)
    elapsed = np.diff(ego.time)
    # motion of the object in front, along the path
    moved = np.diff(known) + np.diff(ego.position)
    other = np.flatnonzero(np.abs(moved) > fastest * elapsed + RESOLUTION) + 1
    return np.insert(ego.time, other, np.nan), np.insert(known, other, np.nan)


def _draw_distances(axes: Axes, ego: EgoTrack, stop_lines: Sequence[float]) -> None:
    """Draw the distances to the leader, to the stop demanded, and to stop lines."""
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    for distance, fastest, look in (
        (ego.vehicle_gap, FASTEST_VEHICLE, VEHICLE),
        (ego.stop_gap, 0.0, STOP),
    ):
        if np.isfinite(distance).any():
            axes.plot(*strokes(ego, distance, fastest), zorder=2.5, **look)
    for position in stop_lines:
        left = position - ego.position
        axes.plot(ego.time, np.where(left >= -0.5, left, np.nan), zorder=2.4, **STOP_LINE)


def waits(ego: EgoTrack) -> list[tuple[str, float, float]]:
    """Return the causes of waiting, with beginning and end [s] of each uninterrupted wait."""
    return [stretch for stretch in _stretches(ego, ego.waits_for) if stretch[0] in WAITS]


def _draw_waits(axes: Axes, ego: EgoTrack) -> None:
    """Draw a bar along the upper edge while the ego stands, in the colour of the cause."""
    for name, start, end in waits(ego):
        axes.plot(
            (start, end), (0.965, 0.965), transform=axes.get_xaxis_transform(), linewidth=5.0,
            color=WAITS[name][0], solid_capstyle="butt", label=name, zorder=3.5,
        )  # fmt: skip


def draw_safe_distances(axes: Axes, safe_distance: float, buffer_distance: float) -> None:
    """Draw lines at d_safe and, if there is a buffer, at d_safe + d_buffer."""
    axes.axhline(safe_distance, color=GREY, linewidth=0.9, linestyle=DASHES, label="d_safe")
    if buffer_distance > 0.0:
        axes.axhline(
            safe_distance + buffer_distance, color=GREY, linewidth=0.9, linestyle=DOTS,
            label="d_safe + d_buffer",
        )  # fmt: skip


def draw_force(axes: Axes, ego: EgoTrack) -> None:
    """Draw the force [kN] over time, and a line at zero."""
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.step(
        ego.time, ego.force / 1000.0, where="post", color=VERMILION, label="force",
        marker=_marker(ego), linewidth=1.2, zorder=3,
    )  # fmt: skip


def _marker(ego: EgoTrack) -> str:
    return "o" if ego.time.size == 1 else ""


def _scale(grid: NDArray[Any], egos: Sequence[EgoTrack], distance: float) -> None:
    """Set one scale for all runs that includes zero, so that heights can be compared."""
    scale_time_and_speed(grid[0, 0], egos)
    gaps = np.concatenate([ego.gap[np.isfinite(ego.gap)] for ego in egos])
    grid[1, 0].set_ylim(1.1 * gaps.min(initial=0.0), 1.1 * gaps.max(initial=distance))
    if len(grid) > SHOWN_ALWAYS:
        # A vehicle at a stop line is at 0: leave room below.
        grid[2, 0].set_ylim(-0.06 * FARTHEST_SHOWN, FARTHEST_SHOWN)
    scale_force(grid[-1, 0], egos)


def scale_force(axes: Axes, egos: Sequence[EgoTrack]) -> None:
    """Set the limits of a panel of forces, so that all runs and zero have room."""
    weakest = min(min(0.0, ego.force.min()) for ego in egos) / 1000.0
    strongest = max(max(0.0, ego.force.max()) for ego in egos) / 1000.0
    room = 0.08 * max(strongest - weakest, 0.1)
    axes.set_ylim(weakest - room, strongest + room)


def scale_time_and_speed(axes: Axes, egos: Sequence[EgoTrack]) -> None:
    """Set the limits of a panel of speeds over time, so that all runs have room."""
    start = min(float(ego.time[0]) for ego in egos)
    end = max(float(ego.time[-1]) for ego in egos)
    margin = SINGLE_INSTANT if end == start else 0.0
    fastest = max(max(ego.speed.max(), ego.reference_speed.max()) for ego in egos)
    axes.set_xlim(start - margin, end + margin)
    room = 1.2 if any(waits(ego) for ego in egos) else 1.1  # room for the bars of waits
    axes.set_ylim(0.0, room * max(fastest, 1.0))


def _name_distances(axes: Axes, safe_distance: float, buffer_distance: float) -> None:
    """Name the two lines outside the right edge, where no curve passes."""
    names = ((safe_distance, "$d_{safe}$"), (buffer_distance, "$d_{safe} + d_{buffer}$"))
    height = 0.0
    for distance, name in names if buffer_distance > 0.0 else names[:1]:
        height += distance
        axes.annotate(
            f"{name}\n= {height:g} m", xy=(1.0, height), xytext=(4, 0), va="center", fontsize=8,
            xycoords=axes.get_yaxis_transform(), textcoords="offset points", color="#505050",
            annotation_clip=False,
        )  # fmt: skip


def _legend(egos: Sequence[EgoTrack], stop_lines: bool) -> list[Artist]:
    handles: list[Artist] = [
        Line2D([], [], color=BLUE, label="speed"),
        Line2D([], [], color=BLACK, linewidth=0.9, linestyle=DASHES, label="reference speed"),
        Line2D([], [], color=GREEN, label="gap"),
        Line2D([], [], color=VERMILION, linewidth=1.2, label="force"),
    ]
    for name, look in (("vehicle_gap", VEHICLE), ("stop_gap", STOP)):
        if any(np.isfinite(getattr(ego, name)).any() for ego in egos):
            handles.append(Line2D([], [], **look))
    if stop_lines:
        handles.append(Line2D([], [], **STOP_LINE))
    stood = {name for ego in egos for name, _, _ in waits(ego)}
    handles += [
        Line2D([], [], color=colour, linewidth=5.0, solid_capstyle="butt", label=label)
        for name, (colour, label) in WAITS.items()
        if name in stood
    ]
    return [*handles, *phase_handles(egos)]


def phase_handles(egos: Sequence[EgoTrack]) -> list[Artist]:
    """Return the legend's entries for the phases that occur in the runs."""
    acted = {str(name) for ego in egos for name in np.unique(ego.controller)}
    return [
        Patch(color=colour, alpha=opacity, linewidth=0, label=NAMES[name])
        for name, (colour, opacity) in SHADES.items()
        if name in acted
    ]
