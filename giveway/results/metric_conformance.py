"""The conformance kit of metrics: a battery of made-up drives that need no SUMO.

An ego slows down, stands and drives on past a dozen people and behind a vehicle. Each check says in
words what is wrong.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from giveway.config import EgoRunConfig
from giveway.errors import MetricError
from giveway.geometry.bodies import BODY
from giveway.geometry.kernel import Array
from giveway.metrics.plugged_in import DeclaredMetric
from giveway.plug_ins.conformance.battery import TURN, Battery, Begins, Finding, moved
from giveway.plug_ins.conformance.battery import turned as turn
from giveway.results.ego_result import EgoResult
from giveway.run_data.progress import Ending
from giveway.run_data.tracks import BackgroundTrack, CrowdTrack, EgoTrack, PredictionTrack

_STEPS = 200  # Control instants of the drive
_PEOPLE = 12
_SAME = 1e-6  # Rounding, as a share of the number, in turned or reordered drives
_GOAL = 60.0  # Distance [m] after which the drive is complete
_NOWHERE: Array = np.empty(0)
_NOTHING_PREDICTED = PredictionTrack(
    _NOWHERE, np.empty(0, dtype=np.int64), _NOWHERE, _NOWHERE, _NOWHERE
)


def made_up_drive(
    config: EgoRunConfig | None = None,
    time_step: float = 0.05,
    *,
    people: int = _PEOPLE,
    steps: int = _STEPS,
    order: int = 1,
    turned: bool = False,
    seed: int = 1,
) -> EgoResult:
    """Return the drive that the battery measures, for tests of metrics as well.

    Args:
        config: Configuration of the ego, or None for the defaults.
        time_step: Control step [s].
        people: Number of people, of whom the first comes into contact with the ego.
        steps: Number of control instants.
        order: -1 if people are numbered in the opposite order.
        turned: True if everything is turned and shifted.
        seed: Seed of the people.
    """
    config = config or EgoRunConfig()
    time: Array = time_step * np.arange(steps, dtype=np.float64)
    speed = np.maximum(0.0, 4.0 + 5.0 * np.cos(0.8 * time))
    driven = np.concatenate([[0.0], np.cumsum(0.5 * time_step * (speed[1:] + speed[:-1]))])
    place, heading = np.column_stack([driven, np.zeros(steps)]), np.zeros(steps)
    random = np.random.default_rng(seed)
    start = random.uniform((0.0, -8.0), (50.0, 8.0), (people, 2))
    start[:1] = 8.0, 0.0
    velocity = random.normal(0.0, 0.7, (people, 2))
    walks = (start + time[:, None, None] * velocity)[:, ::order].reshape(-1, 2)
    velocities = np.tile(velocity[::order], (steps, 1))
    leader = place + (15.0, 0.0)
    if turned:
        place, walks, leader = moved(place), moved(walks), moved(leader)
        velocities, heading = turn(velocities), heading + TURN
    track = EgoTrack(
        time=time,
        position=driven,
        front_x=place[:, 0],
        front_y=place[:, 1],
        heading=heading,
        speed=speed,
        acceleration=np.concatenate([[0.0], np.diff(speed) / time_step]),
        force=np.zeros(steps),
        controller=np.full(steps, "mpc"),
        reason=np.full(steps, "free"),
        solver_status=np.full(steps, ""),
        solver_iterations=np.zeros(steps, dtype=np.int64),
        gap=np.full(steps, np.inf),
        reference_speed=np.full(steps, 9.0),
        vehicle_gap=np.full(steps, 10.0),
        stop_gap=np.full(steps, np.inf),
        waits_for=np.where(speed > 0.0, "", "person"),
    )
    return EgoResult(
        config=config,
        id="ego",
        shape=BODY,
        goal=_GOAL,
        first=0,
        track=track,
        ending=Ending.TIME_LIMIT,
        crowd=_crowd(walks, velocities, steps, order),
        predictions=_NOTHING_PREDICTED,
        background=BackgroundTrack(
            time=time,
            id=np.full(steps, "leader"),
            type=np.full(steps, "car"),
            x=leader[:, 0],
            y=leader[:, 1],
            heading=heading,
            speed=speed,
            length=np.full(steps, 5.0),
            width=np.full(steps, 2.0),
        ),
    )


def _crowd(walks: Array, velocities: Array, steps: int, order: int) -> CrowdTrack:
    people = len(walks) // steps
    return CrowdTrack(
        step=np.repeat(np.arange(steps), people),
        pedestrian=np.tile(np.arange(people), steps),
        x=walks[:, 0],
        y=walks[:, 1],
        vx=velocities[:, 0],
        vy=velocities[:, 1],
        ids=tuple(f"p{k}" for k in range(people))[::order],
    )


def check_metric(
    make: Callable[[], DeclaredMetric],
    config: EgoRunConfig | None = None,
    time_step: float = 0.05,
    begins: Begins | None = None,
) -> list[Finding]:
    """Return a finding for each rule of metrics, kept or broken.

    Args:
        make: Function that returns the metric with its options, as a run declares it.
        config: Configuration of the ego, or None for the defaults.
        time_step: Control step [s] of the drives.
        begins: Function that is called with each rule before it is checked, or None.
    """
    return _Battery(make, partial(made_up_drive, config, time_step)).findings(begins)


class _Battery(Battery[DeclaredMetric, dict[str, float]]):
    faults = (MetricError,)
    method = "measure"
    longest = 0.5

    def __init__(self, make: Callable[[], DeclaredMetric], drive: Callable[..., EgoResult]) -> None:
        self._make, self._drive = make, drive

    def rules(self) -> dict[str, Callable[[], str]]:
        return {
            "declares its columns": self.can_be_made,
            "answers with its columns": self.usual,
            "answers in corner cases": self.in_corner_cases,
            "is the same when it is made again": self.deterministic,
            "is independent of others of its kind": self.independent,
            "does not depend on the order of people": self.unordered,
            "does not depend on where and how the road lies": self.unturned,
            "changes nothing of the drive": self.drive_kept,
            "is quick": self.quick,
        }

    def fresh(self) -> DeclaredMetric:
        return self._make()

    @cached_property
    def _another(self) -> EgoResult:
        return self._drive(people=5, seed=7)

    def answers(
        self,
        hosted: DeclaredMetric,
        *,
        other: DeclaredMetric | None = None,
        order: int = 1,
        turned: bool = False,
    ) -> dict[str, float]:
        drive = self._drive(order=order, turned=turned)
        if other is not None:
            other.measure(self._another)
        return hosted.measure(drive)

    def difference(self, found: dict[str, float], usual: dict[str, float]) -> str:
        for name, value in found.items():
            same = math.isclose(value, usual[name], rel_tol=_SAME, abs_tol=_SAME)
            if not same and not (math.isnan(value) and math.isnan(usual[name])):
                return f"{name} is {value:.6g} in place of {usual[name]:.6g}"
        return ""

    def corner_cases(self) -> Iterator[tuple[str, Callable[[DeclaredMetric], object]]]:
        standing = self._drive()
        still = _with_numbers(standing.track, speed=0.0, acceleration=0.0, position=0.0)
        cases = {
            "nobody": self._drive(people=0),
            "somebody alone": self._drive(people=1),
            "a single control instant": self._drive(steps=1),
            "an ego that stands": replace(standing, track=still),
        }
        for name, drive in cases.items():
            yield name, partial(DeclaredMetric.measure, drive=drive)

    def drive_kept(self) -> str:
        drive, before = self._drive(), self._drive()
        self.fresh().measure(drive)
        for part in ("track", "crowd", "background"):
            now, then = getattr(drive, part), getattr(before, part)
            for one in fields(now):
                if not np.array_equal(getattr(now, one.name), getattr(then, one.name)):
                    return f"it writes {part}.{one.name}"
        return ""


def _with_numbers(track: EgoTrack, **values: float) -> EgoTrack:
    """Return a track in which some columns hold the same number at all instants.

    Args:
        track: Track that is copied.
        values: Number of each such column.
    """
    columns: dict[str, Any] = {one.name: getattr(track, one.name) for one in fields(track)}
    steps = len(track.time)
    return EgoTrack(**columns | {name: np.full(steps, value) for name, value in values.items()})
