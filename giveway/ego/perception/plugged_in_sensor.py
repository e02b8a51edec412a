"""The wrapper of a sensor of another package: it shows copies of the truth and checks answers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from giveway.config import EgoRunConfig
from giveway.ego.perception.hidden_people import TellsUnseen
from giveway.ego.perception.protocol import Ids, OwnState, Percept, Sensor, SensorSetup
from giveway.ego.perception.truth import Truth
from giveway.errors import SensorError
from giveway.geometry.kernel import Array
from giveway.plug_ins.faults import blamed, shown
from giveway.plug_ins.finding import OURS, find, load_maker
from giveway.plug_ins.sockets import SENSOR
from pedestrian_model import Crowd


def sensor_of(config: EgoRunConfig, time_step: float) -> Sensor | None:
    """The sensor of one ego, or None if it perceives all people.

    One of another package is wrapped; giveway's own keep to the rules by themselves.

    Args:
        config: Configuration of the ego.
        time_step: Time between two observations [s].

    Raises:
        ConfigError: an option of the sensor cannot be used.
        ControlError: the sensor is not installed, or cannot be imported.
        SensorError: the sensor cannot be made.
    """
    if not config.perception.plugged_in_sensor:
        return None
    make, setup = maker(config), setup_of(config, time_step)
    if find(config.perception.sensor, SENSOR).distribution == OURS:
        return cast("Sensor", make(setup))
    name = f"'{config.perception.sensor}' of '{config.ego_id}'"
    return PluggedInSensor(name, lambda: make(setup))


def setup_of(config: EgoRunConfig, time_step: float) -> SensorSetup:
    """Return the setup that the sensor of one ego is made for.

    Args:
        config: Configuration of the ego.
        time_step: Time between two observations [s].
    """
    return SensorSetup(time_step, config.seed, config.ego_id)


def maker(config: EgoRunConfig) -> Callable[[SensorSetup], object]:
    """The function that makes the sensor of one ego with its options.

    Args:
        config: Configuration of the ego.

    Raises:
        ConfigError: an option of the sensor cannot be used.
        ControlError: the sensor is not installed, or cannot be imported.
    """
    return load_maker(config.perception.sensor, SENSOR, config.sensor_options)


def telling(sensor: Sensor | None) -> TellsUnseen | None:
    """The sensor if it tells where people would not be in sight, or None.

    Args:
        sensor: Sensor as :func:`sensor_of` returns it.
    """
    tells = sensor.tells_unseen if isinstance(sensor, PluggedInSensor) else True
    return sensor if tells and isinstance(sensor, TellsUnseen) else None


_MOST_FALSE = 1_000_000  # number of false detections in a run


class PluggedInSensor:
    """A sensor of another package, which the run asks like giveway's own.

    The sensor gets copies, which it may overwrite. Its answers are checked before they are used.

    Args:
        name: Name of the sensor and of its ego, for messages.
        make: Function that makes the sensor.

    Raises:
        SensorError: the sensor cannot be made, or has no method ``observe``.
    """

    def __init__(self, name: str, make: Callable[[], object]) -> None:
        self._name = name
        with blamed(name, SensorError, " when it was made"):
            sensor = make()
        if not isinstance(sensor, Sensor):
            raise self._unusable(sensor, "an object with a method observe", "made")
        self._sensor = sensor
        self._room: Crowd | None = None  # memory for the copy of the people
        self._known = np.zeros(0, dtype=np.bool_)  # by person id: whether the sensor was shown it

    def observe(self, truth: Truth, person_ids: Ids, ego: OwnState) -> Percept:
        """Return the checked percept of the sensor.

        Args:
            truth: World as it is; the sensor is shown a copy.
            person_ids: Id of each pedestrian in ``truth.people``, (n,).
            ego: State of the ego.

        Raises:
            SensorError: the sensor raises, or its answer cannot be used.
        """
        everybody = np.ones(len(person_ids), dtype=np.bool_)
        self._room = truth.people.select(everybody, self._room)
        copied = Truth(
            self._room,
            truth.vehicles.copy(),
            truth.outlines.copy(),
            truth.time,
            truth.vehicle_heights.copy(),
            truth.person_heights.copy(),
        )
        own = OwnState(ego.pose, ego.speed, ego.row, ego.shape)
        most = int(person_ids.max(initial=-1)) + 1
        if most > len(self._known):
            self._known = np.concatenate([self._known, np.zeros(most, dtype=np.bool_)])
        self._known[person_ids] = True
        with blamed(self._name, SensorError):
            answer = self._sensor.observe(copied, person_ids.copy(), own)
        return self._checked(answer)

    @property
    def tells_unseen(self) -> bool:
        """True if the sensor tells where people would not be in sight."""
        return hasattr(self._sensor, "unseen")

    @property
    def false_detections(self) -> bool:
        """True if the sensor says that it also perceives people who are not there."""
        return bool(getattr(self._sensor, "false_detections", False))

    @property
    def delay(self) -> float:
        """The time [s] by which the sensor's answers are late."""
        return float(getattr(self._sensor, "delay", 0.0))

    def unseen(self, points: Array) -> NDArray[np.bool_]:
        """Return the checked marks (k,) of the points (k, 2) [m] that are not in sight.

        Raises:
            SensorError: the sensor raises, or its answer cannot be used.
        """
        with blamed(self._name, SensorError):
            marks = self._sensor.unseen(points)  # type: ignore[attr-defined]
        if not (isinstance(marks, np.ndarray) and marks.dtype == np.bool_):
            raise self._unusable(marks, "an array of marks", "told as unseen")
        if marks.shape != (len(points),):
            raise self._unusable(marks.shape, f"the shape ({len(points)},)", "told as unseen")
        return marks

    def _checked(self, answer: Any) -> Percept:
        """Return the answer if all of it can be used, or raise a `SensorError`."""
        if not (isinstance(answer, Percept) and isinstance(answer.people, Crowd)):
            raise self._unusable(answer, "a Percept of a Crowd")
        people, ids, n = answer.people, answer.person_ids, len(answer.people)
        whole = isinstance(ids, np.ndarray) and ids.dtype == np.int64 and ids.shape == (n,)
        if not whole:
            raise self._unusable(ids, f"({n},) int64, one for each person", "returned person_ids")
        least = -_MOST_FALSE if self.false_detections else 0
        strangers = ids[(ids < least) | (ids >= len(self._known))]
        there = ids[ids >= 0]
        strangers = strangers if len(strangers) else there[~self._known[there]]
        if len(strangers):
            what = "those of people whom it was shown"
            raise self._unusable(int(strangers[0]), what, "returned person_ids with")
        if len(np.unique(ids)) < n:
            raise self._unusable(ids, "each person once", "returned person_ids")
        for name in ("position", "velocity"):
            if not np.isfinite(array := getattr(people, name)).all():
                bad = float(array[~np.isfinite(array)][0])
                raise self._unusable(bad, "finite numbers", f"returned {name}")
        for name in ("age", "position_bound", "velocity_bound"):
            array = getattr(answer, name)
            if array is None:
                continue
            sound = isinstance(array, np.ndarray) and array.shape == (n,) and array.dtype == float
            if not (sound and np.isfinite(array).all() and (array >= 0.0).all()):
                raise self._unusable(
                    array, f"None, or ({n},) floats of at least 0", f"returned {name}"
                )
        return answer

    def _unusable(self, value: object, expected: str, verb: str = "returned") -> SensorError:
        told = f"{self._name} {verb} {shown(value)}"
        return SensorError(f"{told}: expected {expected} (docs/plugins.md)")
