"""How an ego follows and approaches a vehicle."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.following import Following, gap_relaxation

DT = 0.05  # [s]
N = 60


def kept(leader: Leader, speed: float, coming: float = np.inf, origin: float = 0.0) -> float:
    """What is left of a safe distance of 8 m from an ego whose front bumper is at 40 m."""
    ahead = np.minimum(leader.station + DT * leader.speed * np.arange(1, N + 1), coming)
    return 8.0 - gap_relaxation(leader, ahead, 40.0, speed, 8.0, origin)


@pytest.mark.parametrize("origin", [0.0, -2.5])
def test_half_of_d_safe_is_kept_where_firm_braking_allows_it(origin: float) -> None:
    for leader in (NO_LEADER, Leader(60.0, 0.0), Leader(45.0, 4.0)):
        assert kept(leader, 4.0, origin=origin) == 4.0
        assert kept(leader, 4.0, coming=50.0, origin=origin) == 4.0


def test_a_plan_brakes_firmly_at_most_for_a_sudden_stop_ahead() -> None:
    for gap, speed, its_speed in [(4.4, 1.85, 0.1), (3.2, 1.4, 1.0), (4.5, 3.5, 0.0)]:
        room = gap - kept(Leader(40.0 + gap, its_speed), speed)
        assert (speed - its_speed) ** 2 / (2.0 * room) < 3.0
        assert room < gap - 1.9  # but it stops before
        from_the_side = gap - kept(NO_LEADER, speed, coming=40.0 + gap)
        assert speed**2 / (2.0 * from_the_side) < 3.0


def test_who_pulls_away_nearby_is_no_wall() -> None:
    assert kept(Leader(42.9, 13.5), 4.0) == pytest.approx(2.9)
    assert kept(Leader(41.2, 13.5), 4.0) == pytest.approx(1.2)


def test_a_quarter_of_d_safe_is_kept_however_hard_the_braking() -> None:
    assert kept(Leader(43.0, 0.0), 6.0) == 2.0
    assert kept(Leader(41.0, 0.0), 1.0) == 1.0  # it is nearer: not yet nearer


@pytest.mark.parametrize("origin", [0.0, -2.5])
def test_the_gap_relaxes_until_the_ego_has_left_the_zone(origin: float) -> None:
    """It drives up to where it may: not slower on the way, as what is left gets less."""
    following = Following(8.0 - origin, origin, 2.0, plans=True, tuned=False)
    leader, cleared = Leader(50.0, 0.0), 47.0
    for front in (40.0, 44.0, 46.0, 46.9):
        relaxation = following.keep_clear_relaxation(leader.station, front, cleared - front)
        assert 8.0 - relaxation == pytest.approx(2.5)  # it comes to a stand half a metre before
        assert following.speed_limit(leader, np.inf, front, cleared - front) > 0.0
    assert following.keep_clear_relaxation(leader.station, cleared, 0.0) == 0.0
    assert following.keep_clear_relaxation(60.0, 44.0, 3.0) == 0.0  # there is room enough
    assert following.keep_clear_relaxation(48.0, 44.0, 3.0) == 6.0  # it comes no nearer than 2 m
