"""The corridor about the ego's path: people and vehicles in front, now and in the future.

The paper does not define "the closest pedestrian in front". Here a pedestrian is in front if, at
that instant, the body centre is ahead of the front bumper and at most ``half_width`` (an option)
from the ego's path. A vehicle is in front if a part of its outline is. If nothing is in front
within the sight distance of 100 m along the path, the distance is infinite.
"""

import numpy as np
from numpy.typing import NDArray

from giveway.ego.perception.leader import (
    NOBODY_BESIDE,
    NOT_FOLLOWING,
    Followed,
    Leader,
    vehicles_in_front,
)
from giveway.geometry.kernel import Array, inner, kernel
from giveway.geometry.passage import BEHIND, SIGHT, look, window
from giveway.geometry.path import EgoPath, body_pose

#: Vertices (k + 1, 2) [m], stations (k + 1,) [m] and headings (k,) [rad] of a path.
PathArrays = tuple[Array, Array, Array]


class Corridor:
    """The corridor about a path; its arrays are allocated once and reused in every step.

    Args:
        path: Path of the ego.
        half_width: Half width of the corridor [m].
        horizon: Prediction horizon N [steps].
        time_step: Control step [s].
        walking_speed_limit: Highest speed [m/s] of pedestrians.
        body_length: Body length of the ego [m].
        straight: Number of steps for which vehicles beside the path are predicted to go straight
            on, or None for N.

    Attributes:
        followed: Closest vehicle in front that drives the same way or stands, from the last call of
            :meth:`closest_vehicle`.
    """

    def __init__(
        self,
        path: EgoPath,
        *,
        half_width: float,
        horizon: int,
        time_step: float,
        walking_speed_limit: float,
        body_length: float = 5.0,
        straight: int | None = None,
    ) -> None:
        self.path = path
        self._way = path.vertices, path.stations, path.headings
        self.half_width = half_width
        self.time_step = time_step
        self.body_length = body_length
        self._straight = horizon if straight is None else straight
        self._reach = walking_speed_limit * horizon * time_step  # longest walk [m] in the horizon
        self._ahead = np.full(horizon, np.inf)
        self._vehicles_ahead = np.full(horizon, np.inf)
        self._empty = np.full(horizon, np.inf)
        self.followed = NOT_FOLLOWING

    @property
    def empty(self) -> Array:
        """The result (N,) of :meth:`closest_predicted` if no pedestrian is in front: inf."""
        return self._empty

    def closest_now(self, positions: Array, front: float) -> tuple[float, bool]:
        """Station of the closest pedestrian in front [m], and whether a prediction is needed.

        No prediction is needed if no pedestrian can get in front within the horizon. This is the
        case if all are farther from the path than the half width plus the longest walk. On a
        straight path, where stations change no faster than pedestrians walk, it is also the case
        if they are that far behind the front.

        Args:
            positions: Positions (n, 2) [m] of pedestrians.
            front: Station of the front bumper [m].
        """
        path = self.path
        closest, reachable = closest_in_sight(
            path.vertices, path.stations, positions, front, self.half_width, self._reach
        )
        return closest, reachable

    def closest_predicted(self, positions: Array, front: float, speed: float) -> Array:
        """The stations (N,) [m] of the closest predicted pedestrian in front at steps 1 ... N.

        Args:
            positions: Predicted positions (N, n, 2) [m] at steps 1 ... N.
            front: Station of the front bumper now [m].
            speed: Speed of the ego [m/s], constant over the horizon as in the prediction.
        """
        advance, widths = speed * self.time_step, (self.half_width, self._reach)
        closest_ahead(self._way, positions, front, advance, widths, self._ahead)
        return self._ahead

    def closest_vehicle(
        self,
        poses: Array,
        own: int,
        front: float,
        speed: float,
        beside: NDArray[np.bool_] = NOBODY_BESIDE,
    ) -> tuple[Leader, Array]:
        """The closest vehicle in front now, and the stations (N,) [m] of the closest at 1 ... N.

        Args:
            poses: Poses (N, m, 7) of all vehicles at steps 0 ... N-1.
            own: Row of the ego.
            front: Station of the front bumper now [m].
            speed: Speed of the ego [m/s], constant over the horizon.
            beside: Marks (k,) of those of the last k vehicles whose lanes lead them past the path.
        """
        ahead = self._vehicles_ahead
        station, along, followed = vehicles_in_front(
            self._way,
            poses,
            own,
            (front, speed * self.time_step, self.time_step),
            (self.half_width, self._straight),
            beside,
            ahead,
        )
        self.followed = Followed(*followed)
        return Leader(station, along), ahead

    def fill_poses(self, poses: Array, row: int, front: float, speed: float) -> None:
        """Write the ego's poses at steps 0 ... N-1 under constant speed into ``poses[:, row]``.

        Args:
            poses: Poses (N, m, 7) of the predicted vehicles, changed.
            row: Row of the ego.
            front: Station of the front bumper now [m].
            speed: Speed of the ego [m/s].
        """
        advance, length = speed * self.time_step, self.body_length
        fill_steady_poses(self._way, front, advance, speed, length, row, poses)


@inner
def set_pose(path: PathArrays, station: float, speed: float, length: float, pose: Array) -> None:
    """Set a vehicle's ``pose`` (7,) to a body whose front bumper is at ``station`` [m]."""
    vertices, stations, headings = path
    x, y, heading = body_pose(vertices, stations, headings, station, length)
    pose[0] = x - 0.5 * length * np.cos(heading)
    pose[1] = y - 0.5 * length * np.sin(heading)
    pose[2] = heading
    pose[3] = speed


@kernel
def fill_steady_poses(
    path: PathArrays,
    front: float,
    advance: float,
    speed: float,
    length: float,
    row: int,
    poses: Array,
) -> None:
    """Fill as :func:`fill_poses` does, for a body that drives ``advance`` [m] in each step."""
    for i in range(poses.shape[0]):
        station = front + i * advance
        set_pose(path, station, speed, length, poses[i, row])


@kernel
def fill_poses(
    path: PathArrays,
    front: float,
    distance: Array,
    speeds: Array,
    length: float,
    row: int,
    poses: Array,
) -> None:
    """Fill ``poses[:, row]`` with a body's centre, heading and speed at steps 0 ... N-1.

    Args:
        path: Vertices [m], stations [m] and headings [rad] of the path.
        front: Station of the front bumper now [m].
        distance: Distances (N or more,) [m] driven until each step.
        speeds: Speeds (N or more,) [m/s] at each step.
        length: Length of the body [m].
        row: Row to be filled.
        poses: Poses (N, m, 7) of the vehicles.
    """
    for i in range(poses.shape[0]):
        station = front + distance[i]
        set_pose(path, station, speeds[i], length, poses[i, row])


@inner
def closest_in_front(
    vertices: Array,
    stations: Array,
    segments: tuple[int, int],
    positions: Array,
    front: float,
    half_width: float,
    reach: float,
) -> tuple[float, bool]:
    """Return the station of the closest pedestrian in front, and whether any can get there.

    Args:
        vertices: Points (k + 1, 2) [m] of the path.
        stations: Stations (k + 1,) [m] of its vertices.
        segments: The first and the last segment that count.
        positions: Positions (n, 2) [m] of the pedestrians.
        front: Station [m] of the front bumper.
        half_width: Half width [m] of the corridor.
        reach: Distance [m] that pedestrians can walk.
    """
    first, last = segments
    if first == last and reach == 0.0:
        return closest_on_segment(vertices, stations, first, positions, front, half_width), False
    closest = np.inf
    reachable = False
    low_x = high_x = vertices[first, 0]
    low_y = high_y = vertices[first, 1]
    for i in range(first + 1, last + 2):
        low_x, high_x = min(low_x, vertices[i, 0]), max(high_x, vertices[i, 0])
        low_y, high_y = min(low_y, vertices[i, 1]), max(high_y, vertices[i, 1])
    margin = half_width + reach
    if first == 0 or last == len(vertices) - 2:
        margin += SIGHT  # the path goes on straight beyond its ends
    for j in range(positions.shape[0]):
        x, y = positions[j, 0], positions[j, 1]
        if x < low_x - margin or x > high_x + margin or y < low_y - margin or y > high_y + margin:
            continue
        station, near = look(vertices, stations, (first, last), (x, y), front, half_width, reach)
        reachable |= near
        closest = min(closest, station)
    return closest, reachable


@inner
def closest_on_segment(
    vertices: Array, stations: Array, i: int, positions: Array, front: float, half_width: float
) -> float:
    """The station [m] that :func:`closest_in_front` finds on segment i of the path alone."""
    closest, last = np.inf, len(vertices) - 2
    x_0, y_0 = vertices[i, 0], vertices[i, 1]
    length = stations[i + 1] - stations[i]
    e_x, e_y = (vertices[i + 1, 0] - x_0) / length, (vertices[i + 1, 1] - y_0) / length
    for j in range(positions.shape[0]):
        x, y = positions[j, 0], positions[j, 1]
        along = (x - x_0) * e_x + (y - y_0) * e_y
        station = stations[i] + along
        if not front < station < closest:
            continue
        if (along < 0.0 and i > 0) or (along > length and i < last):
            continue
        d_x, d_y = x - (x_0 + along * e_x), y - (y_0 + along * e_y)
        if np.sqrt(d_x * d_x + d_y * d_y) <= half_width:
            closest = station
    return closest


@kernel
def closest_in_sight(
    vertices: Array,
    stations: Array,
    positions: Array,
    front: float,
    half_width: float,
    reach: float,
) -> tuple[float, bool]:
    """Search as :func:`closest_in_front` does, on the part of the path in sight."""
    segments = window(stations, front, max(BEHIND, reach))
    return closest_in_front(vertices, stations, segments, positions, front, half_width, reach)


@kernel
def closest_ahead(
    path: PathArrays,
    positions: Array,
    front: float,
    advance: float,
    widths: tuple[float, float],
    closest: Array,
) -> None:
    """Fill ``closest[i]`` for the predicted ``positions[i]`` at step i + 1.

    Args:
        path: Vertices, stations and headings of the path.
        positions: Positions (N, n, 2) [m] predicted at steps 1 ... N.
        front: Station [m] of the front bumper now.
        advance: Distance [m] that the ego drives in each step.
        widths: Half width [m] of the corridor, and the distance [m] that pedestrians can walk.
        closest: Stations (N,) [m] of the closest pedestrian in front.
    """
    (vertices, stations, _), (half_width, reach) = path, widths
    segments = window(stations, front, max(BEHIND, reach))
    for i in range(positions.shape[0]):
        at = front + (i + 1) * advance
        closest[i], _ = closest_in_front(
            vertices, stations, segments, positions[i], at, half_width, 0.0
        )
