"""What a manoeuvre would lead to: the crowd predicted under it, as seen from the ego."""

from typing import Any, NamedTuple

import numpy as np

from controller import Manoeuvre, Prospect
from giveway.ego.corridor import closest_in_front, fill_poses
from giveway.ego.threats import Alarm, conflicts_and_calm
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array, kernel
from giveway.geometry.passage import window
from giveway.geometry.path import EgoPath, body_pose, segment_at
from giveway.metrics.conflicts import CRITICAL_TTC
from pedestrian_model import Crowd, Predictor, Surroundings

PASSED = 0.3  # [m] behind the front bumper pedestrians still count as in front, being squeezed by
_EVERY = 2  # steps from one search for conflicts to the next


class View(NamedTuple):
    """The ego's body and how it looks ahead, as the kernel takes it."""

    length: float  # of the body [m]
    width: float  # [m]
    half_width: float  # of the corridor [m]
    growth: float  # of it with the look-ahead, on each side [m/s]
    conflict_time: float  # time to collision of a conflict [s]
    time_step: float  # [s]


class CrowdForesight:
    """Predicts the crowd under one manoeuvre after the other.

    The manoeuvres are tried in poses of its own: what other egos see does not change by them.

    Args:
        predictor: of N steps.
        path: the ego's.
        shape: of its body.
        half_width: of the corridor [m].
        growth: of it with the look-ahead, on each side [m/s].
        planned_speed: the crowd is predicted under the manoeuvre, else under the present speed.
        clearance: [m] that the safety layer keeps to pedestrians' bodies.
        braking: [m/s^2] of the ego at most.
        safety_layer: whether there is one: only then it matters what it would do.
        conflict_time: time to collision of a conflict [s] (FHWA-HRT-08-051).
    """

    def __init__(
        self,
        predictor: Predictor,
        path: EgoPath,
        shape: VehicleShape,
        *,
        half_width: float,
        growth: float,
        planned_speed: bool,
        clearance: float,
        braking: float,
        safety_layer: bool,
        conflict_time: float = CRITICAL_TTC,
    ) -> None:
        N = predictor.horizon
        self._predictor = predictor
        self._path = path
        self._planned_speed = planned_speed
        # Plain tuples: each call would look the class of a named one up anew (2 us).
        self._view = tuple(
            View(shape.length, shape.width, half_width, growth, conflict_time, predictor.time_step)
        )
        walking = predictor.parameters
        self._alarm = tuple(
            Alarm(
                walking.body_radius,
                clearance,
                walking.max_acceleration,
                walking.max_speed,
                braking,
                safety_layer,
            )
        )
        self._length = shape.length
        self._constant = np.arange(N + 1) * predictor.time_step
        self._distance, self._speed = np.empty(N + 1), np.empty(N + 1)
        self._prospect = Prospect(np.empty(N), np.zeros(N), np.zeros(N))
        self._predicted = np.empty((N, 0, 2))
        self._best = np.empty((N, 0, 2))
        self._poses = np.empty((N, 0, 7))
        self._copied, self._stale, self._preferred = False, True, False

    def look(
        self,
        pedestrians: Crowd,
        surroundings: Surroundings,
        poses: Array,
        row: int,
        front: float,
        speed: float,
    ) -> None:
        """Begin an instant.

        Args:
            pedestrians: to be predicted.
            surroundings: the walls and lights that they heed.
            poses: (N, m, 7) of all vehicles at steps 0 ... N-1; not changed.
            row: the ego's.
            front: the front bumper's station [m].
            speed: the ego's [m/s].
        """
        self._pedestrians, self._surroundings = pedestrians, surroundings
        self._given, self._row, self._front, self._now = poses, row, front, speed
        self._copied, self._stale, self._preferred = False, True, False

    @property
    def best(self) -> Array | None:
        """(N, n, 2) [m] positions at steps 1 ... N under the preferred manoeuvre, if any was."""
        return self._best if self._preferred else None

    def prospect(self, manoeuvre: Manoeuvre) -> Prospect:
        """What a manoeuvre would lead to; valid until the next call."""
        if self._planned_speed:
            self._predict(manoeuvre.distance, manoeuvre.speed)
        elif self._stale:
            np.multiply(self._constant, self._now, out=self._distance)
            self._speed[:] = self._now
            self._predict(self._distance, self._speed)
        gap, conflicts, calm = self._prospect
        path = self._path
        assess(
            path.vertices,
            path.stations,
            path.headings,
            self._predicted,
            self._front,
            manoeuvre.distance,
            manoeuvre.speed,
            self._view,
            self._alarm,
            gap,
            conflicts,
            calm,
        )
        return self._prospect

    def prefer(self) -> None:
        """Keep the positions under the latest manoeuvre as those of the preferred one."""
        if self._best.shape != self._predicted.shape:
            self._best = np.empty_like(self._predicted)
        self._best[:] = self._predicted
        self._preferred = True

    def _predict(self, distance: Array, speed: Array) -> None:
        path = self._path
        if not self._copied:
            self._copy()
        fill_poses(
            path.vertices,
            path.stations,
            path.headings,
            self._front,
            distance,
            speed,
            self._length,
            self._row,
            self._poses,
        )
        self._predicted = self._predictor.predict(
            self._pedestrians, self._poses, self._surroundings
        )
        self._stale = False

    def _copy(self) -> None:
        """Take over the poses of this instant."""
        if self._poses.shape != self._given.shape:
            self._poses = np.empty_like(self._given)
        self._poses[:] = self._given
        self._copied = True


@kernel
def assess(
    vertices: Array,
    stations: Array,
    headings: Array,
    predicted: Array,
    front: float,
    distance: Array,
    speeds: Array,
    view: tuple[float, ...],
    alarm: tuple[Any, ...],
    gap: Array,
    conflicts: Array,
    calm: Array,
) -> None:
    """Fill gaps in front, persons on a collision course, and calm speeds at steps 1 ... N.

    Conflicts and calm speeds are found at every second step and held in between. ``view`` and
    ``alarm`` are the numbers of a :class:`View` and an :class:`Alarm`.
    """
    N = predicted.shape[0]
    v, limits = View(*view), Alarm(*alarm)
    length, time_step = v.length, v.time_step
    first, last = window(stations, front, PASSED + length)
    conflicts[0], calm[0] = 0.0, np.inf
    for i in range(N):
        at = front + distance[i + 1]
        wide = v.half_width + v.growth * (i + 1) * time_step
        closest, _ = closest_in_front(
            vertices, stations, first, last, predicted[i], at - PASSED, wide, 0.0
        )
        gap[i] = closest - at
        if i % _EVERY == 0 and i + 1 < N:
            x, y, heading = body_pose(vertices, stations, headings, at, length)
            stop = at + speeds[i + 1] * (time_step + speeds[i + 1] / (2.0 * limits.braking))
            braking_heading = heading
            if segment_at(stations, at - length) != segment_at(stations, stop) and stop > at:
                x_s, y_s, _ = body_pose(vertices, stations, headings, stop, 0.0)
                braking_heading = np.arctan2(y_s - y, x_s - x)
            conflicts[i], calm[i] = conflicts_and_calm(
                predicted[i],
                predicted[i + 1],
                x,
                y,
                heading,
                braking_heading,
                speeds[i + 1],
                length / 2.0,
                v.width / 2.0,
                v.conflict_time,
                time_step,
                limits,
            )
        elif i > 0:
            conflicts[i], calm[i] = conflicts[i - 1], calm[i - 1]
