"""Where a traffic light stops the ego."""

import math

import pytest
from support.situations import stop_of, tell

from giveway.ego.rules.traffic_lights import TrafficLights
from giveway.ego.rules.yielding import STOP_BEFORE
from giveway.sumo.network.lane_path import Light

LINE = 100.0  # [m]
STOP = LINE - STOP_BEFORE
BRAKING = {"comfortable": 2.0, "hardest": 8.0}  # [m/s^2]


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
