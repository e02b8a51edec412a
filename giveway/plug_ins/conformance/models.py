"""The conformance kit of pedestrian models: a battery of walks that need no SUMO.

Each check walks one or two fresh crowds through the same made-up scene and says in words what is
wrong: a dozen people from two sides, two vehicles that pass, a wall, a red light.
"""

from collections.abc import Callable, Iterator
from copy import deepcopy
from functools import partial
from typing import Any

import numpy as np

from giveway.plug_ins.conformance.battery import TURN, Array, Battery, Begins, Finding, moved
from giveway.plug_ins.plugged_in_model import PluggedInModel
from pedestrian_model import (
    OPEN_GROUND,
    SIM,
    Accelerations,
    Crowd,
    DivergenceError,
    ModelSetup,
    PlugInError,
    Surroundings,
    VciParameters,
    Vehicles,
    Velocities,
    Walkers,
    Walls,
)

_STEPS = 80  # Steps of each walk
_PEOPLE = 12
_SAME = 1e-6  # Rounding [m] in turned or reordered scenes
_MOST = 100.0  # Acceleration [m/s^2], ten times that of a fall; more is an explosion


class _Scene:
    """The made-up scene, which may be turned and shifted, with its people in another order."""

    def __init__(self, *, seed: int = 1, turned: bool = False, order: int = 1) -> None:
        random = np.random.default_rng(seed)
        side = np.where(np.arange(_PEOPLE) % 2, 1.0, -1.0)
        start = np.column_stack([random.uniform(-6.0, 6.0, _PEOPLE), side * 7.0])
        start[:, 1] += random.uniform(-2.0, 2.0, _PEOPLE)
        goal = start * [1.0, -1.0]
        self.speed = random.uniform(0.9, 1.7, _PEOPLE)[::order]
        self.turned = turned
        self.start, self.goal = self.placed(start)[::order], self.placed(goal)[::order]
        self.ids = (1000 + 7 * np.arange(_PEOPLE))[::order].copy()
        self.light = np.where(np.arange(_PEOPLE) == 3, 0, -1)[::order]
        ends = self.placed(np.array([[9.0, -12.0], [9.0, 12.0]]))
        self.surroundings = Surroundings(Walls.create([ends.ravel()]), np.array([True]))

    def placed(self, points: Array) -> Array:
        """Points [m] of the scene where they lie."""
        return moved(points) if self.turned else points

    def crowd(self) -> Crowd:
        """The people at the beginning; one of them has a red light ahead."""
        halfway = 0.5 * (self.start + self.goal)
        ways = [np.stack(both) for both in zip(halfway, self.goal, strict=True)]
        return Crowd.create(
            self.start,
            np.zeros_like(self.start),
            self.speed,
            ways,
            signals=[np.array([light, -1]) for light in self.light],
        )

    def vehicles(self, clock: float) -> Vehicles:
        """The two vehicles at the time ``clock`` [s], of which one passes and one stands."""
        points = self.placed(np.array([[-14.0 + 4.0 * clock, 0.0], [6.0, 3.0]]))
        heading = TURN if self.turned else 0.0
        return Vehicles.create(points[:, 0], points[:, 1], heading, [4.0, 0.0])


def _corner_cases() -> Iterator[tuple[str, Crowd, Vehicles, Surroundings]]:
    car = Vehicles.create([0.0], [0.0], [0.0], [3.0])
    wall = Surroundings(Walls.create([[-5.0, 0.0, 5.0, 0.0]]))
    far = [[20.0, 0.0]]
    one = Crowd.create([[3.0, 3.0]], [[0.0, 0.0]], 1.3, [far])
    yield "somebody alone, no vehicle", one, Vehicles.empty(), OPEN_GROUND
    there = Crowd.create([[3.0, 3.0]], [[0.0, 0.0]], 1.3, [[[3.0, 3.0]]])
    yield "somebody at the goal", there, car, OPEN_GROUND
    inside = Crowd.create([[0.0, 0.0]], [[0.0, 0.0]], 1.3, [far])
    yield "somebody in the midst of a vehicle", inside, car, OPEN_GROUND
    both = Crowd.create(np.full((2, 2), 4.0), np.zeros((2, 2)), 1.3, [far, far])
    yield "two people in the same place", both, car, OPEN_GROUND
    yield (
        "somebody on a wall",
        Crowd.create([[1.0, 0.0]], [[0.5, 0.0]], 1.3, [far]),
        car,
        wall,
    )
    yield (
        "somebody who does not want to walk",
        Crowd.create([[3.0, 3.0]], [[0.0, 0.0]], 0.0, [far]),
        car,
        OPEN_GROUND,
    )


def check_model(
    make: Callable[[ModelSetup], object],
    setup: ModelSetup,
    parameters: VciParameters = SIM,
    begins: Begins | None = None,
) -> list[Finding]:
    """Return a finding for each rule of pedestrian models, kept or broken.

    Args:
        make: Function that makes the model for a setup.
        setup: Setup of the walks.
        parameters: Bodies and limits of the people.
        begins: Function that is told each rule before it is checked, or None.
    """
    return _Battery(make, setup, parameters).findings(begins)


class _Copied:
    """A model that gets copies of all arrays, which are not overwritten later."""

    def __init__(self, model: object) -> None:
        self._step = model.step  # type: ignore[attr-defined]

    def step(self, walkers: Walkers) -> object:
        return self._step(deepcopy(walkers))


class _Watched:
    """A model whose answers are examined before they are limited."""

    def __init__(self, model: object, speed: float) -> None:
        self._step = model.step  # type: ignore[attr-defined]
        self._speed = speed
        self.worst = ""

    def step(self, walkers: Walkers) -> object:
        answer = self._step(walkers)
        fast = isinstance(answer, Velocities)
        values = answer.values if isinstance(answer, Velocities | Accelerations) else answer
        array = np.asarray(values, dtype=float)
        if array.size and array.ndim == 2:
            most = float(np.hypot(array[:, 0], array[:, 1]).max())
            if most > (self._speed * (1.0 + _SAME) if fast else _MOST):
                limit = f"{self._speed:g} m/s" if fast else f"{_MOST:g} m/s^2"
                self.worst = f"wants {most:.6g} of {limit}"
        return answer


class _Battery(Battery[PluggedInModel, Array]):
    faults = (PlugInError, DivergenceError)
    method = "advance"

    def __init__(
        self,
        make: Callable[[ModelSetup], object],
        setup: ModelSetup,
        parameters: VciParameters,
    ) -> None:
        self._make, self._setup, self._parameters = make, setup, parameters
        self._ids = np.arange(_PEOPLE)

    def rules(self) -> dict[str, Callable[[], str]]:
        return {
            "can be made": self.can_be_made,
            "answers numbers": self.usual,
            "answers in corner cases": self.in_corner_cases,
            "brings people to where they want to": self.arrives,
            "is the same when it is made again": self.deterministic,
            "is independent of others of its kind": self.independent,
            "starts afresh after reset": self.restarts,
            "does not depend on the order of people": self.unordered,
            "does not depend on where and how the ground lies": self.unturned,
            "keeps no array that is not its own": self.aliasing,
            "asks for what bodies can do": self.limits,
            "is quick": self.quick,
        }

    def fresh(self) -> PluggedInModel:
        return self._hosted(lambda: self._make(self._setup))

    def _hosted(self, make: Callable[[], object]) -> PluggedInModel:
        return PluggedInModel("it", make, self._setup, self._parameters, lambda: self._ids)

    def answers(
        self,
        hosted: PluggedInModel,
        *,
        other: PluggedInModel | None = None,
        order: int = 1,
        turned: bool = False,
    ) -> Array:
        """Return the positions of one walk as in the usual order and place, (steps, n, 2) [m]."""
        scene, beside = _Scene(order=order, turned=turned), _Scene(seed=7)
        crowd, stranger = scene.crowd(), beside.crowd()
        track = np.zeros((_STEPS, _PEOPLE, 2))
        for step in range(_STEPS):
            clock = step * self._setup.time_step
            self._ids = scene.ids
            hosted.advance(crowd, scene.vehicles(clock), scene.surroundings)
            track[step] = crowd.position
            if other is not None:
                self._ids = beside.ids
                other.advance(stranger, beside.vehicles(clock), beside.surroundings)
        return track[:, ::order]

    def difference(self, found: Array, usual: Array) -> str:
        off = np.hypot(*np.moveaxis(found - usual, -1, 0))
        if (off <= _SAME).all():
            return ""
        step = int(np.argmax((off > _SAME).any(axis=1)))
        return f"somebody is {off[step].max():.3g} m elsewhere after step {step}"

    def corner_cases(self) -> Iterator[tuple[str, Callable[[PluggedInModel], object]]]:
        for name, *case in _corner_cases():
            yield name, partial(self._walk_a_little, case=case)

    def _walk_a_little(self, model: PluggedInModel, case: list[Any]) -> None:
        self._ids = np.arange(len(case[0]))
        for _ in range(3):
            model.advance(*case)

    def unturned(self) -> str:
        found = self.answers(self.fresh(), turned=True)
        difference = self.difference(found, moved(self.answers(self.fresh())))
        what = "with everything turned and shifted, it answers otherwise"
        return f"{what}: {difference}" if difference else ""

    def arrives(self) -> str:
        model, self._ids = self.fresh(), np.arange(1)
        crowd = Crowd.create([[0.0, 0.0]], [[0.0, 0.0]], 1.3, [[[6.0, 0.0]]])
        steps = round(15.0 / self._setup.time_step)
        for _ in range(steps):
            model.advance(crowd, Vehicles.empty())
        left = float(np.hypot(*(crowd.position[0] - [6.0, 0.0])))
        return f"alone, 6 m take more than 15 s: {left:.2g} m are left" if left > 0.5 else ""

    def aliasing(self) -> str:
        return self.unlike(
            self.answers(self._hosted(lambda: _Copied(self._make(self._setup)))),
            "where arrays are overwritten after the call, as in a run, it answers otherwise",
        )

    def limits(self) -> str:
        watched = _Watched(self._make(self._setup), self._parameters.max_speed)
        self.answers(self._hosted(lambda: watched))
        return watched.worst
