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
from numpy.typing import NDArray

from giveway.figures.conflict_points import Conflict, mark_conflicts
from giveway.figures.other_vehicles import draw_vehicles, vehicles_at
from giveway.figures.road import Road, draw_marks, draw_road, states_at
from giveway.figures.sight_view import SightView, draw_area
from giveway.figures.style import (
    BLACK,
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
SNAPSHOTS = 6
ENCOUNTER = 10.0  # Distance [m] to a pedestrian below which snapshots are taken
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
            there are six over the time in which a pedestrian is within 10 m of the ego: one at the
            closest approach, the others evenly.
        backdrop: Road, lights, other vehicles and conflicts to draw.
        title: Title of the whole figure.

    Raises:
        ValueError: the ego's track or ``times`` is empty.
    """
    if not ego.time.size:
        raise ValueError("top view: the run has no instants; pass tracks of at least one")
    closest = closest_approach(ego, crowd, shape)
    steps = _encounter(ego, crowd, closest) if times is None else _nearest_steps(ego, times)
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
    _draw_ego_trajectory(overview, ego, colours)
    mark_conflicts(overview, backdrop.conflicts)
    for k in steps:
        colour = lines.cmap(colours(ego.time[k]))
        overview.add_patch(Polygon(corners[k], fill=False, edgecolor=colour, linewidth=1.4))
    whole.apply(overview)
    overview.set(
        xlabel="x [m]",
        ylabel="y [m]",
        title="Trajectories, begun at the circles;\nthe ego at the snapshots",
    )
    figure.colorbar(lines, ax=overview, label="Time [s]", shrink=0.8, aspect=30)
    for axes, k, part in zip(panels, steps, parts, strict=True):
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
            perceived &= [backdrop.sight.perceives(crowd.ids[p], time) for p in crowd.pedestrian]
        _draw_scene(axes, k, corners[k], crowd, body_radius, perceived)
        part.apply(axes)
        told = ", closest approach" if k == closest else ""
        axes.set_title(f"t = {ego.time[k]:.2f} s{told}", fontsize=9)
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


def closest_approach(ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape) -> int | None:
    """Return the first instant of the smallest distance to a pedestrian, or None without people.

    If a person is inside the rectangle, the distance is negative.
    """
    if not crowd.x.size:
        return None
    step = crowd.step
    cos, sin = np.cos(ego.heading[step]), np.sin(ego.heading[step])
    x, y = crowd.x - ego.front_x[step], crowd.y - ego.front_y[step]
    along = np.abs(x * cos + y * sin + shape.length / 2) - shape.length / 2
    aside = np.abs(y * cos - x * sin) - shape.width / 2
    beyond = np.hypot(np.maximum(along, 0.0), np.maximum(aside, 0.0))
    return int(step[np.argmin(beyond + np.minimum(np.maximum(along, aside), 0.0))])


def _encounter(ego: EgoTrack, crowd: CrowdTrack, closest: int | None) -> NDArray[np.int64]:
    """Return instants over the encounter, with the closest approach among them.

    They are spread over the whole run if no pedestrian came close.
    """
    step = crowd.step
    apart = np.hypot(crowd.x - ego.front_x[step], crowd.y - ego.front_y[step])
    close = step[apart < ENCOUNTER]
    first, last = (close[0], close[-1]) if close.size else (0, ego.time.size - 1)
    count = min(SNAPSHOTS, int(last - first) + 1)
    steps = np.round(np.linspace(first, last, count)).astype(np.int64)
    if close.size and closest is not None and closest not in steps:
        steps[np.abs(steps - closest).argmin()] = closest
    return np.sort(steps)


def _nearest_steps(ego: EgoTrack, times: Sequence[float]) -> NDArray[np.int64]:
    if not len(times):
        raise ValueError("top view: times is empty; leave it out or give instants [s]")
    return np.array([np.abs(ego.time - time).argmin() for time in times], dtype=np.int64)


def _arrange(
    whole: Box, parts: Sequence[Box], *, side_by_side: bool
) -> tuple[Figure, Axes, list[Axes]]:
    """Arrange the views: a tall overview beside the snapshots, a flat one above them."""
    part, count = parts[0], len(parts)
    together = all(each == part for each in parts)
    columns = min(count, 2 if side_by_side or together else 3)
    rows = -(-count // columns)
    snapshots_width = 6.6 if side_by_side else 9.5  # width [in]
    snapshots_height = rows * (snapshots_width / max(columns, 2) * part.aspect + 0.3) + 0.4
    figure = NotebookFigure(layout="constrained")
    if side_by_side:
        height = min(max(snapshots_height, 4.5), 9.0)
        overview_width = max(height / whole.aspect + 1.0, 3.8)
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


def _draw_ego_trajectory(axes: Axes, ego: EgoTrack, colours: Normalize) -> None:
    """Draw the ego's trajectory in the colours of time."""
    kept = _thinned(0, ego.time.size - 1)
    front = np.column_stack((ego.front_x, ego.front_y))[kept]
    driven = LineCollection(
        list(np.stack((front[:-1], front[1:]), axis=1)), array=ego.time[kept[:-1]],
        norm=colours, cmap=TIME_COLOURS, linewidths=3.0, capstyle="round", label="ego",
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
    axes.add_patch(Polygon(corners, facecolor="#404040", edgecolor=BLACK, zorder=2, label="ego"))
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
