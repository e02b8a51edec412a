"""Serious conflicts by hand: an ego drives towards people who stand, walk or come from beside."""

from __future__ import annotations

from math import exp

import numpy as np
import pytest

from giveway.geometry.bodies import VehicleShape
from giveway.metrics import pedestrian_metrics
from giveway.metrics.serious_conflicts import SeriousConflicts, border, serious

CAR = VehicleShape(length=5.0, width=2.0)
R = 0.25
STEP = 0.1


@pytest.fixture
def judge(ego, crowd):
    """Time to accident, conflicting speed and verdict of one pedestrian with these states."""

    def measure(speed, states, acceleration=0.0):
        count = len(states)
        speed = np.full(count, speed)
        x = np.append(0.0, np.cumsum(speed[:-1] * STEP))
        front = np.column_stack([x, np.zeros(count)])
        time = STEP * np.arange(count)
        track = ego(time, front, speed=speed, acceleration=np.full(count, acceleration))
        row = pedestrian_metrics(track, crowd((0, states)), CAR, R).iloc[0]
        found = row["time_to_accident"], row["conflicting_speed"]
        return *found, bool(serious(SeriousConflicts(*(np.array([each]) for each in found)))[0])

    return measure


def stands(x, count, y=0.0):
    return [(x + R, y, 0.0, 0.0)] * count


@pytest.mark.parametrize(
    ("speed", "expected"),
    [(0.0, 0.0), (4.0, 0.381956), (8.0, 0.812124), (50 / 3.6, 1.542872)],
)
def test_the_border_grows_with_the_speed(speed, expected):
    assert border(np.array([speed])) == pytest.approx(expected, abs=1e-6)
    assert border(np.array([speed])) == pytest.approx(1.5 * speed / 16.7 * exp(0.0153 * speed))


@pytest.mark.parametrize(
    ("last", "ttc", "is_serious"),
    [(5, 0.5, False), (6, 0.4, False), (7, 0.3, True), (10, 0.0, True)],
)
def test_who_is_not_evaded_is_rated_at_the_last_instant(judge, last, ttc, is_serious):
    """At 4 m/s the skin is 1 s ahead of the bumper; the border is 0.38 s."""
    found = judge(4.0, stands(4.0, last + 1))
    assert found == (pytest.approx(ttc, abs=1e-9), 4.0, is_serious)


def test_an_evasion_is_rated_at_its_beginning(judge):
    """It brakes harder than 3 m/s^2 from 0.5 s before the contact on, or only after 0.3 s."""
    begins = np.where(np.arange(9) >= 5, -3.1, 0.0)
    assert judge(4.0, stands(4.0, 9), begins) == (pytest.approx(0.5), 4.0, False)
    late = np.where(np.arange(9) >= 7, -3.1, 0.0)
    assert judge(4.0, stands(4.0, 9), late) == (pytest.approx(0.3), 4.0, True)
    mild = np.where(np.arange(9) >= 5, -3.0, 0.0)
    assert judge(4.0, stands(4.0, 9), mild) == (pytest.approx(0.2), 4.0, True)
    let_go = np.where(np.arange(9) == 5, -3.1, 0.0)
    assert judge(4.0, stands(4.0, 9), let_go) == (pytest.approx(0.2), 4.0, True)


def test_a_contact_counts_however_it_brakes(judge):
    assert judge(2.0, stands(0.2, 3), -5.0) == (0.0, 2.0, True)


def test_a_standing_ego_has_no_conflict(judge):
    walks = [(1.0 - 0.2 * k, 0.0, -2.0, 0.0) for k in range(5)]
    assert np.isnan(judge(0.2, walks)[:2]).all()
    assert not judge(0.2, walks)[2]


def test_who_comes_from_beside_is_rated_by_their_own_speed(judge):
    """They walk 2 m/s towards the flank, 0.2 or 0.1 s away from it; their border is 0.185 s."""

    def walks(*gaps):
        places = enumerate(gaps)
        return [(4.0 * STEP * k - 2.0, 1.0 + R + gap, 0.0, -2.0) for k, gap in places]

    assert judge(4.0, walks(0.6, 0.4)) == (pytest.approx(0.2), 2.0, False)
    assert judge(4.0, walks(0.4, 0.2)) == (pytest.approx(0.1), 2.0, True)


def test_who_is_on_no_collision_course_has_no_conflict(judge):
    assert np.isnan(judge(4.0, stands(4.0, 15, y=1.5))[:2]).all()
