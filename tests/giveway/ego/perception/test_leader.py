"""What an ego expects of the vehicles beside its path."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.ego.perception.leader import (
    NO_LEADER,
    Following,
    Leader,
    given_up,
    vehicles_in_front,
)
from giveway.geometry.path import EgoPath

DT = 0.05  # [s]
N = 60
BEND = np.pi / 2 * np.linspace(0.0, 1.0, 46)
#: 40 m straight, then a bend of 30 m radius to the left.
PATH = EgoPath.through(
    np.concatenate(
        [
            [(-40.0, 0.0)],
            np.column_stack([30.0 * np.sin(BEND), 30.0 * (1.0 - np.cos(BEND))]),
        ]
    )
)


def expected(
    x: float,
    y: float,
    heading: float,
    speed: float,
    straight: int,
    *,
    path: EgoPath = PATH,
    beside: bool = False,
) -> float:
    """How near [m] a vehicle is expected in front of an ego that is at the bend's begin."""
    steps = DT * speed * np.arange(N)
    poses = np.zeros((N, 2, 7))
    poses[:, 0, 0] = -40.0  # the ego's row
    poses[:, 1, 0], poses[:, 1, 1] = x + steps * np.cos(heading), y + steps * np.sin(heading)
    poses[:, 1, 2:] = heading, speed, 2.5, 2.5, 1.8
    ahead = np.empty(N)
    front, half_width = 40.0, 1.4
    road, known = (path.vertices, path.stations, path.headings), np.array([beside])
    vehicles_in_front(*road, poses, 0, front, 4.0 * DT, DT, half_width, straight, known, ahead)
    return float(ahead.min() - front)


def test_who_overtakes_in_a_bend_is_expected_to_keep_to_its_lane():
    """A faster car on the lane to the right, which straight on would cross the ego's."""
    overtaking = (1.0, -3.2, 0.05, 13.0)
    inside = (-6.0, 3.2, 0.0, 13.0)  # on the lane to the left: straight on, it would cut in
    assert expected(*inside, straight=N) < 15.0
    assert expected(*inside, straight=20) == np.inf
    assert expected(*overtaking, straight=20) == np.inf


@pytest.mark.parametrize("heading", [np.pi / 2, -np.pi / 2, np.pi / 4])
def test_who_comes_from_the_side_is_still_expected(heading):
    x, y = 8.0 - 6.0 * np.cos(heading), 1.0 - 6.0 * np.sin(heading)
    assert expected(x, y, heading, 8.0, straight=20) < 12.0


@pytest.mark.parametrize("heading", [np.pi / 2, -np.pi / 2])
def test_whose_lane_leads_past_the_path_is_not_expected_on_it(heading):
    """But where it is in front now, it is."""
    x, y = 8.0 - 6.0 * np.cos(heading), 1.0 - 6.0 * np.sin(heading)
    assert expected(x, y, heading, 8.0, straight=20, beside=True) == np.inf
    there = 8.0, 1.0, heading, 8.0
    assert expected(*there, straight=20, beside=True) < 12.0


def test_who_crosses_beyond_the_end_of_the_path_is_no_matter():
    """There the ego is at its goal."""
    crossing = 8.0, -7.0, np.pi / 2, 8.0
    ends = EgoPath.through([(-40.0, 0.0), (5.0, 0.0)])
    goes_on = EgoPath.through([(-40.0, 0.0), (15.0, 0.0)])
    assert expected(*crossing, straight=20, path=ends) == np.inf
    assert expected(*crossing, straight=20, path=goes_on) < 8.0


def kept(leader: Leader, speed: float, coming: float = np.inf, origin: float = 0.0) -> float:
    """What is left of a safe distance of 8 m from an ego whose front bumper is at 40 m."""
    ahead = np.minimum(leader.station + DT * leader.speed * np.arange(1, N + 1), coming)
    return 8.0 - given_up(leader, ahead, 40.0, speed, 8.0, origin)


@pytest.mark.parametrize("origin", [0.0, -2.5])
def test_half_of_the_safe_distance_is_kept_where_firm_braking_allows_it(origin: float) -> None:
    for leader in (NO_LEADER, Leader(60.0, 0.0), Leader(45.0, 4.0)):
        assert kept(leader, 4.0, origin=origin) == 4.0
        assert kept(leader, 4.0, coming=50.0, origin=origin) == 4.0


def test_a_plan_need_brake_no_harder_than_firmly_for_who_stops_at_once() -> None:
    for gap, speed, its_speed in [(4.4, 1.85, 0.1), (3.2, 1.4, 1.0), (4.5, 3.5, 0.0)]:
        room = gap - kept(Leader(40.0 + gap, its_speed), speed)
        assert (speed - its_speed) ** 2 / (2.0 * room) < 3.0
        assert room < gap - 1.9  # but it stops before
        from_the_side = gap - kept(NO_LEADER, speed, coming=40.0 + gap)
        assert speed**2 / (2.0 * from_the_side) < 3.0


def test_who_pulls_away_nearby_is_no_wall() -> None:
    assert kept(Leader(42.9, 13.5), 4.0) == pytest.approx(2.9)
    assert kept(Leader(41.2, 13.5), 4.0) == pytest.approx(1.2)


def test_a_quarter_of_the_safe_distance_is_kept_however_hard_the_braking() -> None:
    assert kept(Leader(43.0, 0.0), 6.0) == 2.0
    assert kept(Leader(41.0, 0.0), 1.0) == 1.0  # it is nearer: not yet nearer


@pytest.mark.parametrize("origin", [0.0, -2.5])
def test_it_closes_up_until_it_has_left_what_it_would_block(origin: float) -> None:
    """It drives up to where it may: not slower on the way, as what is left gets less."""
    following = Following(8.0 - origin, origin, 2.0, plans=True, tuned=False)
    leader, cleared = Leader(50.0, 0.0), 47.0
    for front in (40.0, 44.0, 46.0, 46.9):
        spared = following.closes_up(leader.station, front, cleared - front)
        assert 8.0 - spared == pytest.approx(2.5)  # it comes to a stand half a metre before
        assert following.speed_limit(leader, np.inf, front, cleared - front) > 0.0
    assert following.closes_up(leader.station, cleared, 0.0) == 0.0
    assert following.closes_up(60.0, 44.0, 3.0) == 0.0  # there is room enough
    assert following.closes_up(48.0, 44.0, 3.0) == 6.0  # it comes no nearer than 2 m
