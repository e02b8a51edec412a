"""What the rules of an ego demand together."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from support.situations import NOBODY

from controller.driving_constants import FIRM
from giveway.config.tables.rules import RulesConfig
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.plug_ins.conformance import made_up_route
from giveway.ego.rules.protocol import LIGHT, Demand, Needs, Rule, Situation, Told
from giveway.ego.rules.rule_set import BEYOND, RULES, RuleSet

AHEAD = Leader(80.0, 5.0)


class Says:
    """A rule that always demands the same, and remembers what it saw."""

    def __init__(self, demand: Demand | None) -> None:
        self._demand = demand
        self.leaders: list[Leader] = []
        self.at_rest: list[Leader] = []

    def demand(self, situation: Situation) -> Demand | None:
        self.leaders.append(situation.leader)
        self.at_rest.append(situation.leader_at_rest())
        return self._demand


class Watches(Says):
    """One that wants to be told of everything."""

    def __init__(self) -> None:
        super().__init__(None)
        self.needs = Needs(frozenset({"light"}), keep_clear=((20.0, 30.0),))
        self.told: list[tuple[Any, ...]] = []

    def update(self, situation: Situation) -> None:
        self.told.append((situation.time, situation.station, dict(situation.signals)))

    def advance(self, situation: Situation, time_step: float) -> None:
        self.told.append((situation.time, situation.station, time_step))


def asked(*demands: Demand | None) -> RuleSet:
    rules = RuleSet([Says(demand) for demand in demands])
    rules.look(10.0, 8.0, NOBODY, AHEAD)
    return rules


def test_no_rule_demands_nothing() -> None:
    for rules in (RuleSet(), asked(None), asked(Demand())):
        assert (rules.stop, rules.cause, rules.latest) == (math.inf, "", math.inf)
        assert (rules.speed, rules.advice, rules.leader) == (math.inf, math.inf, NO_LEADER)
        assert rules.lane_speeds is None


def test_the_strictest_demand_holds() -> None:
    rules = asked(
        Demand(50.0, "light", speed=9.0),
        Demand(40.0, "yield", latest=40.05, advice=4.0),
        Demand(45.0, "stop", speed=7.0, advice=5.0),
    )
    assert (rules.stop, rules.cause, rules.latest) == (40.0, "yield", 40.05)
    assert (rules.speed, rules.advice) == (7.0, 4.0)


def test_of_equal_stops_the_first_rule_gives_the_cause() -> None:
    assert asked(Demand(40.0, "stop"), Demand(40.0, "yield")).cause == "stop"


def test_a_plan_leads_hardly_beyond_a_stop_unless_it_is_late() -> None:
    usual, late = BEYOND
    firm = 10.0 + 0.2 * 8.0 + 8.0**2 / (2.0 * FIRM)  # where firm braking from 8 m/s stops
    assert asked(Demand(40.0, "yield")).latest == 40.0 + usual
    assert asked(Demand(firm - 0.3, "yield")).latest == pytest.approx(firm)
    assert asked(Demand(15.0, "yield")).latest == 15.0 + late


def test_lane_speeds_are_the_lowest_of_each_step() -> None:
    one, two = np.array([5.0, 9.0]), np.array([7.0, 3.0])
    rules = asked(Demand(lane_speeds=one), Demand(lane_speeds=two))
    assert rules.lane_speeds is not None
    assert rules.lane_speeds.tolist() == [5.0, 3.0]
    assert one.tolist() == [5.0, 9.0]


def test_a_demanded_leader_is_ahead_for_the_rules_after_it() -> None:
    merging = Leader(60.0, 3.0)
    first, last = Says(Demand(leader=merging)), Says(None)
    rules = RuleSet([first, last])
    rules.look(10.0, 8.0, NOBODY, AHEAD)
    assert (first.leaders, last.leaders, rules.leader) == ([AHEAD], [merging], merging)


def test_later_rules_know_where_the_leader_waits_at_red() -> None:
    last = Says(None)
    rules = RuleSet([Says(Demand(90.0, LIGHT)), last])
    rules.look(10.0, 8.0, NOBODY, AHEAD)
    assert last.at_rest == [Leader(85.0, 0.0)]


def test_what_was_demanded_is_forgotten_at_the_next_step() -> None:
    rules = asked(Demand(40.0, "yield", speed=3.0))
    rules._demands = (lambda situation: None,)
    rules.look(11.0, 8.0, NOBODY, AHEAD)
    assert (rules.stop, rules.speed) == (math.inf, math.inf)


def test_only_rules_that_watch_are_told() -> None:
    rule = Watches()
    rules = RuleSet([Says(None), rule], time=100.0)
    assert rules.watches
    assert not RuleSet([Says(None)]).watches
    assert rules.systems == {"light"}
    rules.update(101.0, 10.0, 8.0, Told({"light": "r"}))
    rules.advance(10.4, 8.0, 0.05)
    assert rule.told == [(101.0, 10.0, {"light": "r"}), (101.05, 10.4, 0.05)]


@pytest.mark.parametrize(("station", "left"), [(19.0, 0.0), (20.5, 9.5), (30.0, 0.0)])
def test_how_far_it_has_to_drive_to_leave_what_it_keeps_clear(station: float, left: float) -> None:
    assert RuleSet([Watches()]).keep_clear_distance(station) == left


def test_the_situation_is_refilled_in_place() -> None:
    rules = RuleSet()
    before = rules.situation
    rules.look(10.0, 8.0, NOBODY, AHEAD)
    assert rules.situation is before


def test_giveways_own_rules_keep_to_the_protocol() -> None:
    for factory in RULES:
        kind = factory.__self__  # type: ignore[attr-defined]
        assert issubclass(kind, Rule), kind


def test_each_rule_has_a_key_that_switches_it_off() -> None:
    """On the made-up road two rules have a say; each is gone without its key."""
    names = {"traffic_lights": "TrafficLights", "speed_limits": "SpeedLimits"}
    for off in (None, *names):
        settings: dict[str, Any] = {"rules": {"signal_plans": False}}
        if off is not None:
            settings["rules"][off] = False
        if off == "speed_limits":
            settings["regulation"] = {"reference_speed": 8.0}
        found = [rule for factory in RULES[2:] if (rule := made(factory, settings)) is not None]
        kinds = {type(rule).__name__ for rule in found}
        assert kinds == set(names.values()) - {names.get(off or "", "")}


def made(factory: Any, settings: dict[str, Any]) -> Any:
    """The rule on the made-up road, where no crossing or junction is asked for."""
    from giveway.config import EgoRunConfig

    own = settings["rules"] | {"crossings": False, "right_of_way": False}
    return factory(made_up_route(EgoRunConfig.model_validate(settings | {"rules": own})))


def test_the_keys_of_the_rules_are_all_switches() -> None:
    assert all(field.default is None for field in RulesConfig.model_fields.values())
