"""What SUMO and our own world tell each other: poses of vehicles in, places of people out."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from giveway.errors import CrowdError, VehicleError
from giveway.jit import kernel
from pedestrian_model import Vehicles

if TYPE_CHECKING:
    from giveway.assembly import Parts
    from giveway.recorder import Recorder
    from giveway.traffic import BackgroundVehicles
    from pedestrian_model import Crowd

Array = NDArray[np.float64]

_INFLUENCE_RANGE = 10.0  # [m] from a vehicle's contour: the influence is exp(-26) of the strongest
_NOSE = 1.5  # [s] the contour's nose is no longer than this times the speed
_STANDING = 1e-6  # [m/s] below it a pedestrian keeps the angle it had


class Mirror:
    """Keeps SUMO where our world is, and our world's background vehicles where SUMO's are.

    SUMO steps once every ``substeps`` control steps; in between its vehicles go on straight at
    the speed they had.

    Attributes:
        poses: (N, 1 + b, 7) vehicles over the prediction horizon; row 0 of each step is the ego,
            which the corridor fills in; ``poses[0]`` is now.
        vehicles: a view of ``poses[0]`` for the crowd's step.
    """

    poses: Array
    vehicles: Vehicles

    def __init__(self, parts: Parts, recorder: Recorder) -> None:
        self._parts = parts
        self._recorder = recorder
        self._time_step = parts.config.time_step
        self._substeps = parts.substeps
        self._horizon = parts.horizon
        people = len(parts.spawned.ids)
        self._angles = np.zeros(people)
        self._row = np.empty(people)
        self._leaving: list[str] = []
        self._read_background(parts.crowd.position)

    def dismiss(self, arrived: NDArray[np.int64]) -> None:
        """Let pedestrians leave SUMO with its next step."""
        self._leaving += [self._parts.spawned.ids[i] for i in arrived]

    def follow(self, k: int, front: float, present: NDArray[np.int64], crowd: Crowd) -> None:
        """Bring SUMO to t_k if it has a step there, else carry its vehicles on.

        Args:
            k: the control step reached.
            front: the ego's front bumper station [m] at t_k.
            present: indices of the pedestrians in ``crowd``.
            crowd: the crowd at t_k.

        Raises:
            CrowdError, VehicleError: a value that SUMO must not be given (it hangs on them).
            SumoError: SUMO failed or disagrees.
        """
        if k % self._substeps:
            carry_on(self.poses, self._time_step)
            return
        parts = self._parts
        pose = parts.path.pose(front)
        if not all(map(math.isfinite, pose)):
            msg = f"ego at step {k}: pose {tuple(pose)}; expected finite numbers from the FMU"
            raise VehicleError(msg)
        angles = self._row[: len(present)]
        bad = walking_angles(crowd.position, crowd.velocity, present, self._angles, angles)
        if bad >= 0:
            name = parts.spawned.ids[present[bad]]
            msg = (
                f"pedestrian '{name}' at step {k}: position {crowd.position[bad].tolist()}; "
                "expected finite numbers"
            )
            raise CrowdError(msg)
        if self._leaving:
            parts.sumo.remove_persons(self._leaving)
            self._leaving.clear()
        names = parts.spawned.ids
        ids = names if len(present) == len(names) else [names[i] for i in present]
        x, y = crowd.position.T.tolist()
        parts.sumo.mirror(pose, ids, x, y, angles.tolist())
        self._read_background(crowd.position)

    def _read_background(self, people: Array) -> None:
        """Take over where SUMO's own vehicles are now."""
        background = self._parts.sumo.background_vehicles()
        if background.ids:
            self._recorder.background(self._parts.sumo.time, background)
        elif hasattr(self, "poses") and self.poses.shape[1] == 1:
            return
        ahead = self._substeps * self._time_step + self._horizon * self._time_step
        near = _near(background, people, ahead)
        count = 1 + len(near)
        if not hasattr(self, "poses") or self.poses.shape[1] != count:
            self.poses = np.zeros((self._horizon, count, 7))
            half = self._parts.shape.length / 2
            self.poses[:, :, 4:] = half, half, self._parts.shape.width
            self.vehicles = Vehicles(self.poses[0])
        if len(near):
            half_length = background.length[near] / 2
            now = self.poses[0, 1:]
            now[:, 0] = background.x[near] - half_length * np.cos(background.heading[near])
            now[:, 1] = background.y[near] - half_length * np.sin(background.heading[near])
            now[:, 2] = background.heading[near]
            now[:, 3] = background.speed[near]
            now[:, 4] = now[:, 5] = half_length
            now[:, 6] = background.width[near]
            extrapolate(self.poses, self._time_step)


def _near(vehicles: BackgroundVehicles, people: Array, ahead: float) -> NDArray[np.int64]:
    """Indices of the vehicles that can influence anybody in the crowd within ``ahead`` [s]."""
    if not len(people) or not vehicles.ids:
        return np.empty(0, dtype=np.int64)
    speed = np.abs(vehicles.speed)
    reach = _INFLUENCE_RANGE + vehicles.length + vehicles.width + (_NOSE + ahead) * speed
    low, high = people.min(axis=0), people.max(axis=0)
    inside = (vehicles.x >= low[0] - reach) & (vehicles.x <= high[0] + reach)
    inside &= (vehicles.y >= low[1] - reach) & (vehicles.y <= high[1] + reach)
    return np.flatnonzero(inside)


@kernel
def extrapolate(poses: Array, time_step: float) -> None:
    """Fill the background vehicles' poses of steps 1 ... N-1 from step 0 at constant speed."""
    for i in range(1, poses.shape[0]):
        for j in range(1, poses.shape[1]):
            distance = poses[0, j, 3] * time_step * i
            poses[i, j] = poses[0, j]
            poses[i, j, 0] += distance * np.cos(poses[0, j, 2])
            poses[i, j, 1] += distance * np.sin(poses[0, j, 2])


@kernel
def carry_on(poses: Array, time_step: float) -> None:
    """Move all background vehicles of all steps on by one time step at constant speed."""
    for i in range(poses.shape[0]):
        for j in range(1, poses.shape[1]):
            distance = poses[i, j, 3] * time_step
            poses[i, j, 0] += distance * np.cos(poses[i, j, 2])
            poses[i, j, 1] += distance * np.sin(poses[i, j, 2])


@kernel
def walking_angles(
    position: Array, velocity: Array, present: NDArray[np.int64], memory: Array, angles: Array
) -> int:
    """Fill each one's angle [deg, 0 = north, clockwise]; the first not finite state, or -1.

    ``memory`` holds the angles of all pedestrians: who stands keeps the last one.
    """
    for j in range(len(present)):
        v_x, v_y = velocity[j, 0], velocity[j, 1]
        if not np.isfinite(position[j, 0] + position[j, 1] + v_x + v_y):
            return j
        if v_x * v_x + v_y * v_y > _STANDING * _STANDING:
            memory[present[j]] = (90.0 - np.degrees(np.arctan2(v_y, v_x))) % 360.0
        angles[j] = memory[present[j]]
    return -1
