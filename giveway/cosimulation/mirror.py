"""The exchange with SUMO: poses of background vehicles in, positions of pedestrians out."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from giveway.cosimulation.traffic.bends import Bends
from giveway.cosimulation.traffic.slowing import Slowing, slow_down
from giveway.crowd.roster import Roster
from giveway.ego.ego import Ego
from giveway.errors import CrowdError, VehicleError
from giveway.geometry.kernel import Array, kernel
from giveway.geometry.passage import SIGHT
from giveway.geometry.path import angle_of_velocity
from giveway.sumo.background import NO_VEHICLES, BackgroundVehicles
from giveway.sumo.session import SumoSession
from pedestrian_model import Vehicles

# Distance [m] from a vehicle's contour at which its influence is exp(-26) of the strongest
_INFLUENCE_RANGE = 10.0
_NOSE = 1.5  # Longest time [s] for the contour's nose, as nose length divided by speed
_SHORT = 0.15  # Step [s] of SUMO in which no car turns noticeably: 0.1 m sideways at 9 m/s^2
_MEET = 1.5  # Time [s] within which a vehicle beside an ego's path may come into it
_BODIES = 15.0  # Allowance [m] for the lengths of the two vehicles
_NONE = np.empty(0, dtype=np.int64)
_NO_NEWS = np.empty(0)
_STANDING = 1e-6  # Speed [m/s] below which a pedestrian keeps the last angle


class Mirror:
    """Keeps SUMO's persons and egos at giveway's positions, and reads SUMO's background vehicles.

    SUMO steps once every ``substeps`` control steps. In between, background vehicles follow their
    lanes at the speed that they had.

    Args:
        session: The running simulation.
        time_step: Control step [s].
        substeps: Control steps per SUMO step.
        horizon: Longest prediction horizon N of any ego [steps].

    Attributes:
        background: Background vehicles at SUMO's latest instant.
        poses: Poses (N, e + b, 7) of the vehicles over the prediction horizon. The first e rows of
            each step are the egos, which their corridors fill in; ``poses[0]`` is the present.
        vehicles: A view of ``poses[0]`` for the crowd's step.
        others: The same without the egos.
    """

    background: BackgroundVehicles
    poses: Array
    vehicles: Vehicles
    others: Vehicles

    def __init__(self, session: SumoSession, time_step: float, substeps: int, horizon: int) -> None:
        self._session = session
        self._time_step = time_step
        self._substeps = substeps
        self._horizon = horizon
        self._span = (substeps + horizon) * time_step  # time [s]
        self._bends = Bends(session.vehicles, time_step, substeps, horizon)
        self._long = substeps * time_step > _SHORT
        self._since = 0  # control steps since SUMO's last step
        self._egos = 0
        self._driven: list[Ego] = []
        self._slowing = Slowing(substeps * time_step)
        self._news, self._slows = np.zeros((0, 7)), np.zeros(0)  # of the vehicles that have rows
        self._near = _NONE  # indices of the background vehicles that have rows
        self._angles = np.zeros(0)
        self._row = np.zeros(0)
        self.background = NO_VEHICLES
        self._allocate((), 0)

    def _allocate(self, egos: Sequence[Ego], others: int) -> None:
        self._egos, self._driven = len(egos), list(egos)
        self.poses = np.zeros((self._horizon, self._egos + others, 7))
        self.poses[:, :, 4:] = 1.0  # a body of some size, until the row is filled
        for row, ego in enumerate(egos):
            half = ego.shape.length / 2
            self.poses[:, row, 4:] = half, half, ego.shape.width
        self._show()

    def _show(self) -> None:
        self.vehicles = Vehicles(self.poses[0])
        self.others = Vehicles(self.poses[0, self._egos :])

    # --- from SUMO ----------------------------------------------------------------------------

    def read(self, egos: Sequence[Ego], pedestrians: Array) -> None:
        """Read where the background vehicles are now.

        Args:
            egos: Egos on the road, in the order of their rows.
            pedestrians: Positions (n, 2) [m] now.

        Raises:
            VehicleError: a position in SUMO is not finite.
        """
        self.background = background = self._session.vehicles.background()
        near, slows = _NONE, _NO_NEWS
        if background.ids:
            self._require_finite(background)
            drives = [(*ego.pose[:2], ego.vehicle.speed) for ego in egos]
            near = _relevant(background, pedestrians, drives, self._span)
            slows = self._slowing.read(background.ids, background.speed)
            if any(ego.config.defaults.buffered for ego in egos):
                slows[:] = 0.0  # the paper's controllers expect constant speeds
        self._near, self._slows = near, slows[near]
        if self.poses.shape[1] != len(egos) + len(near) or self._driven != egos:
            self._allocate(egos, len(near))
        self._since = 0
        if not len(near):
            return
        now = self.poses[0, self._egos :]
        half_length = background.length[near] / 2
        now[:, 0] = background.x[near] - half_length * np.cos(background.heading[near])
        now[:, 1] = background.y[near] - half_length * np.sin(background.heading[near])
        now[:, 2] = background.heading[near]
        now[:, 3] = background.speed[near]
        now[:, 4] = now[:, 5] = half_length
        now[:, 6] = background.width[near]
        self._news = now.copy()
        extrapolate(self.poses, self._egos, self._time_step)
        self._slow_down(0)
        close = None if self._long else _close(background, near, egos)
        self._bends.read(background, near, close)
        self._bends.fill(self.poses, self._egos, 0)

    def mark_beside(self, egos: Sequence[Ego]) -> None:
        """Tell egos which rows are vehicles that pass beside, and how hard each row brakes."""
        near = self.background_ids
        braking = self._session.vehicles.emergency_braking(near)
        step = self._substeps * self._time_step
        for ego in egos:
            names = ego.rules.beside
            rows = [name in names for name in near] if names else []
            ego.beside = np.array(rows, dtype=np.bool_)
            ego.news.tell(near, braking, step)

    def _require_finite(self, vehicles: BackgroundVehicles) -> None:
        bad = ~np.isfinite(vehicles.x + vehicles.y + vehicles.speed)
        if bad.any():
            i = int(np.argmax(bad))
            place, speed = f"({vehicles.x[i]}, {vehicles.y[i]})", vehicles.speed[i]
            msg = f"vehicle '{vehicles.ids[i]}' at {self._session.time:.12g} s: SUMO has it at "
            msg += f"{place} with {speed} m/s; expected finite numbers; check its route and type"
            raise VehicleError(msg)

    def place(self, egos: Sequence[Ego]) -> None:
        """Fill the egos' rows: present poses, and future ones if a prediction uses them.

        A single ego that foresees the crowd predicts it under motions of its own, so that its
        future poses are not filled.
        """
        unseen = len(egos) == 1 and egos[0].foresees
        poses = self.poses[:1] if unseen else self.poses
        for row, ego in enumerate(egos):
            ego.corridor.fill_poses(poses, row, ego.front, ego.vehicle.speed)

    def drop(self, row: int) -> None:
        """Remove the ego in ``row`` from the vehicles; possible at every control step."""
        self._egos -= 1
        self.poses = np.ascontiguousarray(np.delete(self.poses, row, axis=1))
        self._show()

    def carry_on(self) -> None:
        """Move background vehicles on by one control step in which SUMO itself does not step."""
        if self.poses.shape[1] > self._egos:
            carry_on(self.poses, self._egos, self._time_step)
            self._slow_down(self._since + 1)
            self._bends.fill(self.poses, self._egos, self._since + 1)
        self._since += 1

    def _slow_down(self, since: int) -> None:
        """Let the vehicles that slow down go on doing so, ``since`` steps after the news."""
        if self._slows.any():
            times = since * self._time_step, self._time_step, self._slowing.step
            slow_down(self.poses, self._news, self._egos, self._slows, times)

    @property
    def background_ids(self) -> list[str]:
        """The ids of the background vehicles that have rows, in their order."""
        return [self.background.ids[i] for i in self._near]

    # --- to SUMO ------------------------------------------------------------------------------

    def push(self, step: int, egos: Sequence[Ego], roster: Roster) -> None:
        """Move everybody in SUMO to where they are at the control step ``step``, and step SUMO.

        Raises:
            CrowdError, VehicleError: a position is not finite, which would make SUMO hang.
            SumoError: SUMO failed, or its positions differ from giveway's.
        """
        places = [(ego.id, ego.check_pose(step)) for ego in egos]
        present, crowd = roster.person_ids, roster.crowd
        self._reserve(len(roster.ids))
        angles = self._row[: len(present)]
        bad = walking_angles(crowd.position, crowd.velocity, present, self._angles, angles)
        if bad >= 0:
            raise CrowdError(
                f"pedestrian '{roster.ids[present[bad]]}' at step {step}: position "
                f"{crowd.position[bad].tolist()}; expected finite numbers"
            )
        x, y = crowd.position.T.tolist()
        self._session.mirror(places, roster.names, x, y, angles.tolist())

    def _reserve(self, pedestrians: int) -> None:
        if pedestrians > len(self._angles):
            more = max(pedestrians, 2 * len(self._angles))
            self._angles = np.concatenate([self._angles, np.zeros(more - len(self._angles))])
            self._row = np.empty(more)


def _close(
    vehicles: BackgroundVehicles, near: NDArray[np.int64], egos: Sequence[Ego]
) -> NDArray[np.bool_]:
    """Flags (rows,) of the vehicles ``near`` that may soon meet an ego that obeys right of way."""
    close = np.zeros(len(near), dtype=np.bool_)
    for ego in egos:
        if not ego.config.heeds("right_of_way"):
            continue
        apart = np.hypot(vehicles.x[near] - ego.pose.x, vehicles.y[near] - ego.pose.y)
        close |= apart <= _MEET * (vehicles.speed[near] + ego.vehicle.speed) + _BODIES
    return close


def _relevant(
    vehicles: BackgroundVehicles,
    pedestrians: Array,
    egos: Sequence[tuple[float, float, float]],
    ahead: float,
) -> NDArray[np.int64]:
    """The indices of the vehicles that matter to a pedestrian or an ego within ``ahead`` [s].

    Args:
        vehicles: The background vehicles.
        pedestrians: Positions (n, 2) [m].
        egos: Position x, y [m] and speed [m/s] of each ego.
        ahead: Time [s].
    """
    speed = np.abs(vehicles.speed)
    reach = _INFLUENCE_RANGE + vehicles.length + vehicles.width + (_NOSE + ahead) * speed
    matters = np.zeros(len(vehicles.ids), dtype=np.bool_)
    if len(pedestrians):
        low, high = pedestrians.min(axis=0), pedestrians.max(axis=0)
        matters |= (
            (vehicles.x >= low[0] - reach)
            & (vehicles.x <= high[0] + reach)
            & (vehicles.y >= low[1] - reach)
            & (vehicles.y <= high[1] + reach)
        )
    for x, y, own_speed in egos:
        distance = np.hypot(vehicles.x - x, vehicles.y - y)
        matters |= distance <= SIGHT + reach + ahead * own_speed
    return np.flatnonzero(matters)


@kernel
def extrapolate(poses: Array, egos: int, time_step: float) -> None:
    """Fill the background vehicles' poses of steps 1 ... N-1 from step 0 at constant speed."""
    for i in range(1, poses.shape[0]):
        for j in range(egos, poses.shape[1]):
            distance = poses[0, j, 3] * time_step * i
            for k in range(poses.shape[2]):
                poses[i, j, k] = poses[0, j, k]
            poses[i, j, 0] += distance * np.cos(poses[0, j, 2])
            poses[i, j, 1] += distance * np.sin(poses[0, j, 2])


@kernel
def carry_on(poses: Array, egos: int, time_step: float) -> None:
    """Move all background vehicles of all steps on by one time step at constant speed."""
    for i in range(poses.shape[0]):
        for j in range(egos, poses.shape[1]):
            distance = poses[i, j, 3] * time_step
            poses[i, j, 0] += distance * np.cos(poses[i, j, 2])
            poses[i, j, 1] += distance * np.sin(poses[i, j, 2])


@kernel
def walking_angles(
    position: Array, velocity: Array, present: NDArray[np.int64], memory: Array, angles: Array
) -> int:
    """Fill each pedestrian's angle [deg, 0 = north, clockwise].

    ``memory`` holds the last angle of all pedestrians, which is kept while one stands. Returns the
    row of the first state that is not finite, or -1.
    """
    for j in range(len(present)):
        v_x, v_y = velocity[j, 0], velocity[j, 1]
        if not np.isfinite(position[j, 0] + position[j, 1] + v_x + v_y):
            return j
        if v_x * v_x + v_y * v_y > _STANDING * _STANDING:
            memory[present[j]] = angle_of_velocity(v_x, v_y)
        angles[j] = memory[present[j]]
    return -1
