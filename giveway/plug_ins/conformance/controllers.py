"""The conformance kit of controllers: a battery of drives that need no SUMO.

Each check drives one or two fresh controllers through the same made-up scenes and says in words
what is wrong. The scenes are one ego on a straight road, two vehicles and a dozen people.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from math import cos, inf, sin
from typing import NamedTuple

import numpy as np

from controller import Observation, PlugInError, Setup
from giveway.plug_ins.conformance.battery import TURN, Array, Battery, Begins, Finding, moved
from giveway.plug_ins.conformance.battery import turned as turn
from giveway.plug_ins.plugged_in_controller import PluggedIn

_STEPS = 60  # Steps of each drive
_PEOPLE = 12
_SAME = 1e-6  # Rounding, as a share of the force limit, in turned or reordered scenes


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
        horizon: Prediction horizon N of the controller [steps].
        setup: Setup of the drive.
        seed: Seed of the people.
        turned: Whether the whole scene is turned and shifted.
        order: Step through the people: 1, or -1 for the opposite order.
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
        position, velocity = moved(position), turn(velocity)
        start, heading = moved(start), TURN
        poses[:, :, :2] = moved(poses[:, :, :2])
        poses[:, :, 2] = TURN
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
    make: Callable[[Setup], object], setup: Setup, begins: Begins | None = None
) -> list[Finding]:
    """Return a finding for each rule of controllers, kept or broken.

    Args:
        make: Function that makes the controller for a setup.
        setup: Setup of the drives.
        begins: Function that is told each rule before it is checked, or None.
    """
    return _Battery(make, setup).findings(begins)


class _Battery(Battery[PluggedIn, Array]):
    faults = (PlugInError,)
    method = "control"

    def __init__(self, make: Callable[[Setup], object], setup: Setup) -> None:
        self._make, self._setup = make, setup
        self._wide = setup._replace(force_limit=inf)

    def rules(self) -> dict[str, Callable[[], str]]:
        return {
            "can be made": self.can_be_made,
            "answers numbers": self.usual,
            "answers in corner cases": self.in_corner_cases,
            "is the same when it is made again": self.deterministic,
            "is independent of others of its kind": self.independent,
            "starts afresh after reset": self.restarts,
            "does not depend on the order of people": self.unordered,
            "does not depend on where and how the road lies": self.unturned,
            "keeps no array that is not its own": self.aliasing,
            "keeps within the actuator's limit": self.limits,
            "is quick": self.quick,
        }

    def fresh(self) -> PluggedIn:
        """Return one whose answers are not limited afterwards; it is told the true limit."""
        return PluggedIn("it", lambda: self._make(self._setup), self._wide)

    @cached_property
    def _horizon(self) -> int:
        return self.fresh().horizon

    def answers(
        self,
        hosted: PluggedIn,
        *,
        other: PluggedIn | None = None,
        order: int = 1,
        turned: bool = False,
        spoil: bool = False,
    ) -> Array:
        forces = np.zeros(_STEPS)
        for step in range(_STEPS):
            seen = scene(step, self._horizon, self._setup, turned=turned, order=order)
            last = forces[step - 1] if step else 0.0
            forces[step] = hosted.control(seen.replaced(force=last)).force
            if spoil:
                _spoil(seen)
            if other is not None:
                other.control(scene(step, self._horizon, self._setup, seed=7))
        return forces

    def difference(self, found: Array, usual: Array) -> str:
        apart = np.abs(found - usual) > _SAME * self._setup.force_limit
        if not apart.any():
            return ""
        step = int(np.argmax(apart))
        return f"{found[step]:.6g} N in place of {usual[step]:.6g} N at step {step}"

    def corner_cases(self) -> Iterator[tuple[str, Callable[[PluggedIn], object]]]:
        for name, seen in _corner_cases(self._setup, self._horizon):
            yield name, partial(PluggedIn.control, observation=seen)

    def aliasing(self) -> str:
        return self.unlike(
            self.answers(self.fresh(), spoil=True),
            "with arrays overwritten after the call, as the next step does, it answers otherwise",
        )

    def limits(self) -> str:
        limit = self._setup.force_limit
        forces = [*self.answers(self.fresh())]
        cases = _corner_cases(self._setup, self._horizon)
        forces += [self.fresh().control(seen).force for _, seen in cases]
        worst = max(forces, key=abs)
        return f"wants {worst:.6g} N of {limit:g} N" if abs(worst) > limit * (1 + _SAME) else ""


def _spoil(seen: Observation) -> None:
    people = seen.people
    arrays = [seen.obstacle_positions, seen.vehicles, seen.lane_speeds]
    arrays += [] if people is None else [people.position, people.velocity]
    for array in arrays:
        if array is not None:
            array += 1e3
