"""Does somebody else's controller keep to the rules? A battery of drives that need no SUMO.

Each check drives one or two fresh controllers through the same made-up scenes and says in words
what is wrong. The scenes are one ego on a straight road, two vehicles and a dozen people.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import cos, inf, sin
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from controller.errors import PlugInError
from controller.observation import Observation
from controller.plug_ins.plug_in import Setup
from controller.plug_ins.plugged_in import PluggedIn

if TYPE_CHECKING:
    from controller._jit import Array

_STEPS = 60  # of each drive
_PEOPLE = 12
_SLOW = 5e-3  # [s] a tenth of the control step: what a call may take
_SAME = 1e-6  # of the force limit: rounding, where a scene is turned or people are reordered
_TURN, _SHIFT = 0.9, np.array([120.0, -45.0])  # [rad], [m]


@dataclass(frozen=True)
class Finding:
    """One rule, and what breaks it.

    Attributes:
        rule: Rule in a few words.
        problem: what was seen; empty if it is kept.
    """

    rule: str
    problem: str = ""


class _People(NamedTuple):
    position: Array
    velocity: Array


@dataclass(frozen=True)
class _Path:
    """A straight path from ``start`` along ``heading``."""

    start: Array
    heading: float

    def remaining(self) -> float:
        return 60.0

    def poses(self, distances: Array) -> Array:
        ahead = np.asarray(distances, dtype=float)[:, None]
        places = self.start + ahead * np.array([cos(self.heading), sin(self.heading)])
        return np.column_stack([places, np.full(len(places), self.heading)])

    def curvature(self, distances: Array) -> Array:
        return np.zeros(len(distances))


def scene(
    step: int, horizon: int, setup: Setup, *, seed: int = 1, turned: bool = False, order: int = 1
) -> Observation:
    """Return the observation at a step of the made-up drive.

    Args:
        step: Step of the drive.
        horizon: N of the controller.
        setup: Setup of the drive.
        seed: Seed of the people.
        turned: the whole scene is turned and shifted.
        order: -1: people stand in the opposite order.
    """
    random, h = np.random.default_rng(seed), setup.time_step
    steps = np.arange(1, max(1, horizon) + 1)
    clock = step * h
    front, speed = 3.0 * clock, 3.0 + np.sin(clock)
    velocity = random.normal(0.0, 0.7, (_PEOPLE, 2))
    position = random.uniform([0.0, -8.0], [40.0, 8.0], (_PEOPLE, 2)) + clock * velocity
    position, velocity = position[::order], velocity[::order]
    heading, start = 0.0, np.array([front, 0.0])
    poses = np.zeros((len(steps), 2, 7))
    poses[:, 0, 0], poses[:, 0, 3] = front + speed * h * (steps - 1), speed
    poses[:, 1, 0], poses[:, 1, 3] = front + 18.0, 2.0
    poses[:, :, 5:] = [-5.0, 2.0]
    if turned:
        turn = np.array([[cos(_TURN), sin(_TURN)], [-sin(_TURN), cos(_TURN)]])
        position, velocity = position @ turn + _SHIFT, velocity @ turn
        start, heading = start @ turn + _SHIFT, _TURN
        poses[:, :, :2] = poses[:, :, :2] @ turn + _SHIFT
        poses[:, :, 2] = _TURN
    gap = 25.0 - 20.0 * np.sin(0.5 * clock + seed) ** 2
    return Observation(
        position=front,
        speed=float(speed),
        gap=float(gap),
        obstacle_positions=front + gap + 0.5 * h * steps,
        speed_limit=setup.reference_speed,
        safe_distance=setup.safe_distance,
        time=clock,
        path=_Path(start, heading),
        people=_People(np.ascontiguousarray(position), np.ascontiguousarray(velocity)),
        vehicles=poses,
        lane_speeds=np.full(len(steps), 13.9),
        person_gap=float(gap),
        leader_gap=18.0,
        leader_speed=2.0,
        person_ids=np.arange(_PEOPLE)[::order].copy(),
    )


def _corner_cases(setup: Setup, horizon: int) -> Iterator[tuple[str, Observation]]:
    usual = scene(5, horizon, setup)
    none = np.full(len(usual.obstacle_positions), inf)
    nobody = _People(np.zeros((0, 2)), np.zeros((0, 2)))
    free = usual.replaced(
        gap=inf, person_gap=inf, leader_gap=inf, leader_speed=0.0, obstacle_positions=none
    )
    yield "nothing in front", free
    yield "nobody at all", free.replaced(people=nobody, person_ids=np.zeros(0, dtype=np.int64))
    yield (
        "no people, vehicles or lanes known",
        free.replaced(people=None, person_ids=None, vehicles=None, lane_speeds=None, path=None),
    )
    yield "standing", usual.replaced(speed=0.0)
    yield "rolling back a little", usual.replaced(speed=-1e-9)
    yield "in front at once", usual.replaced(gap=0.0, person_gap=0.0, leader_gap=0.0)
    yield "overlapping", usual.replaced(gap=-0.5, person_gap=-0.5, leader_gap=-0.5)
    yield "a limit of 0", usual.replaced(speed_limit=0.0, stop_gap=0.0)
    yield "no limit", usual.replaced(speed_limit=inf)


def check_controller(
    make: Callable[[Setup], object], setup: Setup, begins: Callable[[str], None] | None = None
) -> list[Finding]:
    """The battery.

    Args:
        make: makes the controller for a setup.
        setup: Setup of the drives.
        begins: told each rule before it is checked.

    Returns:
        A finding for each rule, kept or broken.
    """
    try:
        horizon = PluggedIn("it", lambda: make(setup), setup).horizon
    except PlugInError as error:
        return [Finding("can be made", str(error))]
    battery = _Battery(make, setup, horizon)
    rules: dict[str, Callable[[], str]] = {
        "answers numbers": battery.usual,
        "answers in corner cases": battery.corner_cases,
        "is the same when it is made again": battery.deterministic,
        "is independent of others of its kind": battery.independent,
        "starts afresh after reset": battery.restarts,
        "does not depend on the order of people": battery.order,
        "does not depend on where and how the road lies": battery.frame,
        "keeps no array that is not its own": battery.aliasing,
        "keeps within the actuator's limit": battery.limits,
        "is quick": battery.quick,
    }
    findings = [Finding("can be made")]
    for rule, check in rules.items():
        if begins is not None:
            begins(rule)
        try:
            findings.append(Finding(rule, check()))
        except PlugInError as error:
            findings.append(Finding(rule, str(error)))
        if findings[-1].problem and rule == "answers numbers":
            return findings  # nothing else can be asked
    return findings


class _Battery:
    """The checks; each returns what is wrong, or nothing."""

    def __init__(self, make: Callable[[Setup], object], setup: Setup, horizon: int) -> None:
        self._make, self._setup, self._horizon = make, setup, horizon
        self._wide = setup._replace(force_limit=inf)

    def _fresh(self) -> PluggedIn:
        """One whose answers are not limited afterwards; it is told the true limit."""
        return PluggedIn("it", lambda: self._make(self._setup), self._wide)

    def _drive(
        self,
        controller: PluggedIn,
        *,
        spoil: bool = False,
        other: PluggedIn | None = None,
        turned: bool = False,
        order: int = 1,
    ) -> Array:
        forces = np.zeros(_STEPS)
        for step in range(_STEPS):
            seen = scene(step, self._horizon, self._setup, turned=turned, order=order)
            last = forces[step - 1] if step else 0.0
            forces[step] = controller.control(seen.replaced(force=last)).force
            if spoil:
                _spoil(seen)
            if other is not None:
                other.control(scene(step, self._horizon, self._setup, seed=7))
        return forces

    def _difference(self, forces: Array, what: str) -> str:
        usual = self._drive(self._fresh())
        apart = np.abs(forces - usual)
        if (apart <= _SAME * self._setup.force_limit).all():
            return ""
        step = int(np.argmax(apart > _SAME * self._setup.force_limit))
        return f"{what}: {forces[step]:.6g} N in place of {usual[step]:.6g} N at step {step}"

    def usual(self) -> str:
        self._drive(self._fresh())
        return ""

    def corner_cases(self) -> str:
        for name, seen in _corner_cases(self._setup, self._horizon):
            try:
                self._fresh().control(seen)
            except PlugInError as error:
                return f"{name}: {error}"
        return ""

    def deterministic(self) -> str:
        return self._difference(self._drive(self._fresh()), "made again, it answers otherwise")

    def independent(self) -> str:
        forces = self._drive(self._fresh(), other=self._fresh())
        return self._difference(forces, "beside another one, it answers otherwise")

    def restarts(self) -> str:
        controller = self._fresh()
        self._drive(controller, order=-1)
        controller.reset()
        return self._difference(self._drive(controller), "after reset, it answers otherwise")

    def order(self) -> str:
        forces = self._drive(self._fresh(), order=-1)
        return self._difference(forces, "with the people in another order, it answers otherwise")

    def frame(self) -> str:
        forces = self._drive(self._fresh(), turned=True)
        return self._difference(forces, "with everything turned and shifted, it answers otherwise")

    def aliasing(self) -> str:
        forces = self._drive(self._fresh(), spoil=True)
        return self._difference(
            forces,
            "with arrays overwritten after the call, as the next step does, it answers otherwise",
        )

    def limits(self) -> str:
        limit = self._setup.force_limit
        forces = [*self._drive(self._fresh())]
        cases = _corner_cases(self._setup, self._horizon)
        forces += [self._fresh().control(seen).force for _, seen in cases]
        worst = max(forces, key=abs)
        return f"wants {worst:.6g} N of {limit:g} N" if abs(worst) > limit * (1 + _SAME) else ""

    def quick(self) -> str:
        controller, times = self._fresh(), []
        for step in range(_STEPS):
            seen = scene(step, self._horizon, self._setup)
            began = time.thread_time()
            controller.control(seen)
            times.append(time.thread_time() - began)
        median = float(np.median(times))
        return f"takes {1e3 * median:.1f} ms for a call" if median > _SLOW else ""


def _spoil(seen: Observation) -> None:
    people = seen.people
    arrays = [seen.obstacle_positions, seen.vehicles, seen.lane_speeds]
    arrays += [] if people is None else [people.position, people.velocity]
    for array in arrays:
        if array is not None:
            array += 1e3
