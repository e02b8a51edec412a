"""Stop lines that are passed against the light: 20 m from the start, reached at 5 s."""

import pytest
from support.crossing_world import drive, ego, to_a_stand

from giveway.metrics.law import ledger
from giveway.run_data.way import StopLine

LINE = StopLine(20.0, "tls", 1)
THROUGH = ego((12.0, 0.0))  # at 4 m/s; 2 m/s^2 stop it within 4 m


def judged(track, *lights, **keywords):
    return ledger(drive(track, crossings=(), lines=(LINE,), lights=lights, **keywords))


@pytest.mark.parametrize(
    ("lights", "runs"),
    [
        ([(0.0, "rG")], 0),
        ([(0.0, "Gr")], 1),
        ([(0.0, "GR")], 1),
        ([(0.0, "Gu")], 1),  # red and yellow: not yet
        ([(0.0, "GG"), (4.9, "Gr")], 1),
        ([(0.0, "GG"), (5.1, "Gr")], 0),  # red just after
        ([(0.0, "Gr"), (4.9, "GG")], 0),
        ([(0.0, "GO")], 0),  # out of order
        ([(0.0, "GG"), (3.9, "Gy")], 1),  # 4.4 m before the line: it could have stopped
        ([(0.0, "GG"), (4.1, "Gy")], 0),  # 3.6 m before
        ([(0.0, "GG"), (3.9, "Gy"), (4.5, "GY")], 1),  # the same yellow still
        ([(0.0, "GG"), (4.1, "Gy"), (4.9, "Gr")], 1),
        ([(0.0, "Gs")], 1),  # an arrow, without a stop
        ([], 0),
    ],
)
def test_the_light_at_the_line_decides_and_at_yellow_the_stop(lights, runs):
    found = judged(THROUGH, *lights)
    assert found.summary.red_lights_run == runs
    assert [event.kind for event in found.violations] == ["red light"] * runs


def test_a_weaker_brake_is_asked_for_less_at_yellow():
    lights = [(0.0, "GG"), (3.9, "Gy")]
    assert judged(THROUGH, *lights, comfortable=1.5).summary.red_lights_run == 0


def test_what_the_row_says():
    (event,) = judged(THROUGH, (0.0, "Gr"), (1.0, "GG"), (2.0, "Gr")).violations
    assert event.time == pytest.approx(5.0)
    assert (event.other, event.place, event.x, event.y) == ("tls", "1", 20.0, -1.75)
    assert (event.value, event.unit) == (pytest.approx(3.0), "s")
    (event,) = judged(THROUGH, (0.0, "GG"), (3.0, "Gy")).violations
    assert (event.value, event.unit) == (pytest.approx(1.0), "m/s^2")


def test_who_stops_at_the_line_has_run_nothing():
    waits = to_a_stand(19.0, (4.0, 0.0))
    assert judged(waits, (0.0, "Gr")).violations == ()


def test_a_green_arrow_is_for_those_who_have_stopped():
    turns = to_a_stand(18.0, (1.0, 0.0), (5.0, 1.5))
    assert judged(turns, (0.0, "Gs")).summary.red_lights_run == 0
    early = to_a_stand(16.0, (1.0, 0.0), (5.0, 1.5))
    assert judged(early, (0.0, "Gs")).summary.red_lights_run == 1


def test_a_line_behind_the_departure_is_not_passed():
    track = ego((5.0, 0.0), front=21.0)
    assert judged(track, (0.0, "Gr"), front=21.0).summary.red_lights_run == 0
