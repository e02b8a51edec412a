"""Where a traffic light stops the ego."""

import math
from typing import Any

import pytest
from support.situations import demand_of, stop_of, tell

from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.protocol import Demand, Situation
from giveway.ego.rules.traffic_lights import TrafficLights
from giveway.ego.rules.yielding import STOP_BEFORE
from giveway.sumo.network.lane_path import Light

LINE = 100.0  # [m]
STOP = LINE - STOP_BEFORE
BRAKING = {"comfortable": 2.0, "hardest": 8.0}  # [m/s^2]
ADVISED: dict[str, Any] = {**BRAKING, "desired_speed": lambda _: 8.0, "gap": 3.0}


def lights(*more: float) -> TrafficLights:
    ahead = [Light(station, "tls", link) for link, station in enumerate((LINE, *more))]
    return TrafficLights(ahead, comfortable=2.0, hardest=8.0)


def stop(state: str, front: float, speed: float, watch: TrafficLights | None = None) -> float:
    watch = watch or lights()
    tell(watch, front, speed, signals={"tls": state})
    return stop_of(watch, front, speed)


@pytest.mark.parametrize("letter", ["r", "u", "s"])
def test_a_red_light_stops_before_its_line(letter: str) -> None:
    assert stop(letter, 60.0, 10.0) == STOP


@pytest.mark.parametrize("letter", ["g", "G", "o", "O"])
def test_a_light_that_is_not_red_stops_nobody(letter: str) -> None:
    assert stop(letter, 60.0, 10.0) == math.inf


def test_a_light_that_turns_red_too_late_is_passed() -> None:
    assert stop("r", 96.0, 10.0) == math.inf  # 12.5 m/s^2 would be needed
    assert stop("r", 92.0, 10.0) == STOP  # 6.25 m/s^2


def test_at_yellow_only_who_can_stop_in_comfort_stops() -> None:
    assert stop("y", 74.0, 10.0) == STOP  # 1.9 m/s^2
    assert stop("y", 76.0, 10.0) == math.inf  # 2.1 m/s^2


def test_the_decision_at_yellow_holds_while_it_is_yellow() -> None:
    watch = lights()
    assert stop("y", 76.0, 10.0, watch) == math.inf
    assert stop("y", 80.0, 9.0, watch) == math.inf  # it could stop by now, but goes on
    braking = lights()
    assert stop("y", 74.0, 10.0, braking) == STOP
    assert stop("y", 76.5, 10.0, braking) == STOP  # a little late with its brakes


@pytest.mark.parametrize(
    ("front", "speed", "time", "stops"),
    [
        (90.0, 7.9, 2.0, True),  # 3.1 m/s^2; it would pass 0.3 s after the yellow's end
        (90.0, 7.9, 1.0, False),  # it passes in time
        (90.0, 8.1, 2.5, False),  # it is hardly slower
        (97.0, 7.9, 2.8, False),  # 10.4 m/s^2
    ],
)
def test_an_ego_that_is_slowed_at_yellow_stops_if_it_would_pass_late(
    front: float, speed: float, time: float, stops: bool
) -> None:
    watch = lights()
    assert stop("y", 76.0, 10.0, watch) == math.inf
    tell(watch, front, speed, time, signals={"tls": "y"})
    assert stop_of(watch, front, speed) == (STOP if stops else math.inf)


def test_a_passed_light_is_forgotten_and_the_next_one_counts() -> None:
    watch = lights(150.0)
    assert stop("rr", 60.0, 5.0, watch) == STOP
    assert stop("gr", 99.0, 5.0, watch) == 150.0 - STOP_BEFORE
    assert stop("rr", 101.0, 5.0, watch) == 150.0 - STOP_BEFORE
    assert stop("rr", 151.0, 5.0, watch) == math.inf


def test_a_system_that_does_not_answer_stops_nobody() -> None:
    watch = lights()
    tell(watch, 60.0, 5.0, signals={})
    assert stop_of(watch, 60.0, 5.0) == math.inf


def advised(
    greens: tuple[tuple[float, float], ...],
    state: str = "r",
    leader: Leader = NO_LEADER,
    follower_gap: float = math.inf,
    speed: float = 1.0,
) -> float:
    """The speed [m/s] advised 59 m before the place where it would stand."""
    watch = TrafficLights([Light(LINE, "tls", 0)], **ADVISED, greens_of=lambda *_: greens)
    tell(watch, 40.0, 8.0, signals={"tls": state})
    situation = Situation(0.0, 40.0, speed, leader=leader, follower_gap=follower_gap)
    return (watch.demand(situation) or Demand()).advice


@pytest.mark.parametrize(
    ("state", "greens", "leader", "expected"),
    [
        ("r", ((10.0, 40.0),), NO_LEADER, 59.0 / 11.0),  # it arrives a second after the change
        ("r", ((10.9, 40.0),), NO_LEADER, math.inf),  # it would be slower than 5 m/s
        ("r", ((3.0, 40.0),), NO_LEADER, math.inf),  # green before it is there
        ("r", ((0.0, 40.0),), Leader(79.0, 0.0), 6.0),  # behind a queue, which starts later
        ("r", ((2.0, 5.0),), Leader(79.0, 0.0), math.inf),  # red before the queue has left
        ("G", ((0.0, 10.0), (50.0, 70.0)), NO_LEADER, math.inf),
        ("G", ((0.0, 4.0), (10.0, 70.0)), NO_LEADER, 59.0 / 11.0),  # the next green
        ("G", ((0.0, 4.0),), NO_LEADER, math.inf),  # nobody knows when it is green again
        ("r", (), NO_LEADER, math.inf),
    ],
)
def test_it_arrives_when_the_light_is_green(
    state: str, greens: tuple[tuple[float, float], ...], leader: Leader, expected: float
) -> None:
    assert advised(greens, state, leader) == pytest.approx(expected)


@pytest.mark.parametrize(("gap", "slows"), [(49.0, False), (51.0, True)])
def test_no_vehicle_close_behind_is_slowed(gap: float, slows: bool) -> None:
    assert (advised(((10.0, 40.0),), follower_gap=gap) < math.inf) == slows


def test_a_light_far_off_or_passed_is_not_listened_to() -> None:
    asked = []
    ahead = [Light(400.0, "tls", 0)]
    watch = TrafficLights(
        ahead,
        comfortable=2.0,
        hardest=8.0,
        desired_speed=lambda _: 8.0,
        gap=3.0,
        greens_of=lambda *light: (asked.append(light), ())[1],
    )
    for front, told in ((100.0, []), (300.0, [("tls", 0)]), (401.0, [])):
        asked.clear()
        tell(watch, front, 8.0, signals={"tls": "r"})
        assert asked == told
        assert demand_of(watch, front, 8.0).advice == math.inf


def test_it_slows_gently() -> None:
    assert advised(((10.0, 40.0),), speed=8.0) == pytest.approx(7.6)


def test_the_plan_of_a_passed_light_is_not_used_for_the_next() -> None:
    ahead = [Light(LINE, "first", 0), Light(LINE + 60.0, "second", 0)]
    greens = {"first": ((0.0, 5.0), (40.0, 60.0)), "second": ((0.0, 60.0),)}
    watch = TrafficLights(
        ahead,
        comfortable=2.0,
        hardest=8.0,
        desired_speed=lambda _: 8.0,
        gap=3.0,
        greens_of=lambda system, _: greens[system],
    )
    tell(watch, LINE - 0.1, 8.0, signals={"first": "G", "second": "G"})
    stop_of(watch, LINE + 0.1, 8.0)  # before SUMO's next step
    assert demand_of(watch, LINE + 0.1, 8.0, leader=NO_LEADER).advice == math.inf
