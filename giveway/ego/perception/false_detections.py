"""False detections: people whom cameras perceive although nobody is there.

A sensor gives them the ids -1, -2, ..., each of them once, so that nothing that was learnt of one
is believed of another. The chain behind a sensor keeps arrays by number. There people have even
numbers and false detections odd ones.
"""

from math import pi

import numpy as np
from numpy.typing import NDArray

from giveway.ego.perception.protocol import Ids, OwnState, Percept, SensorSetup
from giveway.ego.perception.truth import ADULT
from giveway.ego.perception.visibility import in_sight
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

_STREAM = 0xFA15E  # key of the random stream of false detections, which differs from all others
_FAR = 1000.0  # time [s] of walking to the expected goal, beyond every horizon
_ROUNDING = 1e-9
_COLUMNS = 6  # number; time when it begins [s]; x, y [m]; velocity [m/s]


class FalseDetections:
    """The false detections of one ego's cameras.

    They begin at random instants, at places that are uniform over a camera's field of view. Those
    that would be hidden there do not begin, nor do those within the ego. Each step draws the same
    number of random numbers, so that none depends on the drive.

    Args:
        setup: Setup of the sensor.
        rate: Mean number per second and camera in an open field of view [1/s].
        time: Time [s] for which each is detected.
        speed: Speed [m/s] at which each goes straight on in a random direction.
        kept: Time [s] for which each is needed afterwards.

    Attributes:
        noise: Generator of the noise of their positions.
    """

    def __init__(
        self, setup: SensorSetup, rate: float, time: float, speed: float, kept: float
    ) -> None:
        key = setup.seed, _STREAM, *setup.ego_id.encode()
        self._random, self.noise = np.random.default_rng(key).spawn(2)
        self._share = rate * setup.time_step
        self._span, self._speed, self._kept = time - _ROUNDING, speed, kept
        self._rows, self._begun = np.empty((0, _COLUMNS)), 0

    def at(
        self, now: float, eyes: Array, walls: Array, ego: OwnState
    ) -> tuple[Crowd, Ids, NDArray[np.bool_]]:
        """Return the false detections as people (n,), their numbers, and which are detected now.

        Args:
            now: Present time [s].
            eyes: Cameras (e, 6).
            walls: Walls (k, 5) that hide people.
            ego: State of the ego.
        """
        rows = self._rows[now - self._rows[:, 1] < self._span + self._kept]
        self._rows = rows = np.concatenate([rows, self._new(now, eyes, walls, ego)])
        since, velocity = now - rows[:, 1], rows[:, 4:]
        place = rows[:, 2:4] + since[:, None] * velocity
        goals = list((place + _FAR * velocity)[:, None])
        people = Crowd.create(place, velocity, np.full(len(rows), self._speed), goals)
        return people, rows[:, 0].astype(np.int64), since < self._span

    def _new(self, now: float, eyes: Array, walls: Array, ego: OwnState) -> Array:
        """Return the rows of those that begin now; at most one per camera."""
        begins, far, aside, walks = self._random.random((4, len(eyes)))
        far, angle = eyes[:, 4] * np.sqrt(far), eyes[:, 3] + eyes[:, 5] * (2.0 * aside - 1.0)
        place = eyes[:, :2] + (far * (np.cos(angle), np.sin(angle))).T
        (x, y, heading), shape = ego.pose, ego.shape
        along, across = _turned(place - (x, y), -heading).T
        begin = (along > 0.0) | (along < -shape.length) | (np.abs(across) > 0.5 * shape.width)
        begin &= begins < self._share
        for e in np.flatnonzero(begin):
            begin[e] = in_sight(eyes[e : e + 1], walls, place[e : e + 1], np.full(1, ADULT))[0]
        count = int(begin.sum())
        number = self._begun + np.arange(count, dtype=np.float64)
        self._begun += count
        course = heading + 2.0 * pi * walks[begin]
        velocity = self._speed * np.column_stack([np.cos(course), np.sin(course)])
        return np.column_stack([number, np.full(count, now), place[begin], velocity])


def joined(percept: Percept, false: Percept) -> Percept:
    """Return a percept of people together with one of false detections, all with bounds.

    Args:
        percept: Percept of people.
        false: Percept of false detections, whose ids are their numbers.
    """
    if not len(false.person_ids):
        return percept
    people, ids = percept.people.concatenate(false.people), ~false.person_ids
    bounds = (
        np.concatenate([of_people, of_false])
        for of_people, of_false in zip(percept[2:], false[2:], strict=True)
        if of_people is not None and of_false is not None
    )
    return Percept(people, np.concatenate([percept.person_ids, ids]), *bounds)


def tracks_of(ids: Ids) -> Ids:
    """Return the number, at least 0, by which the chain follows each perceived person."""
    return np.where(ids < 0, 2 * ~ids + 1, 2 * ids)


def ids_of(tracks: Ids) -> Ids:
    """Return the id of each number of :func:`tracks_of`, negative for false detections."""
    return np.where(tracks % 2 == 1, ~(tracks // 2), tracks // 2)


def _turned(points: Array, by: float) -> Array:
    cos, sin = np.cos(by), np.sin(by)
    turned: Array = points @ np.array([[cos, sin], [-sin, cos]])
    return turned
