"""In which order an ego and others come onto one lane, and what each of them has to heed.

y = 3.2   ------------------------------------------ main_1, from x = 0
                              .--- the ego's way ---
y = 0     ego ----------------'
                             100   130             x [m]
"""

import math

import pytest
from support.situations import demand_of, tell

from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.merge_points import MergePoint, MergingVehicle
from giveway.ego.rules.merging import Merging
from giveway.ego.rules.protocol import Situation
from giveway.ego.rules.rule_set import RuleSet

LENGTH = 5.0  # [m] of the ego
PLACE = MergePoint("main_1", frozenset(), 0.0, 100.0, 130.0)


def merging(**others):
    """An ego 20 m before the place at 10 m/s, which has seen others: (position, speed)."""
    merges = Merging((PLACE,), LENGTH)
    merging_vehicles = {name: MergingVehicle(*other, 5.0) for name, other in others.items()}
    return merges, see(merges, {PLACE: merging_vehicles}, 80.0, 10.0)


def see(merges, merging_vehicles, front, speed):
    """Tell it of the others; what those that keep behind it have to heed."""
    tell(merges, front, speed, merging=merging_vehicles)
    return merges.keeps_behind


def look(merges, front, speed):
    """Whom the ego follows, and where it waits."""
    demand = demand_of(merges, front, speed)
    return demand.leader, demand.stop


@pytest.mark.parametrize(
    ("position", "speed", "first"),
    [
        (90.0, 10.0, False),  # it is ahead
        (81.0, 10.0, False),  # by a little
        (81.0, 1.0, True),  # it is ahead, but waits
        (70.0, 10.0, True),  # it is behind, and as fast
        (50.0, 20.0, False),  # it is behind, but had to brake firmly
        (20.0, 14.0, True),  # it is far behind and has time to brake in comfort
        (77.0, 11.0, False),  # beside the ego it cannot fall back so soon
    ],
)
def test_a_vehicle_ahead_or_too_fast_to_brake_goes_first(position, speed, first):
    _, behind = merging(other=(position, speed))
    assert (set(behind) == {"other"}) == first


def test_the_ego_follows_a_merging_vehicle_before_it_is_ahead():
    merges, behind = merging(other=(92.0, 9.0))
    assert behind == {}
    leader, stop = look(merges, 80.0, 10.0)
    # 87 m is its rear; 20 m before the place a quarter of them may be missing still
    assert leader == Leader(87.0 + 0.25 * 20.0, 9.0 - 0.25 * 10.0)
    assert stop == math.inf
    assert look(merges, 99.9, 10.0)[0] == NO_LEADER  # it is too near, and can stop no more


def test_the_ego_waits_before_the_place_for_whoever_is_beside_it():
    merges, _ = merging(car=(80.5, 10.0))
    assert look(merges, 80.0, 10.0) == (NO_LEADER, 100.0 - 1.0 - 0.5)
    assert look(merges, 99.5, 1.0)[1] == 99.5  # it stands a little too far
    assert look(merges, 80.0, 20.0)[1] == math.inf  # nobody makes it brake harder than 3 m/s^2
    truck = MergingVehicle(82.0, 10.0, 12.0)
    see(merges, {PLACE: {"truck": truck}}, 80.0, 10.0)
    assert look(merges, 80.0, 10.0)[1] == 100.0 - 1.0 - 4.0
    see(merges, {PLACE: {}}, 80.0, 10.0)
    assert look(merges, 80.0, 10.0) == (NO_LEADER, math.inf)


def test_a_car_that_starts_beside_the_ego_does_not_make_it_brake_hard():
    """The ego has 20 m to let it go first; to follow it at once would be an emergency."""
    merges, starts = Merging((PLACE,), LENGTH), MergingVehicle(81.25, 3.7, 5.0)
    see(merges, {PLACE: {"starts": starts}}, 80.0, 5.2)
    assert look(merges, 80.0, 5.2) == (NO_LEADER, 100.0 - 1.0 - 0.5)
    assert look(merges, 80.0, 3.4)[0].station == 81.25  # it is as slow


def test_between_sumo_s_steps_the_others_drive_on():
    merges, _ = merging(other=(92.0, 9.0))
    merges.advance(Situation(speed=10.0), 0.5)
    assert look(merges, 80.0, 10.0)[0].station == pytest.approx(87.0 + 4.5 + 5.0)


def test_what_somebody_behind_has_to_heed():
    _, behind = merging(other=(60.0, 10.0))
    (heeds,) = behind.values()
    assert heeds.room == pytest.approx(80.0 - 5.0 - 60.0 - 1.0 + 0.25 * 20.0)
    assert heeds.speed == pytest.approx(0.75 * 10.0)
    assert heeds.to_wait == pytest.approx(100.0 - 60.0 - 1.0 - 0.5)
    assert heeds.braking == 2.0
    merges = Merging((PLACE,), LENGTH)
    (heeds,) = see(
        merges, {PLACE: {"other": MergingVehicle(80.0, 10.0, 5.0)}}, 104.0, 10.0
    ).values()
    assert heeds.room == pytest.approx(104.0 - 5.0 - 80.0 - 1.0)
    assert (heeds.speed, heeds.braking) == (10.0, math.inf)  # the ego is in its way


def test_an_ego_that_has_waited_asks_for_more():
    merges = Merging((PLACE,), LENGTH)
    merging_vehicles = {
        PLACE: {"passes": MergingVehicle(99.5, 13.0, 5.0), "next": MergingVehicle(62.0, 13.0, 5.0)}
    }
    assert see(merges, merging_vehicles, 98.0, 0.0) == {}
    for _ in range(60):
        merges.advance(Situation(speed=0.0), 0.1)
    (heeds,) = see(merges, merging_vehicles, 98.0, 0.0).values()
    assert heeds.braking == 3.0
    merges.advance(Situation(speed=2.0), 0.1)  # it drives
    merges = Merging((PLACE,), LENGTH)
    assert see(merges, merging_vehicles, 98.0, 0.0) == {}


def test_a_place_is_in_sight_from_80_m_before_it_to_its_end():
    rules = RuleSet([Merging((PLACE,), LENGTH)])
    assert rules.near_merges(19.0) == ()
    assert rules.near_merges(21.0) == (PLACE,)
    assert rules.near_merges(129.0) == (PLACE,)
    assert rules.near_merges(130.0) == ()
