"""The travel time of an ego beside that of SUMO's own driver, who makes the same trip alone.

The trip is timed up to the ego's goal. If SUMO's vehicle ends its trip before that, both are timed
up to the place where it was last.
"""

from dataclasses import dataclass
from math import inf, nan
from typing import Annotated, NamedTuple

import numpy as np

from giveway.geometry.kernel import Array
from giveway.run_data.columns import Quantity, columns_of
from giveway.run_data.tracks import EgoTrack
from giveway.sumo.plain_drive import PlainDrive, PlainDrives

# Largest distance [m] between the end of one drive and the other drive
_SAME_PLACE = 10.0
# Difference of the distances driven up to one place: length [m], and share of the distance
_DIFFERENCE = 20.0, 0.1


@dataclass(frozen=True)
class BaselineSummary:
    """The summary's columns in a run for which plain SUMO drove as well; nan without a time."""

    sumo_time: Annotated[
        float, Quantity("s", "of SUMO's own driver for the same trip; empty: there is none")
    ]
    time_over_sumo: Annotated[float, Quantity(None, "the ego's time over SUMO's")]
    sumo_time_at_limit: Annotated[
        float, Quantity("s", "of SUMO's own driver with a speedFactor of 1; empty: there is none")
    ]
    time_over_sumo_at_limit: Annotated[
        float, Quantity(None, "the ego's time over that of this driver")
    ]


BASELINE_FIELDS = columns_of(BaselineSummary)


class Times(NamedTuple):
    """The times [s] of both drives from the departure to the same place; nan without one."""

    ego: float
    sumo: float

    @property
    def ratio(self) -> float:
        """The ego's time over SUMO's."""
        return self.ego / self.sumo if self.sumo > 0.0 else nan


def summarise_baseline(ego: EgoTrack, goal: float, plain: PlainDrives) -> BaselineSummary:
    """Return the travel times of SUMO's drivers, and the ego's over them.

    Args:
        ego: Track of the ego.
        goal: Position [m] of its goal.
        plain: Drives of plain SUMO.
    """
    as_is, at_limit = (times(ego, goal, drive) for drive in plain)
    return BaselineSummary(as_is.sumo, as_is.ratio, at_limit.sumo, at_limit.ratio)


def times(ego: EgoTrack, goal: float, plain: PlainDrive | None) -> Times:
    """Return the times [s] of both drives to the same place.

    Args:
        ego: Track of the ego.
        goal: Position [m] of its goal.
        plain: Drive of plain SUMO, or None without one.
    """
    if plain is None or plain.teleported == plain.teleported:  # a time, so it was teleported
        return Times(nan, nan)
    arrived = bool(ego.position[-1] >= goal)
    begin = max(float(plain.time[0]), float(ego.time[0]))
    own, theirs = _line(ego.front_x, ego.front_y), _line(plain.x, plain.y)
    driven = ego.position - ego.position[0]
    if arrived:
        place = _nearest(theirs, plain.position, own[-1], float(driven[-1]))
        if place < len(theirs) - 1:  # it drives on beyond the ego's goal
            return Times(_time_at_goal(ego, goal), _at(plain.time, place) - begin)
    sumo = float(plain.time[-1]) - begin
    if not plain.arrived:
        return Times(nan, nan)
    place = _nearest(own, driven, theirs[-1], float(plain.position[-1]))
    speed, left = float(plain.speed[-1]), float(driven[-1]) - _at(driven, min(place, len(own) - 1))
    if arrived and left <= speed * plain.step + 1.0:
        return Times(_time_at_goal(ego, goal), sumo + min(left / max(speed, 0.1), plain.step))
    return Times(_at(ego.time, place) - float(ego.time[0]), sumo)


def _line(x: Array, y: Array) -> Array:
    return np.column_stack([x, y])


def _nearest(line: Array, driven: Array, point: Array, distance: float) -> float:
    """Return the index, with a fraction, of a line's point nearest to ``point``, or inf.

    Args:
        line: Points (n, 2) [m] of a drive.
        driven: Distances (n,) [m] driven up to them.
        point: Point (2,) [m].
        distance: Distance [m] that another drive took to the point. Where a path passes a place
            twice, it tells which time is meant.
    """
    length, share = _DIFFERENCE
    begin, end = line[:-1], line[1:]
    along = end - begin
    squares = np.maximum((along**2).sum(axis=1), 1e-12)
    part = np.clip(((point - begin) * along).sum(axis=1) / squares, 0.0, 1.0)
    off = np.hypot(*(begin + part[:, None] * along - point).T)
    off[np.abs(driven[:-1] - distance) > length + share * distance] = inf
    if not len(off) or off.min() > _SAME_PLACE:
        return inf
    i = int(np.argmin(off))
    return i + float(part[i])


def _at(values: Array, place: float) -> float:
    """Return a column's value at an index with a fraction; nan at inf."""
    if place == inf:
        return nan
    return float(np.interp(place, np.arange(len(values)), values))


def _time_at_goal(ego: EgoTrack, goal: float) -> float:
    """Return the time [s] from the departure to the goal."""
    return float(np.interp(goal, ego.position[-2:], ego.time[-2:]) - ego.time[0])
