"""Who is in front of the ego: the corridor about its path, now and in the predicted future.

The paper speaks of "the closest pedestrian in front" without saying who that is. Our reading (an
option): body centres ahead of the front bumper, at most ``half_width`` from the ego's path, at
that instant. Nobody in front is an infinite distance.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from giveway.ego_path import EgoPath, pose_at
from giveway.jit import kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


class Corridor:
    """The corridor about a path; its arrays are allocated once and handed out again and again."""

    def __init__(
        self,
        path: EgoPath,
        *,
        half_width: float,
        horizon: int,
        time_step: float,
        walking_speed_limit: float,
    ) -> None:
        self.path = path
        self.half_width = half_width
        self.time_step = time_step
        self._reach = walking_speed_limit * horizon * time_step  # [m] walked within the horizon
        self._ahead = np.full(horizon, np.inf)
        self._nobody = np.full(horizon, np.inf)

    @property
    def nobody(self) -> Array:
        """(N,) what :meth:`closest_predicted` gives when nobody is ever in front."""
        return self._nobody

    def closest_now(self, positions: Array, front: float) -> tuple[float, bool]:
        """Station of the closest pedestrian in front [m], and whether a prediction is needed.

        It is not when nobody can be in front within the horizon: everybody is further from the
        path than the half width plus what can be walked, or (on a straight path, where stations
        change no faster than people walk) is left behind by more than that.
        """
        path = self.path
        closest, reachable = closest_in_front(
            path.vertices, path.stations, positions, front, self.half_width, self._reach
        )
        return closest, reachable

    def closest_predicted(self, positions: Array, front: float, speed: float) -> Array:
        """(N,) stations [m] of the closest predicted pedestrian in front at steps 1 ... N.

        Args:
            positions: (N, n, 2) [m] predicted at steps 1 ... N.
            front: the front bumper's station now [m].
            speed: the ego's speed [m/s], held over the horizon as in the prediction.
        """
        path = self.path
        advance = speed * self.time_step
        closest_ahead(
            path.vertices, path.stations, positions, front, advance, self.half_width, self._ahead
        )
        return self._ahead

    def fill_poses(self, poses: Array, front: float, speed: float, front_length: float) -> None:
        """Write the ego's poses at steps 0 ... N-1 under constant speed into ``poses[:, 0]``.

        Args:
            poses: (N, m, 7) vehicles of the prediction; row 0 of each step is the ego.
            front: the front bumper's station now [m].
            speed: the ego's speed [m/s].
            front_length: from the reference point to the front bumper [m].
        """
        path = self.path
        advance = speed * self.time_step
        fill_ego_poses(
            path.vertices, path.stations, path.headings, front, advance, speed, front_length, poses
        )


@kernel
def closest_in_front(
    vertices: Array,
    stations: Array,
    positions: Array,
    front: float,
    half_width: float,
    reach: float,
) -> tuple[float, bool]:
    """Station of the closest person in front; can anybody get there by walking ``reach``?"""
    last = len(vertices) - 2
    closest = np.inf
    reachable = False
    for j in range(positions.shape[0]):
        x, y = positions[j, 0], positions[j, 1]
        beyond_before = False  # is (x, y) beyond the end of the segment before?
        for i in range(last + 1):
            # Each segment counts on its own: a path that crosses itself or turns back comes past
            # the same place twice, and only the passage ahead matters.
            x_0, y_0 = vertices[i, 0], vertices[i, 1]
            length = stations[i + 1] - stations[i]
            e_x, e_y = (vertices[i + 1, 0] - x_0) / length, (vertices[i + 1, 1] - y_0) / length
            along = (x - x_0) * e_x + (y - y_0) * e_y
            at_corner = along < 0.0 and i > 0 and beyond_before
            beside = (along >= 0.0 or i == 0) and (along <= length or i == last)
            beyond_before = along > length
            if not (beside or at_corner):
                continue
            if at_corner:
                along = 0.0
            d_x, d_y = x - (x_0 + along * e_x), y - (y_0 + along * e_y)
            distance = np.sqrt(d_x * d_x + d_y * d_y)
            station = stations[i] + along
            if distance <= half_width + reach and not (last == 0 and station + reach < front):
                reachable = True
            if front < station < closest and distance <= half_width:
                closest = station
    return closest, reachable


@kernel
def closest_ahead(
    vertices: Array,
    stations: Array,
    positions: Array,
    front: float,
    advance: float,
    half_width: float,
    closest: Array,
) -> None:
    """Fill ``closest[i]`` for the predicted ``positions[i]`` at step i + 1."""
    for i in range(positions.shape[0]):
        closest[i], _ = closest_in_front(
            vertices, stations, positions[i], front + (i + 1) * advance, half_width, 0.0
        )


@kernel
def fill_ego_poses(
    vertices: Array,
    stations: Array,
    headings: Array,
    front: float,
    advance: float,
    speed: float,
    front_length: float,
    poses: Array,
) -> None:
    """Reference point, heading and speed of the ego at steps 0 ... N-1 of a prediction."""
    for i in range(poses.shape[0]):
        x, y, heading = pose_at(vertices, stations, headings, front + i * advance)
        poses[i, 0, 0] = x - front_length * np.cos(heading)
        poses[i, 0, 1] = y - front_length * np.sin(heading)
        poses[i, 0, 2] = heading
        poses[i, 0, 3] = speed
