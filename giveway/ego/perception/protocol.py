"""The protocol of sensors, and of the refinements of their answers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import Pose
from pedestrian_model import Crowd

if TYPE_CHECKING:
    from giveway.ego.perception.truth import Truth

Ids = NDArray[np.int64]


class Percept(NamedTuple):
    """The pedestrians that an ego perceives. Its rows differ from those of the truth.

    Attributes:
        people: Perceived pedestrians (n,), at the positions where they are expected to be now.
        person_ids: Id (n,) of each perceived person, which the person keeps during the run. From
            a sensor, false detections have the ids -1, -2, ...
        age: Time (n,) [s] since each person was last seen, or None if all are seen now.
        position_bound: Largest error (n,) [m] of each position, or None if the sensor claims none.
        velocity_bound: Largest error (n,) [m/s] of each velocity, or None in the same case.
    """

    people: Crowd
    person_ids: Ids
    age: Array | None = None
    position_bound: Array | None = None
    velocity_bound: Array | None = None


@dataclass(slots=True)
class OwnState:
    """The ego's own state: one object per ego, refilled in place.

    Attributes:
        pose: Centre of the front bumper [m] and heading of the body [rad].
        speed: Speed [m/s].
        row: Row of the ego among the vehicles of the truth.
        shape: Length and width of the body [m].
    """

    pose: Pose
    speed: float
    row: int
    shape: VehicleShape


@dataclass(frozen=True)
class SensorSetup:
    """The setup that a sensor is made for.

    Attributes:
        time_step: Time between two observations [s].
        seed: Seed of the run.
        ego_id: SUMO's id of the ego that carries the sensor.
    """

    time_step: float
    seed: int
    ego_id: str

    def random(self) -> np.random.Generator:
        """Return a generator of random numbers for this ego's sensor alone."""
        return np.random.default_rng((self.seed, _STREAM, *self.ego_id.encode()))


_STREAM = 0x5E25  # key of the random stream of sensors, which differs from all others


@runtime_checkable
class Sensor(Protocol):
    """A sensor: it looks at the truth and returns what an ego perceives of it.

    A person may be missing from an answer, appear late, vanish and come back.

    A sensor may also have the method ``unseen(points)``. It returns the marks (k,) of the points
    (k, 2) [m] at which a person would not be in sight now. The ego then allows for people who come
    out there. A sensor whose answers are late also has the attribute ``delay`` [s], and one that
    perceives people who are not there the attribute ``false_detections``, which is true.
    """

    def observe(self, truth: Truth, person_ids: Ids, ego: OwnState) -> Percept:
        """Perceive the pedestrians at one instant.

        Args:
            truth: World as it is.
            person_ids: Id of each pedestrian in ``truth.people``, (n,).
            ego: State of the ego that carries the sensor.
        """
        ...


class Refinement(Protocol):
    """A member of the chain behind a sensor: noise, tracker, desired speeds, goals."""

    def refine(self, percept: Percept) -> Percept:
        """The percept after this member of the chain. The given arrays are not changed."""
        ...


class OwnArrays:
    """Copies of a crowd in which some arrays are its own and all others are shared.

    Args:
        names: Names of the arrays that are not shared.
    """

    def __init__(self, *names: str) -> None:
        self._names = names
        self._source: Crowd | None = None
        self._copy: Crowd | None = None

    def of(self, people: Crowd) -> Crowd:
        """The copy of these people; the same copy again for the same object."""
        if self._copy is None or people is not self._source:
            own = {name: getattr(people, name).copy() for name in self._names}
            self._source, self._copy = people, replace(people, **own)
        self._copy.__dict__["signals"] = people.signals  # a crowd may be refilled in place
        return self._copy
