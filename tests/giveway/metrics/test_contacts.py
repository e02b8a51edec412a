"""The ego moved into somebody, or somebody came into contact with it: told apart.

The car is 5 m x 2 m; its front bumper is at x = 0 at time 0 unless said otherwise, and it heads
along +x. A person is a circle of 0.27 m.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.geometry.bodies import VehicleShape
from giveway.metrics import contacts, critical_encounters, pedestrian_metrics, proximity

CAR = VehicleShape(length=5.0, width=2.0)
R = 0.27
DT = 0.05
TIME = DT * np.arange(81)


def kinds(ego, crowd):
    return contacts(ego, crowd, CAR, R, proximity(ego, crowd, CAR, R).clearance).tolist()


def test_nobody_near_is_no_contact(driving, crowd, walking):
    assert kinds(driving(TIME, 4.0), crowd(walking(TIME, (8.0, 5.0), (0.0, 0.0)))) == [""]


@pytest.mark.parametrize("speed", [0.5, 4.0, 20.0])
def test_who_stands_in_the_way_is_moved_into(driving, crowd, walking, speed):
    """At 20 m/s the bumper is 1 m further at the next instant: beyond the person's centre."""
    ahead = 1.37
    track = crowd(walking(TIME, (ahead, 0.0), (0.0, 0.0)))
    assert kinds(driving(TIME, speed), track) == ["frontal"]


def test_the_front_corner_belongs_to_the_front(driving, crowd, walking):
    track = crowd(walking(TIME, (2.0, 1.15), (0.0, 0.0)))
    assert kinds(driving(TIME, 4.0), track) == ["frontal"]


def test_walking_into_a_moving_cars_side_is_not_moved_into(driving, crowd, walking):
    """He crosses at 1.4 m/s and meets the side 2 m behind the bumper."""
    meets = (1.73 / 1.4) * 4.0 - 2.0
    track = crowd(walking(TIME, (meets, -3.0), (0.0, 1.4)))
    assert kinds(driving(TIME, 4.0), track) == ["side"]


def test_who_crosses_before_the_bumper_is_moved_into(driving, crowd, walking):
    """His centre is in the car's way before the bumper is there."""
    track = crowd(walking(TIME, (4.0, -1.4), (0.0, 1.4)))
    assert kinds(driving(TIME, 4.0), track) == ["frontal"]


def test_who_walks_into_a_standing_car_is_not_moved_into(ego, crowd, walking):
    track = crowd(
        walking(TIME, (1.0, 0.0), (-1.0, 0.0)),
        walking(TIME, (-6.5, 0.0), (1.0, 0.0)),
        walking(TIME, (-2.0, 2.0), (0.0, -1.0)),
    )
    assert kinds(ego(TIME, speed=0.0), track) == ["side", "side", "side"]


def test_a_car_that_starts_into_somebody_ahead_moves_into_them(ego, crowd):
    """Touched while it stood; then it drives at 0.5 m/s and he does not."""
    speed = np.where(TIME < 2.0, 0.0, 0.5)
    front = np.column_stack((np.append(0.0, np.cumsum(DT * speed[:-1])), np.zeros(TIME.size)))
    car = ego(TIME, front, speed=speed)
    standing = (0, [(0.2, 0.0, 0.0, 0.0)] * TIME.size)
    assert kinds(car, crowd(standing)) == ["frontal"]
    leaves = [(0.2, 0.0, 0.0, 0.0)] * 40 + [(1.0 + 0.05 * i, 0.0, 1.0, 0.0) for i in range(41)]
    assert kinds(car, crowd((0, leaves))) == ["side"]


def test_who_is_squeezed_along_the_side_is_not_moved_into(driving, crowd, walking):
    """He overlaps the side by 7 cm all the way from the middle to the rear."""
    track = crowd((50, [(5.0, 1.2, 0.0, 0.0)] * 10))
    assert kinds(driving(TIME, 4.0), track) == ["side"]


def test_who_overtakes_along_the_side_is_not_moved_into(driving, crowd, walking):
    """He walks at 1.5 m/s along a car of 0.5 m/s, overlapping its side and at last its corner."""
    track = crowd(walking(TIME, (-2.0, 1.15), (1.5, 0.0)))
    ego = driving(TIME, 0.5)
    p = track.x - ego.front_x
    assert (p[proximity(ego, track, CAR, R).clearance < 0.0] > 0.0).any()
    assert kinds(ego, track) == ["side"]


def test_a_car_that_catches_up_with_him_then_moves_into_him(ego, crowd, walking):
    """He overtakes it along the side; it accelerates while he still touches its corner."""
    track = crowd(walking(TIME, (-2.0, 1.15), (1.5, 0.0)))
    speed = np.where(TIME < 2.09, 0.5, 3.0)
    front = np.column_stack((np.append(0.0, np.cumsum(DT * speed[:-1])), np.zeros(TIME.size)))
    assert kinds(ego(TIME, front, speed=speed), track) == ["frontal"]


def test_creeping_below_a_centimetre_a_second_is_standing(driving, crowd, walking):
    track = crowd(walking(TIME, (1.0, 0.0), (-1.0, 0.0)))
    assert kinds(driving(TIME, 0.009), track) == ["side"]
    assert kinds(driving(TIME, 0.011), track) == ["frontal"]


def test_one_frontal_contact_among_several_counts(driving, crowd):
    """Ten instants at the side; he is away, and stands in front the second time."""
    states = [(5.0, 1.2, 0.0, 0.0)] * 10 + [(30.0, 9.0, 0.0, 0.0)] * 5 + [(14.0, 0.0, 0.0, 0.0)] * 6
    assert kinds(driving(TIME, 4.0), crowd((50, states))) == ["frontal"]


def test_who_appears_within_the_car_is_judged_where_he_appears(driving, crowd):
    ego = driving(TIME, 4.0)  # its bumper is at 8 m at step 40
    track = crowd((40, [(8.1, 0.0, 0.0, 0.0)]), (40, [(7.9, 0.0, 0.0, 0.0)]), (40, []))
    assert kinds(ego, track) == ["frontal", "side", ""]


def test_records_with_a_gap_in_time_are_not_joined(driving, crowd):
    """Seen far ahead at step 0 and beside the car at step 41, nowhere in between."""
    states = [(20.0, 0.0, 0.0, 0.0), (6.0, 1.1, 0.0, 0.0)]
    track = crowd((0, states))
    track.step[1] = 41
    assert kinds(driving(TIME, 4.0), track) == ["side"]


@given(st.integers(0, 10**6), st.booleans())
def test_every_overlap_is_one_or_the_other_in_any_frame(ego, crowd, walking, seed, drives):
    """Frontal and side contacts are exactly the overlaps, and do not depend on the axes."""
    random = np.random.default_rng(seed)
    time, speed, turn = TIME[:41], drives * random.uniform(0.02, 8.0), random.uniform(-3.0, 3.0)
    place, velocity = random.uniform((-6.0, -3.0), (10.0, 3.0)), random.uniform(-2.0, 2.0, 2)
    tables = []
    for heading in (0.0, turn):
        c, s = np.cos(heading), np.sin(heading)
        turned = np.array([[c, s], [-s, c]])
        front = np.column_stack((speed * time, np.zeros(time.size))) @ turned
        track = crowd(walking(time, place @ turned, velocity @ turned))
        tables.append(pedestrian_metrics(ego(time, front, heading, speed), track, CAR, R))
    for table in tables:
        assert ((table["minimum_clearance"] < 0.0) == (table["contact"] != "")).all()
        assert drives or table["contact"][0] != "frontal"
    assert tables[0]["contact"][0] == tables[1]["contact"][0]


def test_a_conflict_is_a_time_to_collision_below_1_5_seconds(driving, crowd, walking):
    """At 4 m/s the one 20 m ahead is 1.5 s from contact when the bumper is 6.27 m away."""
    ego = driving(TIME, 4.0)  # it has driven 16 m at the end
    ahead = walking(TIME, (20.0, 0.0), (0.0, 0.0))
    beside = walking(TIME, (8.0, 4.0), (0.0, 0.0))
    found = critical_encounters(ego, crowd(ahead, beside), CAR, R, 0.2)
    assert found.pedestrians == 1
    after = np.count_nonzero((20.0 - R - 4.0 * TIME) / 4.0 < 1.5)
    assert found.share == pytest.approx(after / TIME.size)


def test_who_walks_up_to_a_standing_car_is_no_conflict(ego, crowd, walking):
    track = crowd(walking(TIME, (2.0, 0.0), (-1.4, 0.0)))
    assert critical_encounters(ego(TIME, speed=0.2), track, CAR, R, 0.2).pedestrians == 0
    assert critical_encounters(ego(TIME, speed=0.21), track, CAR, R, 0.2).pedestrians == 1


def test_the_least_time_to_collision_tells_the_two_apart(ego, crowd, walking):
    """It stands for the first half, in which somebody walks up to it, and then drives off."""
    speed = np.where(np.arange(TIME.size) < TIME.size // 2, 0.2, 2.0)
    up_to = walking(TIME, (2.0, 0.0), (-1.4, 0.0))
    far = walking(TIME, (30.0, 0.0), (0.0, 0.0))
    standing = critical_encounters(ego(TIME, speed=0.2), crowd(up_to), CAR, R, 0.2)
    assert np.isnan(standing.minimum_ttc)
    drives = ego(TIME, speed=speed)
    found = critical_encounters(drives, crowd(far), CAR, R, 0.2)
    ttc = proximity(drives, crowd(far), CAR, R).time_to_collision
    assert found.minimum_ttc == ttc[TIME.size // 2 :].min() > 1.5
    assert found.pedestrians == 0
    both = critical_encounters(ego(TIME, speed=2.0), crowd(up_to, far), CAR, R, 0.2)
    assert both.minimum_ttc < 1.5
    assert both.pedestrians == 1


def test_two_at_once_are_two_persons_but_one_share(driving, crowd, walking):
    ego = driving(TIME, 4.0)
    one = walking(TIME, (5.0, 0.0), (0.0, 0.0))
    alone = critical_encounters(ego, crowd(one), CAR, R, 0.2)
    both = critical_encounters(ego, crowd(one, one), CAR, R, 0.2)
    assert (alone.pedestrians, both.pedestrians) == (1, 2)
    assert alone.share == both.share > 0.0


def test_a_drive_without_anybody_has_no_conflicts(driving, crowd):
    found = critical_encounters(driving(TIME, 4.0), crowd(), CAR, R, 0.2)
    assert (found.pedestrians, found.share) == (0, 0.0)


def test_a_contact_before_a_person_reacts_is_of_a_kind_of_its_own(driving, crowd, walking):
    """Both stand before the bumper, which reaches them at 0.3 s; one reacts from 0.2 s on."""
    stand = walking(TIME, (1.5, 0.0), (0.0, 0.0))
    track = replace(crowd(stand, stand, stand), reacts_from=np.array([0, 4, 40]))
    assert kinds(driving(TIME, 4.0), track) == ["frontal", "frontal", "recorded"]
