"""Where the ego waits for others: its line at 50 m, ways that cross at 55 to 60 m."""

import math
from dataclasses import replace
from typing import Any

import pytest
from support.situations import demand_of, stop_of, tell

from giveway.ego.perception.leader import Leader
from giveway.ego.rules.gap_acceptance import MINOR_STRAIGHT, PERMITTED
from giveway.ego.rules.junctions import Approach, Gaps, PathJunction
from giveway.ego.rules.right_of_way import RightOfWay
from giveway.ego.rules.rule_set import RuleSet
from giveway.ego.rules.yielding import STOP_BEFORE
from giveway.geometry.conflict import Conflict
from giveway.sumo.network.junction_links import Movement

ENTRY = 50.0
LINE = ENTRY - STOP_BEFORE
OWN, OTHER = 0, 1
NOBODY = frozenset[int]()


def junction(
    state: str = "m",
    *,
    waiting: tuple[float, ...] = (),
    lights: bool = False,
    named: bool = True,
    beside: frozenset[int] = NOBODY,
) -> PathJunction:
    system = "tls" if lights else ""
    yields_to = frozenset({OTHER}) if named else NOBODY
    own, other = (
        Movement(
            "j",
            number,
            source,
            target,
            (f":j_{number}_0",),
            letter,
            "s",
            10.0,
            system,
            number if lights else -1,
            first,
            frozenset({1 - number}),
        )
        for number, source, target, letter, first in (
            (OWN, "south_0", "north_0", state, yields_to),
            (OTHER, "west_0", "east_0", "M", NOBODY),
        )
    )
    where = Conflict(55.0, 60.0, 4.0, 8.0)
    movements, conflicts = {OWN: own, OTHER: other}, {OTHER: where}
    gaps = Gaps(MINOR_STRAIGHT, PERMITTED)
    return PathJunction(ENTRY, 65.0, waiting, own, movements, conflicts, beside, gaps)


def other(distance: float, speed: float = 10.0, standing: float = 0.0) -> Approach:
    return Approach("car", OTHER, distance, speed, 4.5, standing)


class Drive:
    """An ego that looks at a junction step by step."""

    def __init__(self, place: PathJunction, **options: Any) -> None:
        self.keeps = RightOfWay([place], name="ego", length=5.0, gap=1.0, fastest=8.0, **options)
        self.time = 0.0

    def stop(
        self, front: float, speed: float, *others: Approach, lights: str = "", after: float = 0.1
    ) -> float:
        self.time += after
        assert RuleSet([self.keeps]).near_junctions(front) == {"j"}
        signals = {"tls": lights} if lights else {}
        tell(self.keeps, front, speed, self.time, signals=signals, traffic={"j": others})
        return stop_of(self.keeps, front, speed)


def stop(place: PathJunction, front: float, speed: float, *others: Approach, **more: Any) -> float:
    return Drive(place).stop(front, speed, *others, **more)


def test_the_longer_it_waits_the_shorter_a_headway_it_accepts() -> None:
    drive, gap = Drive(junction()), MINOR_STRAIGHT
    near, middle = other(10.0 * (gap.follow_up - 1.0)), other(10.0 * gap.critical + 3.0)
    assert drive.stop(LINE, 0.0, middle) < math.inf
    for _ in range(40):
        assert drive.stop(LINE, 0.0, near, after=1.0) < math.inf  # never shorter than the follow-up
    assert drive.stop(LINE, 0.0, middle) == math.inf


def test_it_waits_at_the_stop_line_that_the_network_sets() -> None:
    place = junction()._replace(offset=6.0)
    assert stop(place, ENTRY - 20.0, 5.0, other(20.0)) == LINE - 6.0
    past = ENTRY - 5.0  # over the stop line, but not yet in the junction
    assert stop(place, past, 3.0, other(20.0)) == LINE


def test_it_knows_who_is_led_past_it() -> None:
    past, across = 2, junction()
    place = junction(beside=frozenset({past}))
    aside = replace(place.movements[OTHER], number=past, source="west_1", target="east_1")
    place = place._replace(movements={**place.movements, past: aside})
    one, two = other(20.0), other(12.0)._replace(name="second", number=past)
    drive = Drive(place)
    assert drive.keeps.beside == set()
    drive.stop(30.0, 5.0, two, one)
    assert drive.keeps.beside == {"second"}
    drive.stop(31.0, 5.0, one)
    assert drive.keeps.beside == set()
    drive.stop(31.5, 5.0, two)
    assert RuleSet([drive.keeps]).near_junctions(66.0) == set()
    tell(drive.keeps, 66.0, 5.0)
    assert drive.keeps.beside == set()  # behind the last junction, where nobody is looked at
    further = across._replace(
        entry=80.0, exit=95.0, movement=replace(across.movement, junction="k")
    )
    keeps = RightOfWay([place, further], name="ego", length=5.0, gap=1.0, fastest=8.0)
    traffic = {"j": [two], "k": [two._replace(number=OTHER)]}
    tell(keeps, 30.0, 5.0, 0.1, traffic=traffic)
    assert keeps.beside == set()  # at the next junction its way crosses the ego's


def test_it_waits_for_whoever_comes_within_its_critical_gap() -> None:
    at_line = LINE, 0.0
    # from standing it is over its line after 1.2 s; who is 6.5 s from there is 77 m away at 10 m/s
    assert stop(junction(), *at_line, other(60.0)) == LINE
    assert stop(junction(), *at_line, other(110.0)) == math.inf
    assert stop(junction(), *at_line) == math.inf


def test_who_has_passed_before_it_comes_costs_no_stop() -> None:
    assert stop(junction(), 20.0, 5.0, other(5.0)) == math.inf
    assert stop(junction(), 20.0, 5.0, other(45.0)) == LINE


def test_who_has_to_let_it_go_first_does_not_stop_it() -> None:
    assert stop(junction(named=False), LINE, 0.0, other(20.0)) == math.inf


def test_nobody_makes_it_brake_harder_than_3() -> None:
    assert stop(junction(), 40.0, 7.6, other(15.0)) == LINE
    assert stop(junction(), 40.0, 7.9, other(15.0)) == math.inf


def test_the_ego_waits_for_any_vehicle_inside_the_junction() -> None:
    there = other(-5.0, speed=0.0, standing=9.0)
    assert stop(junction(named=False), LINE, 0.0, there) == LINE
    gone = other(-8.0 - 4.6, speed=1.0)
    assert stop(junction(), LINE, 0.0, gone) == math.inf


def test_who_can_still_give_way_in_the_junction_is_not_braked_for() -> None:
    """An oncoming car rolls up to where it waits before it turns left across the ego's path."""
    place = junction("M", named=False)
    turns = replace(place.movements[OTHER], yields_to=frozenset({OWN}))
    place = place._replace(movements={**place.movements, OTHER: turns})
    assert stop(place, 40.0, 7.0, other(-0.5, speed=3.5)) == math.inf  # 1.8 m/s^2 suffice
    assert stop(place, 40.0, 7.0, other(-0.5, speed=4.5)) == LINE  # 2.9 m/s^2: it may go on
    assert stop(place, 40.0, 7.0, other(-5.0, speed=3.5)) == LINE  # it is on the ego's path


def test_who_waits_in_the_junction_for_others_is_not_waited_for() -> None:
    place, third = junction(), 2
    waits = replace(place.movements[OTHER], yields_to=frozenset({third}))
    oncoming = replace(waits, number=third, yields_to=NOBODY)
    place = place._replace(movements={**place.movements, OTHER: waits, third: oncoming})
    there = other(-2.0, speed=0.0, standing=1.0)
    car = Approach("oncoming", third, 15.0, 10.0, 4.5, 0.0)
    assert stop(place, LINE, 0.0, there, car) == math.inf
    assert stop(place, LINE, 0.0, there) == LINE  # nobody keeps it from setting off


@pytest.mark.parametrize(
    ("lights", "stops"),
    [("Gr", False), ("gG", True), ("gr", False), ("gy", False), ("og", True)],
)
def test_at_lights_the_letters_decide(lights: str, stops: bool) -> None:
    place = junction(lights=True)
    # at yellow it could stop with 2 m/s^2
    assert (stop(place, LINE, 0.0, other(25.0), lights=lights) == LINE) == stops


def test_who_cannot_stop_at_yellow_any_more_is_waited_for() -> None:
    assert stop(junction(lights=True), LINE, 0.0, other(10.0), lights="gy") == LINE


def test_inside_a_turn_it_waits_where_others_wait() -> None:
    turn = junction(waiting=(54.0,), lights=True)
    assert stop(turn, 45.0, 4.0, other(30.0), lights="gG") == 53.0
    drive = Drive(turn)
    assert drive.stop(53.0, 0.0, other(30.0), lights="gG") == 53.0
    # its own light does not matter any more there, and theirs has changed
    assert drive.stop(53.0, 0.0, other(30.0), lights="rr") == math.inf


@pytest.mark.parametrize("state", ["s", "w"])
def test_at_a_stop_line_it_halts_though_nobody_comes(state: str) -> None:
    drive = Drive(junction(state))
    assert drive.stop(40.0, 5.0) == LINE
    assert drive.stop(LINE, 0.0) == math.inf


def test_a_green_arrow_beside_red_is_a_stop_line() -> None:
    drive = Drive(junction(lights=True))
    assert drive.stop(40.0, 5.0, lights="sr") == LINE
    assert drive.stop(LINE, 0.0, other(30.0), lights="sG") == LINE
    assert drive.stop(LINE, 0.0, other(30.0), lights="sr") == math.inf


def test_at_an_all_way_stop_who_stood_first_goes_first() -> None:
    drive = Drive(junction("w"))
    drive.stop(LINE, 0.0)  # it stands from now on
    assert drive.stop(LINE, 0.0, other(1.0, 0.0, standing=2.0), after=1.0) == LINE
    assert drive.stop(LINE, 0.0, other(1.0, 0.0, standing=0.5), after=1.0) == math.inf
    assert drive.stop(LINE, 0.0, other(20.0)) == math.inf


def test_it_is_not_polite_for_ever_to_who_stands() -> None:
    drive = Drive(junction())
    assert drive.stop(LINE, 0.0, other(1.0, 0.0, standing=20.0)) == LINE
    for _ in range(31):
        last = drive.stop(LINE, 0.0, other(1.0, 0.0, standing=20.0))
    assert last == math.inf


def test_once_it_goes_past_who_stands_it_does_not_hesitate() -> None:
    turn = junction(waiting=(54.0,))
    drive = Drive(turn)
    for _ in range(32):
        last = drive.stop(53.0, 0.0, other(1.0, 0.0, standing=20.0))
    assert last == math.inf
    assert drive.stop(53.2, 0.6, other(1.0, 0.0, standing=21.0)) == math.inf
    assert drive.stop(53.4, 0.9, other(0.9, 1.0)) < math.inf  # and now they come


def test_who_stands_behind_somebody_who_turns_is_not_waited_for() -> None:
    turn, left = junction(waiting=(54.0,)), 2
    turning = replace(turn.movements[OTHER], number=left, target="north_0")
    turn = turn._replace(movements={**turn.movements, left: turning})
    behind = other(1.0, 0.0, standing=1.5)
    turner = Approach("turner", left, -4.0, 0.0, 4.5, 1.5)
    assert stop(turn, 53.0, 0.0, behind) == 53.0
    assert stop(turn, 53.0, 0.0, turner, behind) == math.inf
    gone_on = turner._replace(distance=-8.0)
    assert stop(turn, 53.0, 0.0, gone_on, behind) == 53.0
    assert stop(turn, 53.0, 0.0, turner, other(3.0, 1.5)) == math.inf  # nor who crawls up to there
    assert stop(turn, 53.0, 0.0, turner, other(5.5, 1.5)) == 53.0
    assert stop(turn, 53.0, 0.0, turner, other(3.0, 2.5)) == 53.0
    driving = turner._replace(speed=3.0, standing=0.0)
    assert stop(turn, 53.0, 0.0, driving, behind) == 53.0


def test_a_queue_whose_light_has_just_turned_green_will_start() -> None:
    drive = Drive(junction(lights=True))
    for _ in range(50):
        assert drive.stop(LINE, 0.0, other(1.0, 0.0, standing=20.0), lights="gr") == math.inf
    drive = Drive(junction(lights=True))
    for _ in range(20):
        drive.stop(LINE, 0.0, other(1.0, 0.0, standing=20.0), lights="rr")
    assert drive.stop(LINE, 0.0, other(1.0, 0.0, standing=22.0), lights="gG") == LINE


def test_once_it_goes_it_keeps_going() -> None:
    drive = Drive(junction())
    assert drive.stop(LINE, 0.0, other(100.0)) == math.inf
    # less than the critical gap by now, and still enough to get across
    assert drive.stop(LINE + 0.3, 1.5, other(70.0)) == math.inf
    assert stop(junction(), LINE + 0.3, 1.5, other(60.0)) == LINE + 0.3


def test_options_are_gaps_in_seconds() -> None:
    assert Drive(junction(), critical_headway=12.0).stop(LINE, 0.0, other(110.0)) == LINE
    assert Drive(junction(), critical_headway=1.0).stop(LINE, 0.0, other(75.0)) == math.inf


def test_it_uses_the_same_gap_after_the_follow_up_headway() -> None:
    drive = Drive(junction())
    ahead = Approach("leader", OWN, -0.1, 2.0, 4.5, 0.0)
    drive.stop(LINE - 5.0, 2.0)
    assert drive.stop(LINE, 1.0, ahead) == LINE
    assert drive.stop(LINE, 0.0, after=3.0) == LINE
    assert drive.stop(LINE, 0.0, after=1.0) == math.inf


@pytest.mark.parametrize(("letter", "stops"), [("g", True), ("y", False), ("G", False)])
def test_at_yellow_it_waits_for_no_gap_behind_another(letter: str, stops: bool) -> None:
    """Lights decide whether it goes on; a wait of some seconds would end at red."""
    drive = Drive(junction(lights=True))
    ahead = Approach("leader", OWN, -0.1, 8.0, 4.5, 0.0)
    drive.stop(LINE - 25.0, 8.0, lights="Gr")
    assert (drive.stop(LINE - 24.0, 8.0, ahead, lights=f"{letter}r") == LINE) == stops


@pytest.mark.parametrize(("station", "stops"), [(58.0, True), (70.0, True), (72.0, False)])
def test_it_enters_no_junction_that_it_cannot_leave(station: float, stops: bool) -> None:
    drive = Drive(junction(named=False))
    drive.stop(40.0, 5.0)
    place = stop_of(drive.keeps, 40.0, 5.0, leader=Leader(station, 0.5))
    assert (place == LINE) == stops
    assert stop_of(drive.keeps, 40.0, 5.0, leader=Leader(station, 5.0)) == math.inf


def test_it_does_not_brake_hard_for_who_becomes_slow_behind_the_junction() -> None:
    """The line itself is early enough, where a metre before it is not."""
    drive, leader = Drive(junction()), Leader(71.0, 1.9)
    tell(drive.keeps, 47.4, 3.7)
    assert demand_of(drive.keeps, 47.4, 3.7, leader=leader).stop == ENTRY
    assert demand_of(drive.keeps, 44.0, 3.7, leader=leader).stop == LINE


def test_itself_is_not_in_its_way() -> None:
    itself = Approach("ego", OTHER, 20.0, 10.0, 5.0, 0.0)
    assert stop(junction(), LINE, 0.0, itself) == math.inf
