"""Background vehicles in bends: where their lanes lead them while SUMO does not step.

Straight on for a second, a car in a bend of 80 m radius comes more than a metre off its lane: into
the way of an ego on the next one, until SUMO's next step puts it back.
"""

import numpy as np
from numpy.typing import NDArray

from giveway.cosimulation.lane_paths import LanePathPool, LanePaths, path_from
from giveway.ego.corridor import fill_poses
from giveway.geometry.kernel import Array, kernel
from giveway.geometry.path import EgoPath
from giveway.sumo.background import BackgroundVehicles
from giveway.sumo.vehicles import SumoVehicles

SHORT = 0.15  # [s] of SUMO's step in which no car turns: at 9 m/s^2 sideways it is 0.1 m
_STRAIGHT = 0.1  # [m] beside the straight line
_SOON = 1.0  # [s] after SUMO's next step: until then others are taken to go straight on


class Bends:
    """Follows the background vehicles whose lanes bend before them.

    Args:
        vehicles: of the running simulation.
        time_step: of the control [s].
        substeps: control steps per SUMO step.
        horizon: N, the most steps that any ego looks ahead.
    """

    def __init__(
        self, vehicles: SumoVehicles, time_step: float, substeps: int, horizon: int
    ) -> None:
        self._lane_paths = LanePaths(vehicles)
        self._soon = substeps * time_step + _SOON
        self._times: Array = time_step * np.arange(substeps + horizon, dtype=np.float64)
        self._rows: list[int] = []  # of those that turn
        self._poses = np.empty((len(self._times), 0, 4))  # theirs: x, y [m], heading, speed

    def read(self, background: BackgroundVehicles, near: NDArray[np.int64]) -> None:
        """Once after each SUMO step: find those that turn.

        Args:
            background: the background vehicles now.
            near: which of them have a row, in its order.
        """
        self._rows.clear()
        reach = background.speed * self._soon
        moving = np.flatnonzero(reach[near] > _STRAIGHT)
        chosen = near[moving]
        names = [background.ids[i] for i in chosen]
        known = background.speed[chosen] * self._times[-1]
        numbers, positions = self._lane_paths.of(names, known.tolist())
        self._lane_paths.forget(background.ids)
        turning = np.zeros(len(moving), dtype=np.bool_)
        if len(moving):
            fronts = np.column_stack([background.x[chosen], background.y[chosen]])
            pool, headings = self._lane_paths.pool, background.heading[chosen]
            fill_turning(fronts, headings, positions, numbers, pool, reach[chosen], turning)
        poses = np.empty((len(self._times), np.count_nonzero(turning), 4))
        for k in np.flatnonzero(turning):
            row, i = int(moving[k]), int(chosen[k])
            onwards = self._lane_paths.onwards(int(numbers[k]), float(positions[k]))
            path = self._path(background, i, onwards)
            length, speed = float(background.length[i]), float(background.speed[i])
            road = path.vertices, path.stations, path.headings
            driven: Array = speed * self._times
            speeds = np.full(len(driven), speed)
            fill_poses(*road, length, driven, speeds, length, len(self._rows), poses)
            self._rows.append(row)
        self._poses = poses

    @staticmethod
    def _path(background: BackgroundVehicles, i: int, onwards: Array) -> EgoPath:
        """From the vehicle's rear over its front, and on as far beside its lanes as it is now."""
        front = np.array([background.x[i], background.y[i]])
        heading, length = background.heading[i], background.length[i]
        rear = front - length * np.array([np.cos(heading), np.sin(heading)])
        return EgoPath.through([rear, front, *(onwards[1:] + (front - onwards[0]))])

    def fill(self, poses: Array, first: int, step: int) -> None:
        """Put those that turn where their lanes lead them.

        Args:
            poses: (N, m, 7) of all vehicles at the steps from now on.
            first: the row of the first background vehicle.
            step: control steps since SUMO's.
        """
        if self._rows:
            rows = first + np.array(self._rows)
            poses[:, rows, :4] = self._poses[step : step + len(poses)]


@kernel
def fill_turning(
    fronts: Array,
    headings: Array,
    positions: Array,
    numbers: NDArray[np.int64],
    pool: LanePathPool,
    reach: Array,
    turning: NDArray[np.bool_],
) -> None:
    """Fill in whose lanes lead them aside within their ``reach`` (n,) [m]."""
    longest = 2
    for i in range(len(numbers)):
        if numbers[i] >= 0:
            longest = max(longest, pool.start[numbers[i] + 1] - pool.start[numbers[i]] + 1)
    path, stations = np.empty((longest, 2)), np.empty(longest)
    for i in range(len(numbers)):
        turning[i] = False
        if numbers[i] < 0:
            continue
        count = path_from(fronts[i], positions[i], numbers[i], pool, reach[i], path, stations)
        for k in range(1, count):
            share = min(1.0, (reach[i] - stations[k - 1]) / (stations[k] - stations[k - 1]))
            if share <= 0.0:
                break
            x = path[k - 1, 0] + share * (path[k, 0] - path[k - 1, 0]) - fronts[i, 0]
            y = path[k - 1, 1] + share * (path[k, 1] - path[k - 1, 1]) - fronts[i, 1]
            if abs(np.sin(headings[i]) * x - np.cos(headings[i]) * y) > _STRAIGHT:
                turning[i] = True
                break
