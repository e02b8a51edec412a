"""The motion of background vehicles in bends, along their lanes while SUMO does not step.

A car in a bend of 80 m radius that goes straight on for a second leaves its lane by more than a
metre. It would come into the way of an ego on the next lane until SUMO's next step puts it back.
"""

import numpy as np
from numpy.typing import NDArray

from giveway.cosimulation.traffic.lane_paths import Indices, LanePathPool, LanePaths
from giveway.ego.perception.corridor import fill_poses
from giveway.geometry.kernel import Array, kernel
from giveway.geometry.path import EgoPath
from giveway.sumo.background import BackgroundVehicles
from giveway.sumo.vehicles import SumoVehicles

_STRAIGHT = 0.1  # Largest lateral offset [m] of a vehicle that goes straight on
_SOON = 1.0  # Time [s] after SUMO's next step up to which bends are looked for


class Bends:
    """Follows the background vehicles whose lanes bend before them.

    Args:
        vehicles: Vehicles of the running simulation.
        time_step: Control step [s].
        substeps: Control steps per SUMO step.
        horizon: Longest prediction horizon N of any ego [steps].
    """

    def __init__(
        self, vehicles: SumoVehicles, time_step: float, substeps: int, horizon: int
    ) -> None:
        self._lane_paths = LanePaths(vehicles)
        self._soon = substeps * time_step + _SOON
        self._times: Array = time_step * np.arange(substeps + horizon, dtype=np.float64)
        self._rows: list[int] = []  # rows of the turning vehicles
        self._poses = np.empty((len(self._times), 0, 4))  # their x, y [m], heading, speed

    def read(
        self,
        background: BackgroundVehicles,
        near: NDArray[np.int64],
        looked_at: NDArray[np.bool_] | None = None,
    ) -> None:
        """Find the vehicles that turn; called after each SUMO step.

        Args:
            background: The background vehicles now.
            near: Index of each vehicle that has a row, in the order of the rows.
            looked_at: Flags (rows,) of the vehicles to be examined, or None for all.
        """
        self._rows.clear()
        reach = background.speed * self._soon
        fast = reach[near] > _STRAIGHT
        moving = np.flatnonzero(fast if looked_at is None else fast & looked_at)
        if not len(moving):
            return
        chosen = near[moving]
        names = [background.ids[i] for i in chosen]
        known = background.speed[chosen] * self._times[-1]
        numbers, positions = self._lane_paths.of(names, known.tolist())
        self._lane_paths.forget(background.ids)
        aside = sideways(
            background.heading[chosen], positions, numbers, self._lane_paths.pool, reach[chosen]
        )
        turning = np.flatnonzero(np.abs(aside) > _STRAIGHT)
        poses = np.empty((len(self._times), len(turning), 4))
        for k in turning:
            i = int(chosen[k])
            onwards = self._lane_paths.onwards(numbers[k], positions[k])
            path = self._path(background, i, onwards)
            length, speed = float(background.length[i]), float(background.speed[i])
            road = path.vertices, path.stations, path.headings
            driven: Array = speed * self._times
            speeds = np.full(len(driven), speed)
            fill_poses(road, length, driven, speeds, length, len(self._rows), poses)
            self._rows.append(int(moving[k]))
        self._poses = poses

    @staticmethod
    def _path(background: BackgroundVehicles, i: int, onwards: Array) -> EgoPath:
        """The path from the vehicle's rear over its front and along its lanes."""
        front = np.array([background.x[i], background.y[i]])
        heading, length = background.heading[i], background.length[i]
        rear = front - length * np.array([np.cos(heading), np.sin(heading)])
        return EgoPath.through([rear, front, *(onwards[1:] + (front - onwards[0]))])

    def fill(self, poses: Array, first: int, step: int) -> None:
        """Move the turning vehicles to where their lanes lead them.

        Args:
            poses: Poses (N, m, 7) of all vehicles at the steps from now on.
            first: Row of the first background vehicle.
            step: Number of control steps since SUMO's last step.
        """
        if self._rows:
            rows = first + np.array(self._rows)
            poses[:, rows, :4] = self._poses[step : step + len(poses)]


@kernel
def sideways(
    heading: Array, position: Array, number: Indices, pool: LanePathPool, reach: Array
) -> Array:
    """The lateral offsets (m,) [m] from a straight line along the lanes; 0 without a lane path.

    Args:
        heading: Heading (m,) [rad] of each vehicle.
        position: Position (m,) [m] on its first lane, in SUMO's metres.
        number: Number (m,) of its lane path, or -1 if it has none.
        pool: Pool of the lane paths.
        reach: Distance (m,) [m] that it drives.
    """
    points, along, start, first, nominal = pool
    off = np.zeros(len(number))
    for i in range(len(number)):
        w = number[i]
        if w < 0:
            continue
        begin, end = start[w], start[w + 1]
        driven = position[i] / nominal[w] * along[begin + first[w] - 1]
        k = begin
        while k < begin + first[w] - 1 and along[k + 1] <= driven:
            k += 1
        x_0, y_0 = points[k, 0], points[k, 1]
        if k + 1 < begin + first[w]:
            share = (driven - along[k]) / max(along[k + 1] - along[k], 1e-9)
            x_0 += share * (points[k + 1, 0] - x_0)
            y_0 += share * (points[k + 1, 1] - y_0)
        x, y, left = x_0, y_0, reach[i]
        d_x, d_y = np.cos(heading[i]), np.sin(heading[i])
        while left > 0.0 and k + 1 < end:
            k += 1
            step = np.hypot(points[k, 0] - x, points[k, 1] - y)
            if step > 0.0:
                d_x, d_y = (points[k, 0] - x) / step, (points[k, 1] - y) / step
            go = min(step, left)
            x, y, left = x + go * d_x, y + go * d_y, left - go
        x, y = x + left * d_x, y + left * d_y  # straight on beyond the path's end
        off[i] = np.sin(heading[i]) * (x - x_0) - np.cos(heading[i]) * (y - y_0)
    return off
