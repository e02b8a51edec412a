"""A pair of runs on the same crowd: speed, gap and force, treatment and baseline side by side.

It follows figure 5 of Yang & Özgüner 2019 (MPC on the left, PID on the right).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from giveway.figures.state import (
    DASHES,
    DOTS,
    draw_force,
    draw_gap,
    phase_handles,
    scale_force,
    scale_time_and_speed,
    shade_phases,
)
from giveway.figures.studies.study_rows import wrapped
from giveway.figures.style import BLACK, BLUE, GREEN, GREY, VERMILION, quiet_grid, styled
from giveway.run_data.tracks import EgoTrack


@dataclass(frozen=True)
class PairSide:
    """One run of a pair.

    Attributes:
        label: Label of the compared level.
        ego: Track of the ego.
        safe_distance: Safe distance d_safe [m] of its controller.
        buffer_distance: Distance d_buffer [m] beyond it, or 0 without one.
    """

    label: str
    ego: EgoTrack
    safe_distance: float
    buffer_distance: float


@styled
def pair_figure(sides: Sequence[PairSide], *, title: str = "") -> Figure:
    """Draw speed and its reference, gap and d_safe, force and acting controller, on equal scales.

    Args:
        sides: Runs, normally two, the treatment first.
        title: Title of the whole figure.

    Raises:
        ValueError: there is no side, or one without an instant.
    """
    if not sides or any(not side.ego.time.size for side in sides):
        raise ValueError("pair: a run has no instants; pass tracks of at least one")
    figure = Figure(figsize=(0.6 + 4.4 * len(sides), 6.0), layout="constrained")
    grid = figure.subplots(3, len(sides), sharex=True, sharey="row", squeeze=False)
    for (speed, gap, force), side in zip(grid.T, sides, strict=True):
        for axes in (speed, gap, force):
            quiet_grid(axes)
            shade_phases(axes, side.ego)
        _draw_speed(speed, side.ego)
        draw_gap(gap, side.ego, side.safe_distance, side.buffer_distance)
        draw_force(force, side.ego)
        speed.set_title(wrapped(side.label, 50))
        force.set_xlabel("Time [s]")
    grid[0, 0].set_ylabel("Speed [m/s]")
    grid[1, 0].set_ylabel("Gap in front [m]")
    grid[2, 0].set_ylabel("Force [kN]")
    _scale(grid, sides)
    figure.align_ylabels(grid[:, 0])
    figure.suptitle(wrapped(title, 100))
    figure.legend(handles=_legend(sides), loc="outside lower center", ncols=4)
    return figure


def _draw_speed(axes: Axes, ego: EgoTrack) -> None:
    axes.step(
        ego.time, ego.reference_speed, where="post", color=BLACK, linewidth=0.9, linestyle=DASHES,
        label="reference speed", zorder=3,
    )  # fmt: skip
    axes.plot(ego.time, ego.speed, color=BLUE, label="speed", zorder=4)


def _scale(grid: np.ndarray, sides: Sequence[PairSide]) -> None:
    """Set one scale for both runs that includes zero."""
    egos = [side.ego for side in sides]
    scale_time_and_speed(grid[0, 0], egos)
    scale_force(grid[2, 0], egos)
    gaps = np.concatenate([e.gap[np.isfinite(e.gap)] for e in egos])
    farthest = max(side.safe_distance + side.buffer_distance for side in sides)
    grid[1, 0].set_ylim(1.1 * gaps.min(initial=0.0), 1.1 * gaps.max(initial=farthest))


def _legend(sides: Sequence[PairSide]) -> list[Artist]:
    handles: list[Artist] = [
        Line2D([], [], color=BLUE, label="speed"),
        Line2D([], [], color=BLACK, linewidth=0.9, linestyle=DASHES, label="reference speed"),
        Line2D([], [], color=GREEN, label="gap"),
        Line2D([], [], color=VERMILION, linewidth=1.2, label="force"),
        Line2D([], [], color=GREY, linewidth=0.9, linestyle=DASHES, label="d_safe"),
    ]
    if any(side.buffer_distance > 0.0 for side in sides):
        name = "d_safe + d_buffer"
        handles.append(Line2D([], [], color=GREY, linewidth=0.9, linestyle=DOTS, label=name))
    return [*handles, *phase_handles([side.ego for side in sides])]
