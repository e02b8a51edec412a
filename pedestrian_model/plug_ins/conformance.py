"""Does somebody else's model of people keep to the rules? A battery of scenes that need no SUMO.

Each check walks one or two fresh crowds through the same made-up scene and says in words what is
wrong: a dozen people from two sides, two vehicles that pass, a wall, a red light.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import cos, sin

import numpy as np

from pedestrian_model.crowd import Crowd
from pedestrian_model.errors import DivergenceError, PlugInError
from pedestrian_model.parameters import SIM, VciParameters
from pedestrian_model.plug_ins.plug_in import Accelerations, Array, ModelSetup, Velocities, Walkers
from pedestrian_model.plug_ins.plugged_in import PluggedInModel
from pedestrian_model.surroundings import OPEN_GROUND, Surroundings, Walls
from pedestrian_model.vehicles import Vehicles

_STEPS = 80  # of each walk
_PEOPLE = 12
_SLOW = 5e-3  # [s] a tenth of the control step: what a call may take
_SAME = 1e-6  # [m] rounding, where a scene is turned or people are reordered
_TURN, _SHIFT = 0.9, np.array([120.0, -45.0])  # [rad], [m]
_MOST = 100.0  # [m/s^2] ten times what a fall gives: more is an explosion, whatever limits it


@dataclass(frozen=True)
class Finding:
    """One rule, and what breaks it.

    Attributes:
        rule: Rule in a few words.
        problem: what was seen; empty if it is kept.
    """

    rule: str
    problem: str = ""


class _Scene:
    """The made-up scene, perhaps turned and shifted, its people perhaps in another order."""

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
        if not self.turned:
            return points
        turn = np.array([[cos(_TURN), sin(_TURN)], [-sin(_TURN), cos(_TURN)]])
        placed: Array = points @ turn + _SHIFT
        return placed

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
        """Two, at a time [s]: one passes, one stands."""
        points = self.placed(np.array([[-14.0 + 4.0 * clock, 0.0], [6.0, 3.0]]))
        heading = _TURN if self.turned else 0.0
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
    begins: Callable[[str], None] | None = None,
) -> list[Finding]:
    """The battery.

    Args:
        make: makes the model for a setup.
        setup: Setup of the walks.
        parameters: bodies and limits.
        begins: told each rule before it is checked.

    Returns:
        A finding for each rule, kept or broken.
    """
    battery = _Battery(make, setup, parameters)
    try:
        battery.fresh()
    except PlugInError as error:
        return [Finding("can be made", str(error))]
    rules: dict[str, Callable[[], str]] = {
        "answers numbers": battery.usual,
        "answers in corner cases": battery.corner_cases,
        "brings people to where they want to": battery.arrives,
        "is the same when it is made again": battery.deterministic,
        "is independent of others of its kind": battery.independent,
        "starts afresh after reset": battery.restarts,
        "does not depend on the order of people": battery.order,
        "does not depend on where and how the ground lies": battery.frame,
        "keeps no array that is not its own": battery.aliasing,
        "asks for what bodies can do": battery.limits,
        "is quick": battery.quick,
    }
    findings = [Finding("can be made")]
    for rule, check in rules.items():
        if begins is not None:
            begins(rule)
        try:
            findings.append(Finding(rule, check()))
        except (PlugInError, DivergenceError) as error:
            findings.append(Finding(rule, str(error)))
        if findings[-1].problem and rule == "answers numbers":
            return findings  # nothing else can be asked
    return findings


class _Copied:
    """A model that is told in arrays of its own, which nobody overwrites."""

    def __init__(self, model: object) -> None:
        self._step = model.step  # type: ignore[attr-defined]

    def step(self, walkers: Walkers) -> object:
        return self._step(Walkers._make(array.copy() for array in walkers))


class _Watched:
    """A model whose answers and times are looked at before they are limited."""

    def __init__(self, model: object, speed: float) -> None:
        self._step = model.step  # type: ignore[attr-defined]
        self._reset = getattr(model, "reset", None)
        self._speed = speed
        self.worst, self.times = "", list[float]()

    def step(self, walkers: Walkers) -> object:
        began = time.thread_time()
        answer = self._step(walkers)
        self.times.append(time.thread_time() - began)
        fast = isinstance(answer, Velocities)
        values = answer.values if isinstance(answer, Velocities | Accelerations) else answer
        array = np.asarray(values, dtype=float)
        if array.size and array.ndim == 2:
            most = float(np.hypot(array[:, 0], array[:, 1]).max())
            if most > (self._speed * (1.0 + _SAME) if fast else _MOST):
                limit = f"{self._speed:g} m/s" if fast else f"{_MOST:g} m/s^2"
                self.worst = f"wants {most:.6g} of {limit}"
        return answer

    def reset(self) -> None:
        if self._reset is not None:
            self._reset()


class _Battery:
    """The checks; each returns what is wrong, or nothing."""

    def __init__(
        self,
        make: Callable[[ModelSetup], object],
        setup: ModelSetup,
        parameters: VciParameters,
    ) -> None:
        self._make, self._setup, self._parameters = make, setup, parameters
        self._ids = np.arange(_PEOPLE)

    def fresh(self) -> PluggedInModel:
        """A model of its own."""
        return self._hosted(lambda: self._make(self._setup))

    def _hosted(self, make: Callable[[], object]) -> PluggedInModel:
        return PluggedInModel("it", make, self._setup, self._parameters, lambda: self._ids)

    def _walk(
        self,
        model: PluggedInModel,
        scene: _Scene | None = None,
        *,
        other: PluggedInModel | None = None,
    ) -> Array:
        """Return the positions of one walk, (steps, n, 2) [m]."""
        scene = _Scene() if scene is None else scene
        crowd, beside = scene.crowd(), _Scene(seed=7)
        stranger = beside.crowd()
        track = np.zeros((_STEPS, _PEOPLE, 2))
        for step in range(_STEPS):
            clock = step * self._setup.time_step
            self._ids = scene.ids
            model.advance(crowd, scene.vehicles(clock), scene.surroundings)
            track[step] = crowd.position
            if other is not None:
                self._ids = beside.ids
                other.advance(stranger, beside.vehicles(clock), beside.surroundings)
        return track

    def _difference(self, track: Array, what: str, usual: Array | None = None) -> str:
        usual = self._walk(self.fresh()) if usual is None else usual
        off = np.hypot(*np.moveaxis(track - usual, -1, 0))
        if (off <= _SAME).all():
            return ""
        step = int(np.argmax((off > _SAME).any(axis=1)))
        return f"{what}: somebody is {off[step].max():.3g} m elsewhere after step {step}"

    def usual(self) -> str:
        self._walk(self.fresh())
        return ""

    def corner_cases(self) -> str:
        for name, crowd, vehicles, surroundings in _corner_cases():
            model, self._ids = self.fresh(), np.arange(len(crowd))
            try:
                for _ in range(3):
                    model.advance(crowd, vehicles, surroundings)
            except PlugInError as error:
                return f"{name}: {error}"
        return ""

    def arrives(self) -> str:
        model, self._ids = self.fresh(), np.arange(1)
        crowd = Crowd.create([[0.0, 0.0]], [[0.0, 0.0]], 1.3, [[[6.0, 0.0]]])
        steps = round(15.0 / self._setup.time_step)
        for _ in range(steps):
            model.advance(crowd, Vehicles.empty())
        left = float(np.hypot(*(crowd.position[0] - [6.0, 0.0])))
        return f"alone, 6 m take more than 15 s: {left:.2g} m are left" if left > 0.5 else ""

    def deterministic(self) -> str:
        return self._difference(self._walk(self.fresh()), "made again, it answers otherwise")

    def independent(self) -> str:
        track = self._walk(self.fresh(), other=self.fresh())
        return self._difference(track, "beside another one, it answers otherwise")

    def restarts(self) -> str:
        model = self.fresh()
        self._walk(model, _Scene(order=-1))
        model.reset()
        return self._difference(self._walk(model), "after reset, it answers otherwise")

    def order(self) -> str:
        track = self._walk(self.fresh(), _Scene(order=-1))[:, ::-1]
        return self._difference(track, "with the people in another order, it answers otherwise")

    def frame(self) -> str:
        turned = _Scene(turned=True)
        usual = turned.placed(self._walk(self.fresh()))
        track = self._walk(self.fresh(), turned)
        return self._difference(
            track, "with everything turned and shifted, it answers otherwise", usual
        )

    def aliasing(self) -> str:
        track = self._walk(self._hosted(lambda: _Copied(self._make(self._setup))))
        return self._difference(
            track, "where arrays are overwritten after the call, as in a run, it answers otherwise"
        )

    def limits(self) -> str:
        return self._watched().worst

    def quick(self) -> str:
        median = float(np.median(self._watched().times))
        return f"takes {1e3 * median:.1f} ms for a call" if median > _SLOW else ""

    def _watched(self) -> _Watched:
        watched = _Watched(self._make(self._setup), self._parameters.max_speed)
        self._walk(self._hosted(lambda: watched))
        return watched
