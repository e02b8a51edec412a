"""Checks that a sensor keeps to the protocol, by made-up scenes that need no SUMO.

A dozen people walk past a car that drives by a parked car and a wall.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from math import cos, sin

import numpy as np

from giveway.ego.perception.plugged_in_sensor import PluggedInSensor
from giveway.ego.perception.protocol import Ids, OwnState, Percept, SensorSetup
from giveway.ego.perception.truth import Truth
from giveway.errors import SensorError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import Pose
from pedestrian_model import Crowd

_STEPS = 60  # number of observations in each scene
_PEOPLE = 12
_SLOW = 5e-3  # longest permitted time [s] of an observation: a tenth of the control step
_SAME = 1e-9  # tolerance [m] of equal positions
_TURN, _SHIFT = 0.9, np.array([120.0, -45.0])  # [rad], [m]
_SHAPE = VehicleShape(4.5, 1.8)
_PARKED = 8.0, 4.0, 0.0, 0.0, 2.25, 2.25, 1.8  # x, y [m], heading, speed, front, rear, width


@dataclass(frozen=True)
class Finding:
    """One rule, and what breaks it.

    Attributes:
        rule: Rule in a few words.
        problem: Observation that breaks the rule; empty if the rule is kept.
    """

    rule: str
    problem: str = ""


class _Scene:
    """The made-up scene, perhaps turned and shifted, with its people perhaps in reverse order."""

    def __init__(self, time_step: float, *, turned: bool = False, order: int = 1) -> None:
        random = np.random.default_rng(1)
        self._time_step, self._turn = time_step, _TURN if turned else 0.0
        self._shift = _SHIFT if turned else np.zeros(2)
        self._start = random.uniform((0.0, -9.0), (40.0, 9.0), (_PEOPLE, 2))[::order]
        self._velocity = random.uniform(-1.5, 1.5, (_PEOPLE, 2))[::order]
        self.ids = np.ascontiguousarray(3 + 2 * np.arange(_PEOPLE)[::order])

    def _placed(self, points: Array) -> Array:
        """The points [m] of the scene, turned and shifted."""
        return np.asarray(self._turned(points) + self._shift)

    def _turned(self, vectors: Array) -> Array:
        c, s = cos(self._turn), sin(self._turn)
        return np.asarray(vectors @ np.array([[c, s], [-s, c]]))

    def at(self, step: int) -> tuple[Truth, OwnState]:
        """The truth and the own state at a control step."""
        clock = step * self._time_step
        here = self._start + clock * self._velocity
        goals = list(self._placed(here + 20.0 * self._velocity)[:, None])
        people = Crowd.create(self._placed(here), self._turned(self._velocity), 1.3, goals)
        front = np.array([[4.0 * clock, 0.0]])
        middle = front - [[_SHAPE.length / 2.0, 0.0]]
        vehicles = np.array([(*middle[0], 0.0, 4.0, 2.25, 2.25, _SHAPE.width), _PARKED])
        vehicles[:, :2] = self._placed(vehicles[:, :2])
        vehicles[:, 2] += self._turn
        wall = self._placed(np.array([[15.0, 5.0], [25.0, 5.0]])).reshape(1, 4)
        x, y = self._placed(front)[0].tolist()
        pose = Pose(x, y, self._turn)
        return Truth(people, vehicles, wall, clock), OwnState(pose, 4.0, 0, _SHAPE)


def check_sensor(
    make: Callable[[SensorSetup], object],
    setup: SensorSetup,
    begins: Callable[[str], None] | None = None,
) -> list[Finding]:
    """The battery.

    Args:
        make: Function that makes the sensor for a setup.
        setup: Setup of the scenes.
        begins: Function that is told each rule before it is checked; None if nobody listens.

    Returns:
        A finding for each rule, kept or broken.
    """
    battery = _Battery(make, setup)
    try:
        battery.fresh()
    except SensorError as error:
        return [Finding("can be made", str(error))]
    rules: dict[str, Callable[[], str]] = {
        "answers with a percept": battery.usual,
        "answers in corner cases": battery.corner_cases,
        "keeps to the bounds that it claims": battery.bounds,
        "perceives the same when it is made again": battery.deterministic,
        "is independent of others of its kind": battery.independent,
        "does not depend on the order of people": battery.order,
        "does not depend on where and how the ground lies": battery.frame,
        "keeps no array that is not its own": battery.aliasing,
        "is quick": battery.quick,
    }
    findings = [Finding("can be made")]
    for rule, check in rules.items():
        if begins is not None:
            begins(rule)
        try:
            findings.append(Finding(rule, check()))
        except SensorError as error:
            findings.append(Finding(rule, str(error)))
        if findings[-1].problem and rule == "answers with a percept":
            return findings  # nothing else can be asked
    return findings


class _Copied:
    """A sensor that gets copies of all arrays, which are not overwritten later."""

    def __init__(self, sensor: object) -> None:
        self._observe = sensor.observe  # type: ignore[attr-defined]

    def observe(self, truth: Truth, person_ids: Ids, ego: OwnState) -> Percept:
        everybody = np.ones(len(person_ids), dtype=np.bool_)
        own = Truth(truth.people.select(everybody), truth.vehicles, truth.outlines, truth.time)
        answer: Percept = self._observe(own, person_ids, ego)
        return answer


_Perceived = list[tuple[Ids, Array]]  # by step: person ids in ascending order, positions [m]


class _Battery:
    """The checks; each returns what is wrong, or nothing."""

    def __init__(self, make: Callable[[SensorSetup], object], setup: SensorSetup) -> None:
        self._make, self._setup = make, setup

    def fresh(self) -> PluggedInSensor:
        """A new sensor."""
        return PluggedInSensor("it", lambda: self._make(self._setup))

    def _watch(
        self,
        sensor: PluggedInSensor,
        *,
        turned: bool = False,
        order: int = 1,
        other: PluggedInSensor | None = None,
    ) -> _Perceived:
        scene = _Scene(self._setup.time_step, turned=turned, order=order)
        perceived = []
        for step in range(_STEPS):
            truth, own = scene.at(step)
            people, ids, _, _ = sensor.observe(truth, scene.ids, own)
            rows = np.argsort(ids)
            perceived.append((ids[rows], people.position[rows]))
            if other is not None:
                other.observe(truth, scene.ids, own)
        return perceived

    def _difference(self, perceived: _Perceived, what: str, *, ids_only: bool = False) -> str:
        for step, (usual, now) in enumerate(zip(self._watch(self.fresh()), perceived, strict=True)):
            others = set(usual[0].tolist()) ^ set(now[0].tolist())
            if others:
                return f"{what}: at step {step} person {min(others)} is perceived once only"
            if not ids_only and len(now[0]) and np.abs(usual[1] - now[1]).max() > _SAME:
                return f"{what}: at step {step} somebody is perceived elsewhere"
        return ""

    def usual(self) -> str:
        self._watch(self.fresh())
        return ""

    def corner_cases(self) -> str:
        truth, own = _Scene(self._setup.time_step).at(0)
        alone = truth.vehicles[:1]
        nobody, one = Crowd.empty(), truth.people.select(np.arange(_PEOPLE) == 0)
        both = Crowd.create(np.full((2, 2), 4.0), np.zeros((2, 2)), 1.3, [[[9.0, 0.0]]] * 2)
        inside = Crowd.create([[-1.0, 0.0]], [[0.0, 0.0]], 1.3, [[[9.0, 0.0]]])
        for name, people in (
            ("nobody", nobody),
            ("somebody alone", one),
            ("two people in the same place", both),
            ("somebody in the midst of the ego", inside),
        ):
            sensor, bare = self.fresh(), Truth(people, alone, np.empty((0, 4)), 0.0)
            try:
                for _ in range(3):
                    sensor.observe(bare, np.arange(len(people)), own)
                    sensor.observe(Truth(nobody, alone, bare.outlines, 1.0), np.arange(0), own)
            except SensorError as error:
                return f"{name}: {error}"
        return ""

    def bounds(self) -> str:
        scene, sensor = _Scene(self._setup.time_step), self.fresh()
        for step in range(_STEPS):
            truth, own = scene.at(step)
            people, ids, _, bound = sensor.observe(truth, scene.ids, own)
            if bound is None:
                continue
            true = truth.people.position[np.searchsorted(scene.ids, ids)]
            off = np.hypot(*(people.position - true).T) - bound
            if (off > _SAME).any():
                who = int(ids[np.argmax(off)])
                return f"person {who} at step {step}: {off.max():.3g} m farther off than its bound"
        return ""

    def deterministic(self) -> str:
        return self._difference(self._watch(self.fresh()), "made again, it answers otherwise")

    def independent(self) -> str:
        perceived = self._watch(self.fresh(), other=self.fresh())
        return self._difference(perceived, "beside another one, it answers otherwise")

    def order(self) -> str:
        perceived = self._watch(self.fresh(), order=-1)
        return self._difference(perceived, "with the people in another order, it answers otherwise")

    def frame(self) -> str:
        perceived = self._watch(self.fresh(), turned=True)
        return self._difference(perceived, "with everything turned and shifted", ids_only=True)

    def aliasing(self) -> str:
        copied = PluggedInSensor("it", lambda: _Copied(self._make(self._setup)))
        return self._difference(
            self._watch(copied), "where arrays are overwritten after the call, it answers otherwise"
        )

    def quick(self) -> str:
        scene, sensor, times = _Scene(self._setup.time_step), self.fresh(), []
        for step in range(_STEPS):
            truth, own = scene.at(step)
            began = time.thread_time()
            sensor.observe(truth, scene.ids, own)
            times.append(time.thread_time() - began)
        median = float(np.median(times))
        return f"takes {1e3 * median:.1f} ms for an observation" if median > _SLOW else ""
