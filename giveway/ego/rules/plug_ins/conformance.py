"""Checks that a rule of another package keeps to the protocol, by drives that need no SUMO.

An ego drives 300 m along a straight road of three edges, "first", "second" and "third", each 100 m
long, among a dozen people and behind a vehicle. Each check describes in words what is wrong.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from copy import copy
from math import inf
from types import SimpleNamespace
from typing import Any

import numpy as np

from controller import Finding
from giveway.config import EgoRunConfig
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.plug_ins.plug_in import Maker, made
from giveway.ego.rules.plug_ins.plugged_in import PluggedInRule
from giveway.ego.rules.protocol import Demand, Situation
from giveway.ego.rules.route import RouteContext
from giveway.errors import RuleError
from giveway.geometry.bodies import BODY
from giveway.geometry.path import EgoPath
from giveway.sumo.network.lane_path import LanePath, Light, SpeedLimit
from pedestrian_model import Crowd

_STEPS = 250
_STRIDE = 1.2  # distance [m] between two instants of the drive
_PEOPLE = 12
_SLOW = 5e-4  # longest permitted time [s] of a call: a hundredth of the control step
_BEHIND = 1.0  # distance [m] by which a demanded stop may lie behind the front bumper
_MORNING = 8.0 * 3600.0  # SUMO's clock [s] at the departure


def made_up_route(config: EgoRunConfig | None = None, time_step: float = 0.05) -> RouteContext:
    """The straight road of the checks, which tests of rules use as well.

    Args:
        config: Configuration of the ego, or None for the defaults.
        time_step: Control step [s].
    """
    points = np.column_stack([np.linspace(0.0, 300.0, 31), np.zeros(31)])
    lanes = tuple((f"{edge}_0", f"{edge}_0") for edge in ("first", "second", "third"))
    lane_path = LanePath(
        points=points,
        lights=(Light(100.0, "light", 0),),
        first="first_0",
        edges=(0.0, 100.0, 200.0),
        limits=(SpeedLimit(0.0, 13.9), SpeedLimit(200.0, 8.3)),
        passages=(),
        lanes=lanes,
    )
    ego: Any = SimpleNamespace(
        config=config or EgoRunConfig(), id="ego", safety=None, horizon=60, recorded=False
    )
    session: Any = SimpleNamespace(time=_MORNING)
    path = EgoPath.through(points)
    return RouteContext(ego, session, path, lane_path, 10.0, BODY, time_step)


def situation(step: int, *, order: int = 1, seed: int = 1) -> Situation:
    """The situation at a step of the made-up drive.

    Args:
        step: Number of the step.
        order: Step through the people: 1, or -1 for the opposite order.
        seed: Seed of the people.
    """
    random = np.random.default_rng(seed)
    places = random.uniform([0.0, -8.0], [300.0, 8.0], (_PEOPLE, 2))[::order]
    velocity = random.normal(0.0, 0.7, (_PEOPLE, 2))[::order]
    crowd = Crowd.create(places, velocity, 1.4, [[(0.0, 50.0)]] * _PEOPLE)
    station, colour = 10.0 + _STRIDE * step, "r" if step % 100 < 50 else "G"
    speed = float(4.0 + 4.0 * np.sin(0.05 * step))
    return Situation(
        time=_MORNING + 0.2 * step,
        station=station,
        speed=speed,
        crowd=crowd,
        leader=Leader(station + 25.0, 5.0),
        signals={"light": colour},
    )


def _corner_cases() -> Iterator[tuple[str, Situation]]:
    nobody = Crowd.empty()
    yield "nobody at all", Situation(_MORNING, 50.0, 8.0)
    yield "standing", Situation(_MORNING, 50.0, 0.0, nobody, Leader(52.0, 0.0))
    yield "rolling back a little", Situation(_MORNING, 50.0, -1e-9, nobody, NO_LEADER)
    yield "overlapping", Situation(_MORNING, 50.0, 2.0, nobody, Leader(49.0, 0.0))
    yield "before the beginning of the path", Situation(_MORNING, -2.0, 1.0)
    yield "beyond the end of the path", Situation(_MORNING, 320.0, 8.0)
    yield "a clock at 0", Situation(0.0, 50.0, 8.0)
    yield "a clock after midnight", Situation(90_000.0, 50.0, 8.0)


def check_rule(
    make: Maker, route: RouteContext, begins: Callable[[str], None] | None = None
) -> list[Finding]:
    """The battery.

    Args:
        make: What makes the rule for a route.
        route: Route that it is made for, as `made_up_route` has it.
        begins: Told each check before it is made.

    Returns:
        A finding for each check, kept or broken.
    """
    battery = _Battery(make, route)
    checks: dict[str, Callable[[], str]] = {
        "can be made, and has a say on the made-up road": battery.can_be_made,
        "answers sound demands": battery.usual,
        "answers in corner cases": battery.corner_cases,
        "is the same when it is made again": battery.deterministic,
        "is independent of others of its kind": battery.independent,
        "does not depend on the order of people": battery.order,
        "changes nothing of the situation": battery.situation_kept,
        "demands no stop behind the ego": battery.stops_ahead,
        "is quick": battery.quick,
    }
    findings: list[Finding] = []
    for check, run in checks.items():
        if begins is not None:
            begins(check)
        try:
            findings.append(Finding(check, run()))
        except RuleError as error:
            findings.append(Finding(check, str(error)))
        if findings[-1].problem and len(findings) <= 2:
            break  # nothing else can be asked
    return findings


class _Battery:
    """The checks; each returns what is wrong, or nothing."""

    def __init__(self, make: Maker, route: RouteContext) -> None:
        self._make, self._route = make, route

    def _fresh(self) -> PluggedInRule:
        rule = made("it", self._make, self._route)
        if rule is None:
            raise RuleError("it has nothing to say there: set its options so that it has (--set)")
        return rule

    def _drive(
        self, rule: PluggedInRule, *, other: PluggedInRule | None = None, order: int = 1
    ) -> list[Demand]:
        demands = []
        for step in range(_STEPS):
            now = situation(step, order=order)
            demands.append(_ask(rule, now))
            if other is not None:
                _ask(other, situation(_STEPS - step, seed=7))
        return demands

    def _difference(self, demands: list[Demand], what: str) -> str:
        for step, pair in enumerate(zip(demands, self._drive(self._fresh()), strict=True)):
            there, usual = map(_plain, pair)
            if there != usual:
                return f"{what}: {there} in place of {usual} at step {step}"
        return ""

    def can_be_made(self) -> str:
        self._fresh()
        return ""

    def usual(self) -> str:
        self._drive(self._fresh())
        return ""

    def corner_cases(self) -> str:
        for name, now in _corner_cases():
            try:
                _ask(self._fresh(), now)
            except RuleError as error:
                return f"{name}: {error}"
        return ""

    def deterministic(self) -> str:
        return self._difference(self._drive(self._fresh()), "made again, it answers otherwise")

    def independent(self) -> str:
        demands = self._drive(self._fresh(), other=self._fresh())
        return self._difference(demands, "beside another one, it answers otherwise")

    def order(self) -> str:
        demands = self._drive(self._fresh(), order=-1)
        return self._difference(demands, "with the people in another order, it answers otherwise")

    def situation_kept(self) -> str:
        rule = self._fresh()
        for step in range(_STEPS):
            now = situation(step)
            before = copy(now)
            position = now.crowd.position.copy()
            _ask(rule, now)
            for key in Situation.__slots__:
                if getattr(now, key) is not getattr(before, key):
                    return f"it sets {key} at step {step}"
            if not np.array_equal(position, now.crowd.position):
                return f"it moves the people at step {step}"
        return ""

    def stops_ahead(self) -> str:
        for step, demand in enumerate(self._drive(self._fresh())):
            station = situation(step).station
            if demand.stop < station - _BEHIND:
                return f"at {station:g} m it demands a stop at {demand.stop:g} m"
        return ""

    def quick(self) -> str:
        rule, times = self._fresh(), []
        for step in range(_STEPS):
            now = situation(step)
            began = time.thread_time()
            rule.demand(now)
            times.append(time.thread_time() - began)
        median = float(np.median(times))
        return f"takes {1e3 * median:.1f} ms for a call" if median > _SLOW else ""


def _ask(rule: PluggedInRule, now: Situation) -> Demand:
    """The answer at an instant right after a step of SUMO's and of the control."""
    if hasattr(rule, "update"):
        rule.update(now)
    demand = rule.demand(now) or Demand()
    if hasattr(rule, "advance"):
        rule.advance(now, 0.05)
    return demand


def _plain(demand: Demand) -> dict[str, Any]:
    """The demand as a short text that can be compared."""
    lanes = None if demand.lane_speeds is None else demand.lane_speeds.tolist()
    told = demand._replace(lane_speeds=None)._asdict() | {"lane_speeds": lanes}
    return {key: value for key, value in told.items() if value not in (inf, "", NO_LEADER, None)}
