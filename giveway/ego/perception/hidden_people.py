"""The places where people who are not seen could come out onto an ego's way.

Across the path ahead, on each side, the nearest place is sought where a child could stand unseen
and from where nothing bars the way to the path. People who are hidden farther away have to come by
such a place, or by a visible one.
"""

from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from controller.driving_constants import COMFORTABLE
from giveway.ego.perception.path_ahead import PathView
from giveway.ego.perception.truth import Truth
from giveway.ego.perception.visibility import walls_of
from giveway.geometry.kernel import Array, kernel
from giveway.geometry.path import EgoPath

# Distance [m] between stations, up to a distance [m]; the nearer, the steeper lines of sight are.
# In the end there is time to look again.
_SPACINGS = (0.05, 4.0), (0.125, 6.0), (0.5, np.inf)
_ACROSS = 0.25  # distance [m] between places across the path, and
_HALVINGS = 3  # how many times it is halved where the first hidden place is sought
_ASIDE = 5.0  # distance [m] from the path beyond which nobody hidden matters
_MORE = 3.0  # distance [m] beyond a comfortable stop that is looked at
_OFFSETS = np.arange(0.0, _ASIDE, _ACROSS)
ERROR = 0.1
"""Largest distance [m] by which a person who is hidden within 3.5 m of the path is nearer than the
places that are found about there: that by which a line of sight comes nearer between two stations,
and half of the last halving."""


class Hidden(NamedTuple):
    """The places (h,) where people could come out of hiding.

    Attributes:
        position: Coordinates (h, 2) [m].
        station: Stations (h,) [m] along the path of the ego.
        aside: Distances (h,) [m] from the middle of the path.
        error: Largest distance [m] by which a person who is not seen is nearer.
    """

    position: Array
    station: Array
    aside: Array
    error: float = 0.0


NOWHERE = Hidden(np.empty((0, 2)), np.empty(0), np.empty(0))


@runtime_checkable
class TellsUnseen(Protocol):
    """A sensor that tells where people would not be in sight."""

    @property
    def delay(self) -> float:
        """The time [s] by which its answers are late."""

    def unseen(self, points: Array) -> NDArray[np.bool_]:
        """Return which points (k, 2) [m] are not in sight."""


class HidingPlaces:
    """Finds the hiding places along the path of one ego.

    Args:
        path: Path of the ego.
        pace: Speed [m/s] of people who come out of hiding.
    """

    def __init__(self, path: EgoPath, pace: float) -> None:
        self._view, self._pace = PathView(path), pace

    def ahead(
        self, sensor: TellsUnseen, truth: Truth, row: int, front: float, speed: float
    ) -> Hidden:
        """Return the hiding places within the distance of a comfortable stop.

        Args:
            sensor: Sensor, which has just observed the truth.
            truth: World as it is, for what bars people's way.
            row: Row of the ego among the vehicles of the truth.
            front: Station of the front bumper [m].
            speed: Speed of the ego [m/s].
        """
        reach = 0.5 * speed * speed / COMFORTABLE + _MORE
        distances = _stations(reach)
        self._view.station = front
        poses = self._view.poses(distances)
        others = np.delete(truth.vehicles, row, axis=0)
        walls, _ = walls_of(truth.outlines, truth.vehicles, _flat(truth), row)
        free = np.empty((len(poses), 2))
        count = fill_free(poses, walls, others, free)
        poses, free, distances = poses[:count], free[:count], distances[:count]
        # (station, side, offset): places that can be reached from the path
        sides = np.array([1.0, -1.0])
        aside = sides[None, :, None] * _OFFSETS
        open_way = free[:, :, None] > _OFFSETS
        at, side, step = np.nonzero(open_way)
        marks = np.zeros(open_way.shape, dtype=np.bool_)
        marks[at, side, step] = sensor.unseen(_places(poses[at], aside[0, side, step]))
        at, side = np.nonzero(marks.any(axis=2))
        if not len(at):
            return NOWHERE
        far = _OFFSETS[marks.argmax(axis=2)[at, side]]
        near = np.maximum(far - _ACROSS, 0.0)
        for _ in range(_HALVINGS):
            middle = 0.5 * (near + far)
            hides = sensor.unseen(_places(poses[at], sides[side] * middle))
            near, far = np.where(hides, near, middle), np.where(hides, middle, far)
        nearest = 0.5 * (near + far)
        places = _places(poses[at], sides[side] * nearest)
        error = ERROR + self._pace * sensor.delay
        return Hidden(places, front + distances[at], nearest, error)


def _stations(reach: float) -> Array:
    """Return the distances [m] ahead that are looked at."""
    begin, parts = 0.0, []
    for spacing, end in _SPACINGS:
        parts.append(np.arange(begin, min(reach, end), spacing))
        begin = end
    return np.concatenate(parts)


def _flat(truth: Truth) -> Array:
    return np.zeros(len(truth.vehicles))


def _places(poses: Array, aside: Array) -> Array:
    """Return the points (k, 2) ``aside`` (k,) [m] to the left of poses (k, 3)."""
    x, y, heading = poses.T
    return np.column_stack([x - aside * np.sin(heading), y + aside * np.cos(heading)])


@kernel
def fill_free(poses: Array, walls: Array, vehicles: Array, free: Array) -> int:
    """Fill in how far nothing bars the way from the path to its left and right.

    Args:
        poses: Poses (s, 3) along the path: x, y [m], heading [rad].
        walls: Walls (k, 5): x0, y0, x1, y1 [m].
        vehicles: Poses (m, 7) of the vehicles.
        free: Distances (s, 2) [m] to the left and right; overwritten.

    Returns:
        Number of poses before the first that is inside a vehicle.
    """
    for i in range(poses.shape[0]):
        x, y, cos, sin = poses[i, 0], poses[i, 1], np.cos(poses[i, 2]), np.sin(poses[i, 2])
        for j in range(vehicles.shape[0]):
            d_x, d_y = x - vehicles[j, 0], y - vehicles[j, 1]
            c, s = np.cos(vehicles[j, 2]), np.sin(vehicles[j, 2])
            along, across = d_x * c + d_y * s, d_y * c - d_x * s
            if -vehicles[j, 5] <= along <= vehicles[j, 4] and abs(across) <= vehicles[j, 6] / 2.0:
                return i
        free[i, 0] = free[i, 1] = np.inf
        for k in range(walls.shape[0]):
            a_x, a_y, b_x, b_y = walls[k, 0] - x, walls[k, 1] - y, walls[k, 2] - x, walls[k, 3] - y
            along_a, along_b = a_x * cos + a_y * sin, b_x * cos + b_y * sin
            if (along_a < 0.0) == (along_b < 0.0):
                continue
            share = along_a / (along_a - along_b)
            across_a, across_b = a_y * cos - a_x * sin, b_y * cos - b_x * sin
            across = across_a + share * (across_b - across_a)
            if across >= 0.0:
                free[i, 0] = min(free[i, 0], across)
            else:
                free[i, 1] = min(free[i, 1], -across)
    return len(poses)
