"""The conformance kit of rules of the road: a battery of drives that need no SUMO.

An ego drives 300 m along a straight road of three edges, "first", "second" and "third", each 100 m
long, among a dozen people and behind a vehicle. Each check describes in words what is wrong.
"""

from collections.abc import Callable, Iterator
from copy import copy
from functools import partial
from math import inf
from types import SimpleNamespace
from typing import Any

import numpy as np

from giveway.config import EgoRunConfig
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.plug_ins.plug_in import Maker, made
from giveway.ego.rules.plug_ins.plugged_in import PluggedInRule
from giveway.ego.rules.protocol import Demand, Situation
from giveway.ego.rules.route import RouteContext
from giveway.errors import RuleError
from giveway.geometry.bodies import BODY
from giveway.geometry.path import EgoPath
from giveway.plug_ins.conformance.battery import Battery, Begins, Finding
from giveway.sumo.network.lane_path import LanePath, Light, SpeedLimit
from pedestrian_model import Crowd

_STEPS = 250
_STRIDE = 1.2  # distance [m] between two instants of the drive
_PEOPLE = 12
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
    network = SimpleNamespace(limits_change=False)
    session: Any = SimpleNamespace(time=_MORNING, lanes=network)
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


def check_rule(make: Maker, route: RouteContext, begins: Begins | None = None) -> list[Finding]:
    """Return a finding for each check of rules of the road, kept or broken.

    Args:
        make: Function that makes the rule for a route.
        route: Route that it is made for, as `made_up_route` has it.
        begins: Function that is told each check before it is made, or None.
    """
    return _Battery(make, route).findings(begins)


class _Battery(Battery[PluggedInRule, list[Demand]]):
    faults = (RuleError,)
    method = "demand"
    longest = 5e-4  # A hundredth of the control step

    def __init__(self, make: Maker, route: RouteContext) -> None:
        self._make, self._route = make, route

    def rules(self) -> dict[str, Callable[[], str]]:
        return {
            "can be made, and has a say on the made-up road": self.can_be_made,
            "answers sound demands": self.usual,
            "answers in corner cases": self.in_corner_cases,
            "is the same when it is made again": self.deterministic,
            "is independent of others of its kind": self.independent,
            "does not depend on the order of people": self.unordered,
            "changes nothing of the situation": self.situation_kept,
            "demands no stop behind the ego": self.stops_ahead,
            "is quick": self.quick,
        }

    def fresh(self) -> PluggedInRule:
        rule = made("it", self._make, self._route)
        if rule is None:
            raise RuleError("it has nothing to say there: set its options so that it has (--set)")
        return rule

    def answers(
        self,
        hosted: PluggedInRule,
        *,
        other: PluggedInRule | None = None,
        order: int = 1,
        turned: bool = False,  # noqa: ARG002 - the road has no other place
    ) -> list[Demand]:
        demands = []
        for step in range(_STEPS):
            demands.append(_ask(hosted, situation(step, order=order)))
            if other is not None:
                _ask(other, situation(_STEPS - step, seed=7))
        return demands

    def difference(self, found: list[Demand], usual: list[Demand]) -> str:
        for step, pair in enumerate(zip(found, usual, strict=True)):
            there, before = map(_plain, pair)
            if there != before:
                return f"{there} in place of {before} at step {step}"
        return ""

    def corner_cases(self) -> Iterator[tuple[str, Callable[[PluggedInRule], object]]]:
        for name, now in _corner_cases():
            yield name, partial(_ask, now=now)

    def situation_kept(self) -> str:
        rule = self.fresh()
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
        for step, demand in enumerate(self.answers(self.fresh())):
            station = situation(step).station
            if demand.stop < station - _BEHIND:
                return f"at {station:g} m it demands a stop at {demand.stop:g} m"
        return ""


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
