"""How an ego follows and approaches a vehicle."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from controller import VehicleAhead
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.following import Following, gap_kept

DT = 0.05  # [s]
N = 60
USUAL = 2.0  # [m]


def following(**drives: Any) -> Following:
    return Following(8.0, 0.0, 2.0, DT, **drives)


def kept(leader: Leader, speed: float, coming: float = np.inf) -> float:
    """The gap that a plan keeps to a vehicle if its front bumper is at 40 m."""
    ahead = np.minimum(leader.station + DT * leader.speed * np.arange(1, N + 1), coming)
    return gap_kept(leader, ahead, 40.0, speed, USUAL)


def test_the_usual_gap_is_kept_where_firm_braking_allows_it() -> None:
    for leader in (NO_LEADER, Leader(60.0, 0.0), Leader(45.0, 4.0)):
        assert kept(leader, 4.0) == USUAL
        assert kept(leader, 4.0, coming=50.0) == USUAL


def test_a_plan_brakes_firmly_at_most_for_a_sudden_stop_ahead() -> None:
    for gap, speed, its_speed in [(2.4, 1.85, 0.1), (2.0, 1.4, 1.0), (3.5, 3.5, 0.0)]:
        room = gap - kept(Leader(40.0 + gap, its_speed), speed)
        assert (speed - its_speed) ** 2 / (2.0 * room) < 3.0
        assert room < gap - 0.9  # but it stops before
        from_the_side = gap - kept(NO_LEADER, speed, coming=40.0 + gap)
        assert speed**2 / (2.0 * from_the_side) < 3.0


def test_who_pulls_away_nearby_is_no_wall() -> None:
    assert kept(Leader(41.2, 13.5), 4.0) == pytest.approx(1.2)


def test_a_metre_is_kept_however_hard_the_braking() -> None:
    assert kept(Leader(43.0, 0.0), 6.0) == 1.0
    assert kept(Leader(40.5, 0.0), 1.0) == 0.5  # it is nearer: not yet nearer


@pytest.mark.parametrize("controller", [{"plans": True}, {"tuned": True}, {}])
def test_vehicles_are_approached_to_two_metres_instead_of_d_safe(controller: Any) -> None:
    """A controller keeps d_safe to what it is shown, which is therefore farther off."""
    follows, leader = following(**controller), Leader(60.0, 0.0)
    assert follows.leader_station(leader, 40.0, 0.0) == 66.0
    assert follows.gap_relaxation(leader, np.full(N, 60.0), 40.0, 4.0, 0.0) == 6.0
    assert follows.speed_limit(leader, 57.4, 0.0) > 0.0
    assert follows.speed_limit(leader, 58.0, 0.0) == 0.0


def test_the_papers_controllers_keep_d_safe_to_vehicles() -> None:
    follows, leader = following(paper=True), Leader(60.0, 4.0)
    assert follows.leader_station(leader, 40.0, 0.0) == 60.0
    assert follows.gap_relaxation(leader, np.full(N, 60.0), 40.0, 4.0, 0.0) == 0.0
    ahead = VehicleAhead(20.0, 4.0, step=1.0)
    expected = np.sqrt(4.0**2 + 2.0 * 2.0 * (20.0 - 8.5))
    assert follows.speed_limit(leader, 40.0, 0.0, 4.0, ahead) == pytest.approx(expected)


@pytest.mark.parametrize("step", [0.1, 0.5, 1.0])
@pytest.mark.parametrize("speed", [5.0, 10.0, 14.0])
def test_the_headway_is_a_second_and_the_age_of_the_news(step: float, speed: float) -> None:
    gap = 2.5 + (1.0 + step) * speed
    for more, faster in ((-0.5, False), (1.0, True)):
        follows = following()
        ahead = VehicleAhead(gap + more, speed, step=step)
        for _ in range(1000):
            limit = follows.speed_limit(Leader(40.0 + gap + more, speed), 40.0, 0.0, speed, ahead)
        if step * speed < 7.0:  # else the safe distance is a little more
            assert (limit >= speed) == faster
        assert speed - 1.5 < limit < speed + 1.5


def test_a_gap_is_restored_gently_unless_it_closes() -> None:
    def falls(its_speed: float, decelerates: float = 0.0) -> float:
        ahead = VehicleAhead(5.0, its_speed, decelerates=decelerates, step=0.1)
        asked = Leader(45.0, its_speed), 40.0, 0.0, 10.0, ahead
        follows = following()
        before, after = (follows.speed_limit(*asked) for _ in range(2))
        assert before == pytest.approx(10.0) or its_speed < 10.0 or decelerates > 0.0
        return (before - after) / DT

    assert falls(10.0) == pytest.approx(1.5)
    assert falls(4.0) == pytest.approx(1.2 * 36.0 / 8.0)
    assert falls(10.0, decelerates=4.0) > 2.0


def test_the_faster_a_vehicle_ahead_brakes_the_lower_is_the_limit() -> None:
    """A plan's braking builds up at once then, so that it need not become hard later."""
    ahead = VehicleAhead(15.0, 10.7, decelerates=4.5, step=0.2)
    planned, followed = (
        following(plans=plans).speed_limit(Leader(55.0, 10.7), 40.0, 0.0, 11.6, ahead)
        for plans in (True, False)
    )
    assert planned < 11.6 - 3.0
    assert planned < followed < 11.6 - 0.5


def test_the_gap_of_a_plan_relaxes_as_well() -> None:
    follows, leader = following(plans=True), Leader(44.0, 0.0)
    ahead = np.full(N, 44.0)
    assert follows.gap_relaxation(leader, ahead, 42.0, 0.0, 0.0) == 6.0
    assert follows.gap_relaxation(leader, ahead, 41.2, 0.0, 0.8) == pytest.approx(6.5)
    assert follows.gap_relaxation(leader, ahead, 42.0, 0.0, 5.0) == 7.0  # up to 1 m


def test_a_stop_is_approached_in_comfort() -> None:
    """Also by a controller that follows a limit with a lag; the paper's have the exact speed."""
    assert following(paper=True).stop_limit(56.0, 40.0) == pytest.approx(8.0)
    late = following().stop_limit(56.0, 40.0)
    assert late == pytest.approx(math.sqrt(2.0 * 2.0 * (16.0 - 0.5 * late)))
    assert following().stop_limit(np.inf, 40.0) == np.inf
    assert following().speed_limit(NO_LEADER, 40.0, 0.0) == np.inf


@pytest.mark.parametrize("origin", [0.0, -2.5])
def test_the_gap_relaxes_until_the_ego_has_left_the_zone(origin: float) -> None:
    """It drives up to where it may: not slower on the way, as what is left gets less."""
    follows = Following(8.0 - origin, origin, 2.0, DT, paper=True)
    leader, cleared = Leader(50.0, 0.0), 47.0
    for front in (40.0, 44.0, 46.0, 46.9):
        relaxation = follows.keep_clear_relaxation(leader.station, front, cleared - front)
        assert 8.0 - relaxation == pytest.approx(2.5)  # it comes to a stand half a metre before
        assert follows.speed_limit(leader, front, cleared - front) > 0.0
    assert follows.keep_clear_relaxation(leader.station, cleared, 0.0) == 0.0
    assert follows.keep_clear_relaxation(60.0, 44.0, 3.0) == 0.0  # there is room enough
    assert follows.keep_clear_relaxation(48.0, 44.0, 3.0) == 6.0  # it comes no nearer than 2 m
