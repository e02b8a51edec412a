"""The top view: the trajectories of ego and pedestrians, and snapshots of the encounter.

It follows the screenshots figure of Yang & Özgüner 2019 (section 5).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from giveway.figures.conflict_points import Conflict, mark_conflicts
from giveway.figures.instants import closest_approach, nearest_instants, telling_instants
from giveway.figures.other_vehicles import draw_vehicles, vehicles_at
from giveway.figures.road import Road, draw_marks, draw_road, states_at
from giveway.figures.sight_view import SightView, draw_area
from giveway.figures.style import (
    BLACK,
    BLUE,
    VERMILION,
    NotebookFigure,
    keep_panels,
    styled,
)
from giveway.figures.view import Box, nose_of
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import Pose
from giveway.metrics.groups import PedestrianGroups
from giveway.run_data.road_marks import UNMARKED, RoadMarks
from giveway.run_data.tracks import BackgroundTrack, CrowdTrack, EgoTrack, SignalTrack

TIME_COLOURS = ListedColormap(colormaps["plasma"](np.linspace(0.0, 0.61, 256)), "time")
"""Colours of time, without the last third, which is too light for a line on white."""
MARGIN = 2.0  # Margin [m] around all trajectories
SURROUNDINGS = 8.0  # Distance [m] shown around the ego's positions in the snapshots
# Longest side [m] of a shared view; on longer drives the view follows the ego
LARGEST_PART = 70.0
SIDE_BY_SIDE = 0.6  # Height over width above which the overview stands beside the snapshots
VIEW = (50.0, 32.0)  # Width and height [m] of a view that follows the ego
TICK = 1.0  # Time [s] of walking that is the length of a pedestrian's velocity tick
SEGMENTS = 150  # Largest number of segments per trajectory
# Time [s] without a record after which a trajectory begins again, since SUMO moved the person
PAUSE = 2.5
_HALO = withStroke(linewidth=2.5, foreground="white")


class Backdrop(NamedTuple):
    """The things that are drawn besides ego and crowd.

    Attributes:
        road: Areas and lines to draw underneath.
        marks: Crossings and stop lines.
        signals: States of the lights; in a snapshot, stop lines have the colour of that instant.
        background: Other vehicles, drawn in the snapshots. After their latest instant they are
            assumed to drive straight on.
        conflicts: Conflicts to mark among the trajectories.
        sight: Sight of the ego; its shadows are drawn in the snapshots, people whom it does not
            perceive hollow. None: it perceives everybody.
    """

    road: Road = ()
    marks: RoadMarks = UNMARKED
    signals: SignalTrack | None = None
    background: BackgroundTrack | None = None
    conflicts: Sequence[Conflict] = ()
    sight: SightView | None = None


NOTHING = Backdrop()


@styled
def top_view_figure(
    ego: EgoTrack,
    crowd: CrowdTrack,
    shape: VehicleShape,
    body_radius: float,
    *,
    times: Sequence[float] | None = None,
    backdrop: Backdrop = NOTHING,
    title: str = "",
) -> Figure:
    """Draw whole trajectories coloured by time, and the scene at some instants, to scale.

    Args:
        ego: Track of the ego.
        crowd: Track of the crowd; may be empty.
        shape: Rectangle of the ego.
        body_radius: Radius of a pedestrian [m].
        times: Times of the snapshots [s], each taken at the nearest control instant. With None
            there are six: the closest approach, the longest stops, and others evenly over the time
            in which a pedestrian is within 10 m of the ego.
        backdrop: Road, lights, other vehicles and conflicts to draw.
        title: Title of the whole figure.

    Raises:
        ValueError: the ego's track or ``times`` is empty.
    """
    if not ego.time.size:
        raise ValueError("top view: the run has no instants; pass tracks of at least one")
    if times is None:
        events = telling_instants(ego, crowd, closest_approach(ego, crowd, shape))
    elif len(times):
        events = nearest_instants(ego, np.asarray(times))
    else:
        raise ValueError("top view: times is empty; leave it out or give instants [s]")
    steps = list(events)
    corners = np.array([rectangle(ego, k, shape) for k in range(ego.time.size)])
    places = np.column_stack((crowd.x, crowd.y))
    whole = Box.around(np.concatenate((corners.reshape(-1, 2), places)), MARGIN)
    whole = whole.less_slender()
    part = Box.around(corners[steps].reshape(-1, 2), SURROUNDINGS)
    parts = [part] * len(steps)
    if max(part.size) > LARGEST_PART:
        parts = [Box.centred(corners[k].mean(axis=0), VIEW) for k in steps]

    side_by_side = whole.aspect > SIDE_BY_SIDE
    figure, overview, panels = _arrange(whole, parts, side_by_side=side_by_side)
    colours = _colours(ego.time)
    road = [line for line in backdrop.road if whole.touches(line)]
    draw_road(overview, road)
    draw_marks(overview, backdrop.marks, None, whole)
    lines = _draw_pedestrian_trajectories(overview, ego.time, crowd, colours)
    _draw_ego_trajectory(overview, ego)
    mark_conflicts(overview, backdrop.conflicts)
    for number, k in enumerate(steps, 1):
        overview.add_patch(Polygon(corners[k], fill=False, edgecolor=BLUE, linewidth=1.4))
        overview.annotate(
            str(number), corners[k].mean(axis=0), (0, 7), textcoords="offset points",
            ha="center", color=BLUE, weight="bold", path_effects=[_HALO],
        )  # fmt: skip
    whole.apply(overview)
    overview.set(
        xlabel="x [m]",
        ylabel="y [m]",
        title="Trajectories, begun at the circles;\nthe ego's in blue, numbers: its snapshots",
    )
    figure.colorbar(lines, ax=overview, label="Time [s]", shrink=0.8, aspect=30)
    for number, (axes, k, part) in enumerate(zip(panels, steps, parts, strict=True), 1):
        draw_road(axes, [line for line in road if part.touches(line)])
        draw_marks(axes, backdrop.marks, states_at(backdrop.signals, float(ego.time[k])), part)
        time, others = float(ego.time[k]), []
        if backdrop.background is not None:
            others = vehicles_at(time, backdrop.background)
            draw_vehicles(axes, others)
        perceived = np.ones(crowd.step.size, dtype=np.bool_)
        if backdrop.sight is not None:
            pose = Pose(float(ego.front_x[k]), float(ego.front_y[k]), float(ego.heading[k]))
            draw_area(axes, backdrop.sight.hidden(pose, others))
            for row in np.flatnonzero(crowd.step == k):
                perceived[row] = backdrop.sight.perceives(crowd.ids[crowd.pedestrian[row]], time)
        _draw_scene(axes, k, corners[k], crowd, body_radius, perceived)
        part.apply(axes)
        told = f", {events[k]}" if events[k] else ""
        axes.set_title(f"{number}: {ego.time[k]:.1f} s{told}", fontsize=10)
    figure.suptitle(title)
    if side_by_side:
        figure.draw_without_rendering()  # the layout's first pass would cut the label of x
    return figure


@styled
def crowd_view_figure(
    time: NDArray[np.float64], crowd: CrowdTrack, *, road: Road = (), title: str = ""
) -> Figure:
    """Draw the trajectories of a run without an ego, coloured by time, to scale.

    Args:
        time: Control instants (T,) [s].
        crowd: Track of the crowd.
        road: Areas and lines to draw underneath.
        title: Title of the figure.

    Raises:
        ValueError: no pedestrian was recorded.
    """
    if not crowd.x.size:
        raise ValueError("crowd view: nobody was recorded; pass a track of at least one record")
    whole = Box.around(np.column_stack((crowd.x, crowd.y)), SURROUNDINGS).less_slender()
    height = min(max(7.5 * whole.aspect, 4.0), 9.0)
    figure = NotebookFigure(
        layout="constrained", figsize=(height / whole.aspect + 1.6, height + 0.8)
    )
    axes = figure.subplots()
    draw_road(axes, [line for line in road if whole.touches(line)])
    lines = _draw_pedestrian_trajectories(axes, time, crowd, _colours(time))
    whole.apply(axes)
    axes.set(xlabel="x [m]", ylabel="y [m]", title="Trajectories, begun at the circles")
    figure.colorbar(lines, ax=axes, label="Time [s]", shrink=0.8, aspect=30)
    figure.suptitle(title)
    return figure


def _colours(time: NDArray[np.float64]) -> Normalize:
    return Normalize(time[0], max(time[-1], time[0] + 1e-9))


def rectangle(ego: EgoTrack, k: int, shape: VehicleShape) -> NDArray[np.float64]:
    """Return the ego's corners (4, 2) [m] at instant k, front left first, counter-clockwise."""
    return shape.corners(np.array((ego.front_x[k], ego.front_y[k])), float(ego.heading[k]))


def _arrange(
    whole: Box, parts: Sequence[Box], *, side_by_side: bool
) -> tuple[Figure, Axes, list[Axes]]:
    """Arrange the views: a tall overview beside the snapshots, a flat one above them."""
    part, count = parts[0], len(parts)
    together = all(each == part for each in parts)
    columns = min(count, 2 if side_by_side or together else 3)
    rows = -(-count // columns)
    snapshots_width = 5.6 if side_by_side else 7.6  # width [in]
    snapshots_height = rows * (snapshots_width / max(columns, 2) * part.aspect + 0.3) + 0.4
    figure = NotebookFigure(layout="constrained")
    if side_by_side:
        height = min(max(snapshots_height, 4.0), 7.0)
        overview_width = min(max(height / whole.aspect + 1.0, 3.4), 8.0)
        figure.set_size_inches(overview_width + snapshots_width, height + 0.4)
        left, right = figure.subfigures(
            1, 2, squeeze=False, width_ratios=(overview_width, snapshots_width)
        ).flat
    else:
        overview_height = snapshots_width * whole.aspect + 0.7
        figure.set_size_inches(snapshots_width, overview_height + snapshots_height + 0.4)
        left, right = figure.subfigures(
            2, 1, squeeze=False, height_ratios=(overview_height, snapshots_height)
        ).flat
    overview = left.subplots()
    right.suptitle(f"Snapshots; a tick is {TICK:g} s of walking", fontsize=10)
    grid = right.subplots(rows, columns, sharex=together, sharey=together, squeeze=False)
    return figure, overview, keep_panels(grid, count)


def _draw_pedestrian_trajectories(
    axes: Axes, time: NDArray[np.float64], crowd: CrowdTrack, colours: Normalize
) -> LineCollection:
    """Draw trajectories as short lines in the colours of time.

    Circles mark their beginnings.
    """
    groups = PedestrianGroups(crowd)
    places = np.column_stack((crowd.x, crowd.y))[groups.order]
    times = time[crowd.step[groups.order]]
    pauses = np.concatenate([[0], np.cumsum(np.diff(times) > PAUSE)])
    segments, ages = [np.empty((0, 2, 2))], [np.empty(0)]
    for first, last in zip(groups.first, groups.last, strict=True):
        kept = _thinned(int(first), int(last))
        known = np.diff(pauses[kept]) == 0
        segments.append(np.stack((places[kept[:-1]], places[kept[1:]]), axis=1)[known])
        ages.append(times[kept[:-1]][known])
    ends, age = np.concatenate(segments), np.concatenate(ages)
    latest_on_top = np.argsort(age, kind="stable")
    lines = LineCollection(
        list(ends[latest_on_top]), array=age[latest_on_top], norm=colours, cmap=TIME_COLOURS,
        linewidths=1.0, capstyle="round", label="pedestrians",
    )  # fmt: skip
    axes.add_collection(lines, autolim=False)
    start = places[groups.first]
    axes.scatter(start[:, 0], start[:, 1], s=6, facecolors="none", edgecolors=BLACK, linewidths=0.5)
    return lines


def _draw_ego_trajectory(axes: Axes, ego: EgoTrack) -> None:
    """Draw the ego's trajectory in the ego's colour."""
    kept = _thinned(0, ego.time.size - 1)
    front = np.column_stack((ego.front_x, ego.front_y))[kept]
    driven = LineCollection(
        list(np.stack((front[:-1], front[1:]), axis=1)), colors=BLUE, linewidths=2.5,
        capstyle="round", label="ego",
    )  # fmt: skip
    axes.add_collection(driven, autolim=False)


def _thinned(first: int, last: int) -> NDArray[np.int64]:
    """Return at most ``SEGMENTS`` + 1 of the records first to last, both ends among them."""
    count = min(last - first, SEGMENTS) + 1
    return np.round(np.linspace(first, last, count)).astype(np.int64)


def _draw_scene(
    axes: Axes,
    k: int,
    corners: Array,
    crowd: CrowdTrack,
    body_radius: float,
    perceived: NDArray[np.bool_],
) -> None:
    """Draw the ego as a rectangle with a nose, and pedestrians as circles with ticks."""
    axes.add_patch(Polygon(corners, facecolor=BLUE, edgecolor=BLACK, zorder=2, label="ego"))
    axes.fill(*nose_of(corners).T, color="white", zorder=2.5)
    here = crowd.step == k
    centre = np.column_stack((crowd.x[here], crowd.y[here]))
    ahead = centre + TICK * np.column_stack((crowd.vx[here], crowd.vy[here]))
    size = np.full(len(centre), 2.0 * body_radius)
    axes.add_collection(
        EllipseCollection(
            size, size, np.zeros(len(centre)), units="xy", offsets=centre,
            offset_transform=axes.transData, edgecolors="#8A3C00",
            facecolors=np.where(perceived[here], VERMILION, "none"),
            linewidths=0.5, zorder=4, label="pedestrians",
        ),
        autolim=False,
    )  # fmt: skip
    ticks = LineCollection(
        list(np.stack((centre, ahead), axis=1)), colors="#8A3C00", linewidths=0.7, zorder=3
    )
    axes.add_collection(ticks, autolim=False)
