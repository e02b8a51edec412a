"""The conformance kit of sensors: a battery of made-up scenes that need no SUMO.

A dozen people walk past a car that drives by a parked car and a wall.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from giveway.ego.perception.plugged_in_sensor import PluggedInSensor
from giveway.ego.perception.protocol import Ids, OwnState, Percept, SensorSetup
from giveway.ego.perception.truth import ADULT, Truth
from giveway.errors import SensorError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import Pose
from giveway.plug_ins.conformance.battery import TURN, Battery, Begins, Finding, moved, turned
from pedestrian_model import Crowd

_STEPS = 60  # Observations in each scene
_PEOPLE = 12
_SAME = 1e-9  # Rounding [m]
_SHAPE = VehicleShape(4.5, 1.8)
_PARKED = 8.0, 4.0, 0.0, 0.0, 2.25, 2.25, 1.8  # x, y [m], heading, speed, front, rear, width


class _Scene:
    """The made-up scene, perhaps turned and shifted, with its people perhaps in reverse order."""

    def __init__(self, time_step: float, *, turned: bool = False, order: int = 1) -> None:
        random = np.random.default_rng(1)
        self._time_step, self._is_turned = time_step, turned
        self._start = random.uniform((0.0, -9.0), (40.0, 9.0), (_PEOPLE, 2))[::order]
        self._velocity = random.uniform(-1.5, 1.5, (_PEOPLE, 2))[::order]
        self.ids = np.ascontiguousarray(3 + 2 * np.arange(_PEOPLE)[::order])

    def _placed(self, points: Array) -> Array:
        """Points [m] of the scene where they lie."""
        return moved(points) if self._is_turned else points

    def at(self, step: int) -> tuple[Truth, OwnState]:
        """The truth and the own state at a control step."""
        clock = step * self._time_step
        here = self._start + clock * self._velocity
        goals = list(self._placed(here + 20.0 * self._velocity)[:, None])
        velocity = turned(self._velocity) if self._is_turned else self._velocity
        people = Crowd.create(self._placed(here), velocity, 1.3, goals)
        front = np.array([[4.0 * clock, 0.0]])
        middle = front - [[_SHAPE.length / 2.0, 0.0]]
        vehicles = np.array([(*middle[0], 0.0, 4.0, 2.25, 2.25, _SHAPE.width), _PARKED])
        vehicles[:, :2] = self._placed(vehicles[:, :2])
        heading = TURN if self._is_turned else 0.0
        vehicles[:, 2] += heading
        wall = np.append(self._placed(np.array([[15.0, 5.0], [25.0, 5.0]])), 3.0).reshape(1, 5)
        x, y = self._placed(front)[0].tolist()
        pose = Pose(x, y, heading)
        heights = np.full(2, 1.5), np.full(_PEOPLE, ADULT)
        return Truth(people, vehicles, wall, clock, *heights), OwnState(pose, 4.0, 0, _SHAPE)


def check_sensor(
    make: Callable[[SensorSetup], object], setup: SensorSetup, begins: Begins | None = None
) -> list[Finding]:
    """Return a finding for each rule of sensors, kept or broken.

    Args:
        make: Function that makes the sensor for a setup.
        setup: Setup of the scenes.
        begins: Function that is told each rule before it is checked, or None.
    """
    return _Battery(make, setup).findings(begins)


class _Copied:
    """A sensor that gets copies of all arrays, which are not overwritten later."""

    def __init__(self, sensor: object) -> None:
        self._observe = sensor.observe  # type: ignore[attr-defined]
        self.false_detections = getattr(sensor, "false_detections", False)

    def observe(self, truth: Truth, person_ids: Ids, ego: OwnState) -> Percept:
        everybody = np.ones(len(person_ids), dtype=np.bool_)
        own = replace(truth, people=truth.people.select(everybody))
        answer: Percept = self._observe(own, person_ids, ego)
        return answer


_Perceived = list[tuple[Ids, Array]]  # by step: person ids in ascending order, positions [m]


class _Battery(Battery[PluggedInSensor, _Perceived]):
    faults = (SensorError,)
    method = "observe"

    def __init__(self, make: Callable[[SensorSetup], object], setup: SensorSetup) -> None:
        self._make, self._setup = make, setup

    def rules(self) -> dict[str, Callable[[], str]]:
        return {
            "can be made": self.can_be_made,
            "answers with a percept": self.usual,
            "answers in corner cases": self.in_corner_cases,
            "keeps to the bounds that it claims": self.bounds,
            "perceives the same when it is made again": self.deterministic,
            "is independent of others of its kind": self.independent,
            "does not depend on the order of people": self.unordered,
            "does not depend on where and how the ground lies": self.unturned,
            "keeps no array that is not its own": self.aliasing,
            "is quick": self.quick,
        }

    def fresh(self) -> PluggedInSensor:
        return PluggedInSensor("it", lambda: self._make(self._setup))

    def answers(
        self,
        hosted: PluggedInSensor,
        *,
        other: PluggedInSensor | None = None,
        order: int = 1,
        turned: bool = False,
    ) -> _Perceived:
        scene = _Scene(self._setup.time_step, turned=turned, order=order)
        perceived = []
        for step in range(_STEPS):
            truth, own = scene.at(step)
            people, ids, *_ = hosted.observe(truth, scene.ids, own)
            rows = np.argsort(ids)
            perceived.append((ids[rows], people.position[rows]))
            if other is not None:
                other.observe(truth, scene.ids, own)
        return perceived

    def difference(self, found: _Perceived, usual: _Perceived) -> str:
        for step, (before, now) in enumerate(zip(usual, found, strict=True)):
            others = set(before[0].tolist()) ^ set(now[0].tolist())
            if others:
                return f"at step {step} person {min(others)} is perceived once only"
            if len(now[0]) and np.abs(before[1] - now[1]).max() > _SAME:
                return f"at step {step} somebody is perceived elsewhere"
        return ""

    def unturned(self) -> str:
        """Compare the people who are perceived, wherever, with everything turned and shifted."""
        usual = self.answers(self.fresh())
        found = self.answers(self.fresh(), turned=True)
        ids_only = [
            [(ids, np.zeros((len(ids), 2))) for ids, _ in perceived] for perceived in (found, usual)
        ]
        difference = self.difference(*ids_only)
        return f"with everything turned and shifted: {difference}" if difference else ""

    def corner_cases(self) -> Iterator[tuple[str, Callable[[PluggedInSensor], object]]]:
        truth, _ = _Scene(self._setup.time_step).at(0)
        both = Crowd.create(np.full((2, 2), 4.0), np.zeros((2, 2)), 1.3, [[[9.0, 0.0]]] * 2)
        inside = Crowd.create([[-1.0, 0.0]], [[0.0, 0.0]], 1.3, [[[9.0, 0.0]]])
        yield "nobody", partial(self._look_at, people=Crowd.empty())
        alone = truth.people.select(np.arange(_PEOPLE) == 0)
        yield "somebody alone", partial(self._look_at, people=alone)
        yield "two people in the same place", partial(self._look_at, people=both)
        yield "somebody in the midst of the ego", partial(self._look_at, people=inside)

    def _look_at(self, sensor: PluggedInSensor, people: Crowd) -> None:
        """Show these people, then nobody, three times."""
        truth, own = _Scene(self._setup.time_step).at(0)
        alone, no_walls = truth.vehicles[:1], np.empty((0, 5))
        for _ in range(3):
            for time, there in enumerate((people, Crowd.empty())):
                n = len(there)
                tops = np.full(1, 1.5), np.full(n, ADULT)
                sensor.observe(Truth(there, alone, no_walls, float(time), *tops), np.arange(n), own)

    def bounds(self) -> str:
        scene, sensor = _Scene(self._setup.time_step), self.fresh()
        for step in range(_STEPS):
            truth, own = scene.at(step)
            people, ids, _, bound, _ = sensor.observe(truth, scene.ids, own)
            if bound is None:
                continue
            there = ids >= 0
            true = truth.people.position[np.searchsorted(scene.ids, ids[there])]
            off = np.hypot(*(people.position[there] - true).T) - bound[there]
            if (off > _SAME).any():
                who = int(ids[there][np.argmax(off)])
                return f"person {who} at step {step}: {off.max():.3g} m farther off than its bound"
        return ""

    def aliasing(self) -> str:
        copied = PluggedInSensor("it", lambda: _Copied(self._make(self._setup)))
        what = "where arrays are overwritten after the call, it answers otherwise"
        return self.unlike(self.answers(copied), what)
