"""What a manoeuvre would lead to: the crowd predicted under it, seen from the ego on its way."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from controller.planning import Prospect
from giveway.ego.in_front import closest_in_front, window
from giveway.ego.threats import Alarm, courses
from giveway.geometry.kernel import kernel
from giveway.geometry.path import body_pose

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from controller.planning import Manoeuvre
    from giveway.geometry.bodies import VehicleShape
    from giveway.geometry.path import EgoPath
    from pedestrian_model import Crowd, Predictor, Surroundings

    Array = NDArray[np.float64]

PASSED = 0.3  # [m] behind the front bumper people still count as in front: they are squeezed past
_EVERY = 2  # steps from one look for conflicts to the next


class CrowdForesight:
    """Predicts the crowd under one manoeuvre after the other.

    Args:
        predictor: of N steps.
        path: the ego's way.
        shape: its body.
        half_width: of the corridor [m].
        growth: of it with the look-ahead, on each side [m/s].
        conflict_time: time to collision of a conflict [s].
        planned_speed: people are predicted under the manoeuvre, else under the present speed.
        clearance: [m] that the safety layer keeps to people's bodies.
        braking: [m/s^2] of the ego at most.
        safety_layer: whether there is one: only then it matters what it would do.
    """

    def __init__(
        self,
        predictor: Predictor,
        path: EgoPath,
        shape: VehicleShape,
        *,
        half_width: float,
        growth: float,
        conflict_time: float,
        planned_speed: bool,
        clearance: float,
        braking: float,
        safety_layer: bool,
    ) -> None:
        N = predictor.horizon
        self._predictor = predictor
        self._path = path
        self._shape = shape
        self._half_width = half_width
        self._growth = growth
        self._conflict_time = conflict_time
        self._planned_speed = planned_speed
        self._clearance = clearance
        self._braking = braking
        self._layer = safety_layer
        self._constant = np.arange(N + 1) * predictor.time_step
        self._distance, self._speed = np.empty(N + 1), np.empty(N + 1)
        self._prospect = Prospect(np.empty(N), np.zeros(N), np.zeros(N))
        self._predicted = np.empty((N, 0, 2))
        self._best = np.empty((N, 0, 2))
        self._stale, self._preferred = True, False

    def look(
        self,
        people: Crowd,
        surroundings: Surroundings,
        poses: Array,
        row: int,
        front: float,
        speed: float,
    ) -> None:
        """Begin an instant.

        Args:
            people: whom to predict.
            surroundings: the walls and lights that they heed.
            poses: (N, m, 7) of all vehicles at steps 0 ... N-1; the ego's row is overwritten.
            row: the ego's.
            front: the front bumper's station [m].
            speed: the ego's [m/s].
        """
        self._people, self._surroundings = people, surroundings
        self._poses, self._row, self._front, self._now = poses, row, front, speed
        self._stale, self._preferred = True, False

    @property
    def best(self) -> Array | None:
        """(N, n, 2) [m] people at steps 1 ... N under the manoeuvre preferred; None: none was."""
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
        path, people = self._path, self._predictor.parameters
        assess(
            path.vertices,
            path.stations,
            path.headings,
            self._predicted,
            self._front,
            manoeuvre.distance,
            manoeuvre.speed,
            self._shape.length,
            self._shape.width,
            self._half_width,
            self._growth,
            self._conflict_time,
            self._predictor.time_step,
            Alarm(
                people.body_radius,
                self._clearance,
                people.max_acceleration,
                self._braking,
                self._layer,
            ),
            gap,
            conflicts,
            calm,
        )
        return self._prospect

    def prefer(self) -> None:
        """Remember where everybody would be under the latest manoeuvre."""
        if self._best.shape != self._predicted.shape:
            self._best = np.empty_like(self._predicted)
        self._best[:] = self._predicted
        self._preferred = True

    def _predict(self, distance: Array, speed: Array) -> None:
        path = self._path
        fill_planned_poses(
            path.vertices,
            path.stations,
            path.headings,
            self._front,
            distance,
            speed,
            self._shape.length,
            self._row,
            self._poses,
        )
        self._predicted = self._predictor.predict(self._people, self._poses, self._surroundings)
        self._stale = False


@kernel
def fill_planned_poses(
    vertices: Array,
    stations: Array,
    headings: Array,
    front: float,
    distance: Array,
    speeds: Array,
    length: float,
    row: int,
    poses: Array,
) -> None:
    """The body's centre, heading and speed at steps 0 ... N-1 of a manoeuvre."""
    for i in range(poses.shape[0]):
        x, y, heading = body_pose(vertices, stations, headings, front + distance[i], length)
        poses[i, row, 0] = x - 0.5 * length * np.cos(heading)
        poses[i, row, 1] = y - 0.5 * length * np.sin(heading)
        poses[i, row, 2] = heading
        poses[i, row, 3] = speeds[i]


@kernel
def assess(
    vertices: Array,
    stations: Array,
    headings: Array,
    predicted: Array,
    front: float,
    distance: Array,
    speeds: Array,
    length: float,
    width: float,
    half_width: float,
    growth: float,
    conflict_time: float,
    time_step: float,
    alarm: Alarm,
    gap: Array,
    conflicts: Array,
    calm: Array,
) -> None:
    """Fill gaps in front, persons on a collision course, and calm speeds at steps 1 ... N.

    Between two looks at people's courses the numbers are held.
    """
    N = predicted.shape[0]
    first, last = window(stations, front, PASSED + length)
    conflicts[0], calm[0] = 0.0, np.inf
    for i in range(N):
        at = front + distance[i + 1]
        wide = half_width + growth * (i + 1) * time_step
        closest, _ = closest_in_front(
            vertices, stations, first, last, predicted[i], at - PASSED, wide, 0.0
        )
        gap[i] = closest - at
        if i % _EVERY == 0 and i + 1 < N:
            x, y, heading = body_pose(vertices, stations, headings, at, length)
            conflicts[i], calm[i] = courses(
                predicted[i],
                predicted[i + 1],
                x,
                y,
                heading,
                speeds[i + 1],
                length / 2.0,
                width / 2.0,
                conflict_time,
                time_step,
                alarm,
            )
        elif i > 0:
            conflicts[i], calm[i] = conflicts[i - 1], calm[i - 1]
