"""How early an ego slowed for people, and how long it stood in their midst."""

import numpy as np
import pytest

from giveway.geometry.bodies import VehicleShape
from giveway.metrics import anticipation
from giveway.metrics.slowing import slowing_begins

CAR = VehicleShape(length=5.0, width=2.0)
R = 0.3
DT = 0.1
TIME = DT * np.arange(201)


def met(track, people):
    return anticipation(track, people, CAR, R, reference_speed=4.0, stop_speed=0.2)


def braking(ego, begin: int, end: int, lowest: float = 1.0):
    """4 m/s from x = 0 on, ``lowest`` [m/s] between two instants, then 4 m/s again."""
    speed = np.full(len(TIME), 4.0)
    speed[begin:end] = lowest
    x = np.append(0.0, np.cumsum(DT * speed[:-1]))
    return ego(TIME, np.column_stack([x, np.zeros(len(x))]), speed=speed)


def test_the_time_to_the_first_person_counts_from_the_last_speed(ego, crowd, walking) -> None:
    # It has 4 m/s last at t = 3.9 s, at x = 15.6 m. Somebody stands at 40 m, skin at 39.7 m.
    people = crowd(walking(TIME, (60.0, 0.0), (0.0, 0.0)), walking(TIME, (40.0, 0.0), (0.0, 0.0)))
    found = met(braking(ego, 40, 60), people)
    assert found.ttc_at_slowing == pytest.approx((39.7 - 15.6) / 4.0, abs=1e-9)
    assert found.time_among_people == 0.0


def test_people_walk_as_they_did(ego, crowd, walking) -> None:
    # In the way of a car of 2 m width, grown by R, from y = -1.3 to 1.3 m: at 1.3 m/s from t = 5 s
    # on. The car would have been at x = 15 to 20 m then, so that they would have met at its side.
    walker = walking(TIME, (18.0, -7.8), (0.0, 1.3))
    found = met(braking(ego, 40, 100), crowd(walker))
    assert found.ttc_at_slowing == pytest.approx(5.0 - 3.9, abs=1e-9)
    gone_by = walking(TIME, (18.0, -7.8 + 1.3 * 3.0), (0.0, 1.3))  # in the way from 2 to 4 s
    assert np.isnan(met(braking(ego, 40, 100), crowd(gone_by)).ttc_at_slowing)


def test_who_never_slows_has_none(ego, crowd, walking) -> None:
    people = crowd(walking(TIME, (30.0, 0.0), (0.0, 0.0)))
    assert np.isnan(met(braking(ego, 40, 60, lowest=3.5), people).ttc_at_slowing)
    assert np.isnan(met(braking(ego, 40, 60), crowd()).ttc_at_slowing)


@pytest.mark.parametrize(
    ("speed", "begin"),
    [
        ([4, 4, 3.9, 3.7, 3.3, 3, 3], 2),  # 0.95 * 4 = 3.8, 0.8 * 4 = 3.2
        ([4, 3.7, 4, 4, 3, 3, 3], 3),
        ([4, 3.3, 3.3, 3.9, 3.9, 3.9, 3.9], None),
        ([3, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5], 0),
    ],
)
def test_slowing_begins_where_it_had_its_free_speed_last(ego, speed, begin) -> None:
    time = 0.5 * np.arange(7)
    assert slowing_begins(ego(time, speed=np.array(speed, dtype=float)), 4.0) == begin


def test_after_a_red_light_slowing_begins_after_its_end(ego) -> None:
    speed = np.array([4, 4, 2, 1, 1, 0.5, 0.5])
    stop_gap = np.array([np.inf, 20, 10, 5, np.inf, np.inf, np.inf])
    time, position = 0.5 * np.arange(7), np.array([0, 2, 3.5, 4.25, 4.75, 5.1, 5.4])
    track = ego(time, speed=speed, position=position, stop_gap=stop_gap)
    assert slowing_begins(track, 4.0) == 4


def standing(ego):
    """Its front at x = 0, standing from 2 s to 12 s."""
    speed = np.where((TIME >= 2.0 - 1e-9) & (TIME < 12.0 - 1e-9), 0.0, 4.0)
    x = np.append(0.0, np.cumsum(DT * speed[:-1])) - 8.0
    return ego(TIME, np.column_stack([x, np.zeros(len(x))]), speed=speed)


def crossing(walking, x: float, at: float):
    """Over the line of travel at ``x``, at the time ``at``."""
    return walking(TIME, (x, -1.3 * at), (0.0, 1.3))


def test_it_stands_among_people_from_the_first_to_the_last(ego, crowd, walking) -> None:
    in_front, behind = crossing(walking, 1.0, 4.03), crossing(walking, -7.0, 9.51)
    found = met(standing(ego), crowd(in_front, behind))
    assert found.time_among_people == pytest.approx(9.51 - 4.03, abs=1e-9)
    later = crossing(walking, 3.0, 10.0)
    found = met(standing(ego), crowd(in_front, behind, later))
    assert found.time_among_people == pytest.approx(10.0 - 4.03, abs=1e-9)


@pytest.mark.parametrize(
    ("x", "at"),
    [
        (1.0, 5.0),  # in front as well
        (-7.0, 14.0),  # it has gone by then
        (-10.5, 5.0),  # more than 5 m behind its rear at -5 m
        (-3.0, 5.0),  # over it
    ],
)
def test_on_one_side_or_far_away_they_do_not_walk_round_it(ego, crowd, walking, x, at) -> None:
    people = crowd(crossing(walking, 2.0, 4.0), crossing(walking, x, at))
    assert met(standing(ego), people).time_among_people == 0.0


def test_a_moving_ego_is_not_among_them(driving, crowd, walking) -> None:
    people = crowd(crossing(walking, 9.0, 2.0), crossing(walking, 2.0, 2.0))
    assert met(driving(TIME, 4.0), people).time_among_people == 0.0
