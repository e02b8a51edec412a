"""The sensor `sight`: cameras with a range and a field of view, from which things hide people.

A person is seen if at least half of the width of the body is within the field of view of one of the
mounts, nearer than its range, and hidden by nothing: vehicles, walls, and other people if they
count. Seen people are perceived late and not exactly, as the options say. A person who is lost from
sight is remembered for a while, as walking on.
"""

from dataclasses import dataclass
from math import isfinite, pi, radians, sqrt
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Strict

from controller.parameters import require, require_not_negative, require_positive
from giveway.crowd.motion.noise import BOUND, planar_noise
from giveway.ego.perception.false_detections import FalseDetections, joined
from giveway.ego.perception.memory import Memory
from giveway.ego.perception.protocol import Ids, OwnState, Percept, SensorSetup
from giveway.ego.perception.truth import Truth
from giveway.ego.perception.visibility import (
    CHILD,
    RADIUS,
    Eye,
    chords_of,
    eyes_of,
    in_sight,
    walls_of,
)
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

_MOST_FALSE = 10.0  # largest rate [1/s] of false detections per camera
_Number = Annotated[float, Strict()]  # true is none


@dataclass(frozen=True)
class Mount:
    """A camera on the body of an ego.

    Attributes:
        ahead: Place [m] ahead of the front bumper, negative behind it.
        aside: Place [m] to the left of the middle.
        height: Height [m] above the ground.
        heading: Direction [degree] to the left of straight ahead.
        range: Largest distance [m] at which people are seen.
        field_of_view: Width [degree] of the field of view.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    __pydantic_config__: ClassVar[ConfigDict] = ConfigDict(extra="forbid")

    ahead: _Number = -1.5
    aside: _Number = 0.0
    height: _Number = 1.3
    heading: _Number = 0.0
    range: _Number = 60.0
    field_of_view: _Number = 120.0

    def __post_init__(self) -> None:
        for name, unit in {"height": "m", "range": "m", "field_of_view": "degree"}.items():
            require_positive(name, getattr(self, name), unit)
        for name, unit in {"ahead": "m", "aside": "m", "heading": "degree"}.items():
            value = getattr(self, name)
            require(isfinite(value), name, value, f"a finite number [{unit}]")
        require(self.field_of_view <= 360.0, "field_of_view", self.field_of_view, "at most 360")

    @property
    def row(self) -> Eye:
        """The camera in the frame of the front bumper."""
        half = min(radians(self.field_of_view) / 2.0, pi)
        turned = radians(self.heading)
        return Eye(self.ahead, self.aside, self.height, turned, self.range, half)


USUAL = (
    Mount(),
    Mount(-1.8, 0.9, 1.0, 90.0, 15.0, 190.0),
    Mount(-1.8, -0.9, 1.0, -90.0, 15.0, 190.0),
)
"""A camera behind the windscreen, and wide ones on the outside mirrors, as cars have them."""


@dataclass(frozen=True)
class SightOptions:
    """Options of the sensor.

    Attributes:
        mounts: Cameras; by default one behind the windscreen and one on each outside mirror.
        latency: Time [s] between an instant and its perception.
        missed: Share of the observations of a person in sight that are missed.
        missed_time: Time [s] for which a person is missed.
        memory: Time [s] for which a person who is not seen any more is remembered.
        position_noise: Standard deviation [m] of positions, per axis.
        noise_per_metre: Its growth per metre of distance.
        velocity_noise: Standard deviation [m/s] of velocities, per axis.
        acceleration: Largest acceleration [m/s^2] of people on which claimed bounds rely.
        people_hide: Whether people hide each other.
        false_rate: Mean number per second of false detections of each camera [1/s].
        false_time: Time [s] for which each of them is detected.
        false_speed: Speed [m/s] of each of them.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    mounts: tuple[Mount, ...] = USUAL
    latency: float = 0.0
    missed: float = 0.0
    missed_time: float = 0.1
    memory: float = 1.0
    position_noise: float = 0.0
    noise_per_metre: float = 0.0
    velocity_noise: float = 0.0
    acceleration: float = 3.0
    people_hide: bool = False
    false_rate: float = 0.0
    false_time: float = 0.5
    false_speed: float = 0.0

    def __post_init__(self) -> None:
        require(bool(self.mounts), "mounts", list(self.mounts), "at least one")
        for name, unit in _UNITS.items():
            require_not_negative(name, getattr(self, name), unit)
        require(self.missed < 1.0, "missed", self.missed, "a number from 0 to below 1")
        for name in ("missed_time", "false_time"):
            require_positive(name, getattr(self, name), "s")
        most = f"at most {_MOST_FALSE:g} [1/s]"
        require(self.false_rate <= _MOST_FALSE, "false_rate", self.false_rate, most)


_UNITS = {
    "latency": "s",
    "missed": "1",
    "memory": "s",
    "position_noise": "m",
    "noise_per_metre": "m/m",
    "velocity_noise": "m/s",
    "acceleration": "m/s^2",
    "false_rate": "1/s",
    "false_speed": "m/s",
}


class Sight:
    """Perceives the people in sight.

    Args:
        setup: Setup of the sensor.
        options: Options of the sensor.

    Attributes:
        delay: Latency [s], in whole steps.
        false_detections: Whether it perceives people who are not there.
    """

    Options = SightOptions

    def __init__(self, setup: SensorSetup, options: SightOptions) -> None:
        self._options, self._time_step = options, setup.time_step
        self._random = setup.random()
        self._late = round(options.latency / setup.time_step)
        self.delay = self._late * setup.time_step
        self._seen = _Recollection(options, self._random, self.delay, self._late)
        self._mounts = np.array([mount.row for mount in options.mounts])
        self._views: list[tuple[Array, Array]] = []
        self.false_detections = options.false_rate > 0.0
        if self.false_detections:
            kept = self.delay + options.memory + setup.time_step
            how = options.false_rate, options.false_time, options.false_speed
            self._false = FalseDetections(setup, *how, kept)
            self._false_seen = _Recollection(options, self._false.noise, self.delay, self._late)

    def observe(self, truth: Truth, person_ids: Ids, ego: OwnState) -> Percept:
        """Return the people who are seen, or were seen a short time ago.

        Args:
            truth: World as it is.
            person_ids: Id of each pedestrian in ``truth.people``, (n,).
            ego: State of the ego that carries the sensor.
        """
        o, now, known = self._options, truth.time, self._seen.memory
        eyes = eyes_of(self._mounts, *ego.pose)
        walls, still = walls_of(truth.outlines, truth.vehicles, truth.vehicle_heights, ego.row)
        self._views.append((eyes, walls[:still]))
        del self._views[: -1 - self._late]
        seen = self._look(truth, eyes, walls)
        if o.missed:
            begins = o.missed * self._time_step / (o.missed_time * (1.0 - o.missed))
            draws = self._random.random(len(known.rows(person_ids)))  # by id
            seen &= known.noticed(person_ids, draws, begins, now, o.missed_time)
        percept = self._seen.percept(truth.people, person_ids, seen, ego, now)
        if not self.false_detections:
            return percept
        false = self._false_seen.percept(*self._false.at(now, eyes, walls, ego), ego, now)
        return joined(percept, false)

    def unseen(self, points: Array) -> NDArray[np.bool_]:
        """Return at which points (k, 2) [m] a child could stand and not be in sight.

        With a latency, in sight at the latest instant that is perceived. People and moving vehicles
        hide nobody here: who is behind them comes on a visible way.
        """
        eyes, walls = self._views[0]
        return ~in_sight(eyes, walls, points, np.full(len(points), CHILD))

    def _look(self, truth: Truth, eyes: Array, walls: Array) -> NDArray[np.bool_]:
        """Return which people (n,) are in sight of a camera."""
        position, heights = truth.people.position, truth.person_heights
        if not self._options.people_hide:
            return in_sight(eyes, walls, position, heights)
        seen = np.zeros(len(position), dtype=np.bool_)
        for k in range(len(eyes)):
            chords = chords_of(position, heights, Eye(*eyes[k]), RADIUS)
            seen |= in_sight(eyes[k : k + 1], np.concatenate([walls, chords]), position, heights)
        return seen


class _Recollection:
    """The people who were seen: perceived late and with noise, and remembered.

    Args:
        options: Options of the sensor.
        random: Generator of the noise.
        delay: Latency [s], and in steps.
    """

    def __init__(
        self, options: SightOptions, random: np.random.Generator, delay: float, late: int
    ) -> None:
        self._options, self._random, self._delay, self._late = options, random, delay, late
        turns = _WITHIN * options.velocity_noise
        self.memory = Memory(options.memory, turns, options.acceleration)
        self._past: list[tuple[Ids, Array, Array, NDArray[np.bool_], Array]] = []

    def percept(
        self, people: Crowd, ids: Ids, seen: NDArray[np.bool_], ego: OwnState, now: float
    ) -> Percept:
        """Return who of these people (n,) are perceived now.

        Args:
            people: People as they are.
            ids: Their ids.
            seen: Marks of who is seen at this instant.
            ego: State of the ego.
            now: Present time [s].
        """
        o, position, velocity = self._options, people.position.copy(), people.velocity.copy()
        spread = np.full(len(people), o.position_noise)
        if o.noise_per_metre:
            off = position - ego.pose[:2]
            spread += o.noise_per_metre * np.hypot(off[:, 0], off[:, 1])
        self._past.append((ids, position, velocity, seen, spread))
        if len(self._past) > self._late:
            self._learn(*self._past.pop(0), now - self._delay)
        return self.memory.percept(people, ids, now, self._delay)

    def _learn(
        self,
        person_ids: Ids,
        position: Array,
        velocity: Array,
        seen: NDArray[np.bool_],
        spread: Array,
        then: float,
    ) -> None:
        """Remember the people who were seen at an instant, with noise."""
        o = self._options
        if o.position_noise or o.noise_per_metre or o.velocity_noise:
            rows = np.flatnonzero(seen)
            rows = rows[np.argsort(person_ids[rows])]  # the order does not matter
            position[rows] += spread[rows, None] * planar_noise(self._random, len(rows))
            velocity[rows] += o.velocity_noise * planar_noise(self._random, len(rows))
        self.memory.learn(person_ids, position, velocity, seen, _WITHIN * spread, then)


_WITHIN = sqrt(2.0) * BOUND  # largest noise in standard deviations: cut off on each axis
