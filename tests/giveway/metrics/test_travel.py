"""Delays against a drive at the limits: over the whole drive, and at each traffic light."""

from dataclasses import replace
from math import isnan, nan

import pytest
from support.crossing_world import drive, ego, to_a_stand

from giveway.metrics.law import Drive
from giveway.metrics.travel import level_of_service, signal_delays, summarise_travel
from giveway.run_data.way import LimitOnWay, StopLine

LINE = StopLine(20.0, "tls", 1)
FAST = 100.0  # [m/s] faster than any limit


def on_road(track, *lines: StopLine, limit: float = 8.0) -> Drive:
    """Return a drive on a road with one limit [m/s]."""
    made = drive(track, crossings=(), lines=lines)
    return replace(made, way=replace(made.way, limits=(LimitOnWay(0.0, limit),)))


STEADY = ego((12.0, 0.0))  # at 4 m/s for 12 s: 48 m
WAITS = ego((5.0, 0.0), (6.0, -4.0 / 6.0), (20.0, 0.0), (4.0, 1.0), (10.0, 0.0))


@pytest.mark.parametrize(
    ("delay", "level"),
    [(0.0, "A"), (10.0, "A"), (10.1, "B"), (20.0, "B"), (35.0, "C"), (55.0, "D"), (80.0, "E"),
     (80.1, "F"), (nan, "")],
)  # fmt: skip
def test_the_levels_are_those_of_the_manual(delay, level) -> None:
    assert level_of_service(delay) == level


def test_a_drive_at_half_the_limit_loses_half_its_time() -> None:
    road = on_road(STEADY)
    found = summarise_travel(road, (), FAST)
    assert found.free_flow_delay == pytest.approx(STEADY.time[-1] / 2.0, abs=0.05)
    assert (found.stops_per_km, found.signals_passed, found.level_of_service) == (0.0, 0, "")


def test_at_the_own_highest_speed_nothing_is_lost() -> None:
    assert summarise_travel(on_road(STEADY), (), 4.0).free_flow_delay == pytest.approx(
        0.0, abs=0.05
    )
    assert summarise_travel(on_road(STEADY, limit=4.0), (), FAST).free_flow_delay < 0.05


def test_a_wait_at_the_light_is_its_control_delay() -> None:
    track = WAITS
    line = StopLine(float(track.position[-1]) / 2.0 + 5.0, "tls", 1)
    road = on_road(track, line, limit=4.0)
    (found,) = signal_delays(road, FAST)
    assert (found.system, found.link, found.station) == ("tls", 1, line.station)
    free = float(track.position[-1]) / 4.0
    assert found.control_delay == pytest.approx(track.time[-1] - free, abs=0.1)
    assert 20.0 < found.control_delay < 35.0
    assert found.level_of_service == "C"
    summary = summarise_travel(road, (found,), FAST)
    assert summary.control_delay == found.control_delay
    assert summary.stops_per_km == pytest.approx(1000.0 / track.position[-1])


def test_the_delay_between_two_lights_is_shared_out_once() -> None:
    lines = StopLine(10.0, "a", 0), StopLine(30.0, "b", 0)
    road = on_road(STEADY, *lines)
    first, second = signal_delays(road, FAST)
    assert first.control_delay + second.control_delay == pytest.approx(
        summarise_travel(road, (), FAST).free_flow_delay, abs=0.05
    )
    assert first.time == pytest.approx(2.5)


def test_a_light_that_is_not_passed_has_none() -> None:
    assert signal_delays(on_road(to_a_stand(19.0, (4.0, 0.0)), LINE), FAST) == ()


def test_without_limits_there_are_no_delays() -> None:
    road = drive(STEADY, crossings=(), lines=(LINE,))
    assert signal_delays(road, FAST) == ()
    assert isnan(summarise_travel(road, (), FAST).free_flow_delay)
