"""Where the ego gives way: a lane along x, crossed at 20 to 24 m by a crossing 7 m long.

y = 3.5   kerb ------+----+------
          <- oncoming|    |
y = 0     -----------|    |------
          ego -> 1.75 m below the middle
y = -3.5  kerb ------+----+------
                     20  24  x [m]
"""

import math

import numpy as np
import pytest
from support.situations import demand_of, stop_of, tell

from giveway.ego.perception.leader import Leader
from giveway.ego.rules.crossings import Crossings, Way
from giveway.ego.rules.path_crossings import crossings_on
from giveway.ego.rules.protocol import Demand, Situation
from giveway.ego.rules.rule_set import RuleSet
from giveway.ego.rules.yielding import STOP_BEFORE
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from giveway.sumo.network.pedestrian_crossings import Crossing
from giveway.sumo.signal_plans import SignalChange
from pedestrian_model import Crowd

SHAPE = VehicleShape(length=5.0, width=2.0)
LANE = -1.75  # [m] its y
LINE = 20.0 - STOP_BEFORE
NEAR = 13.0  # [m] from where it could stop before the line at 1.3 m/s^2
NOBODY = Crowd.empty()
SOUTHERN_KERB, NORTHERN_KERB = -3.5, 3.5


def crossings(zebra=True, light="", kerb_distance=1.5, kerb_time=0.0, change=None, **way):
    ends = np.array([[22.0, NORTHERN_KERB], [22.0, SOUTHERN_KERB]])
    crossing = Crossing(":j_c0_0", ends, 4.0, zebra, "tls" if light else "", 0 if light else -1)
    path = EgoPath.through([(0.0, LANE), (60.0, LANE)])
    found = crossings_on(path, SHAPE, [crossing])
    near = {"kerb_distance": kerb_distance, "kerb_time": kerb_time}
    own = {**near, "change_of": {"tls": change}.get}
    watched = Crossings(found, length=SHAPE.length, gap=1.0, **own, way=Way(**way))
    if light:
        tell(watched, 0.0, 4.0, signals={"tls": light})
    return watched


def walker(y, target=10.0, x=22.0, speed=1.4):
    """One person at (x, y) who walks towards (x, target)."""
    velocity = [0.0, math.copysign(speed, target - y)]
    return Crowd.create([[x, y]], [velocity], speed, [[(x, target)]])


@pytest.mark.parametrize(
    ("crowd", "stops"),
    [
        (walker(-2.0), True),  # in the ego's lane
        (walker(-3.4), True),  # has just left the kerb
        (walker(-4.5), True),  # at the kerb, on the way across
        (walker(-4.5, target=-20.0), False),  # at the kerb, and leaves
        (walker(-5.5), False),  # a step away from the kerb yet
        (walker(0.5), False),  # has passed the ego's lane
        (walker(2.0, target=-20.0), True),  # comes from the other side
        (walker(-2.0, x=27.0), False),  # crosses elsewhere
        (NOBODY, False),
    ],
)
def test_at_a_zebra_it_stops_for_whoever_uses_it_or_is_about_to(crowd, stops):
    assert stop_of(crossings(), NEAR, 4.0, crowd) == (
        pytest.approx(LINE, abs=0.11) if stops else math.inf
    )


def test_a_person_who_walks_along_the_kerb_does_not_cross():
    along = Crowd.create([[21.0, -4.2]], [[1.4, 0.0]], 1.4, [[(40.0, -4.4)]])
    assert stop_of(crossings(), NEAR, 4.0, along) == math.inf


def test_who_will_have_passed_when_the_ego_comes_costs_no_stop():
    somebody = walker(-2.0)
    assert stop_of(crossings(), 2.0, 4.0, somebody) == math.inf
    assert stop_of(crossings(), 12.0, 4.0, somebody) < math.inf


@pytest.mark.parametrize(
    ("letter", "at_the_kerb", "on_it"),
    [
        ("G", True, True),
        ("g", True, True),
        ("r", False, True),
        ("y", False, True),
        ("O", True, True),
    ],
)
def test_a_light_decides_who_may_enter_and_people_on_it_finish(letter, at_the_kerb, on_it):
    assert (stop_of(crossings(light=letter), NEAR, 4.0, walker(-4.0)) < math.inf) == at_the_kerb
    assert (stop_of(crossings(light=letter), NEAR, 4.0, walker(-2.0)) < math.inf) == on_it


def test_who_waits_for_green_a_step_from_the_kerb_costs_no_stop():
    waiting = Crowd.create(
        [[22.0, -3.3]], [[0, 0]], 1.4, [[(22, -3.9), (22, 3.9)]], signals=[[0, -1]]
    )
    assert stop_of(crossings(light="r"), NEAR, 4.0, waiting) == math.inf


def test_who_waits_at_another_crossings_light_costs_no_stop():
    """The place to wait is so near that the way to it may lead anywhere."""
    corner = Crowd.create(
        [[22.0, -4.6]], [[0, 0]], 1.4, [[(22.1, -4.0), (30.0, -4.0)]], signals=[[1, -1]]
    )
    assert stop_of(crossings(light="G", kerb_time=2.5), NEAR, 4.0, corner) == math.inf
    own = Crowd.create(
        [[22.0, -4.6]], [[0, 0]], 1.4, [[(22.1, -4.0), (22.0, 4.0)]], signals=[[0, -1]]
    )
    assert stop_of(crossings(light="G", kerb_time=2.5), NEAR, 4.0, own) < math.inf


def test_in_the_last_metre_it_brakes_no_harder_than_3():
    somebody = walker(-2.0)
    stop = stop_of(crossings(), 19.4, 0.8, somebody)
    assert 19.4 + 0.8**2 / (2 * 3.0) <= stop <= 20.0
    assert stop_of(crossings(), 19.4, 1.6, somebody) == math.inf  # too late: over it and away


@pytest.mark.parametrize("front", [8.0, 14.0, 17.5])
def test_who_could_be_let_pass_by_the_law_is_let_pass(front):
    """The ledger's encounters are those for whom a stop at the crossing itself takes 3 m/s^2."""
    entry = 20.0
    speed = math.sqrt(2 * 2.95 * (entry - front))
    assert LINE - 0.11 <= stop_of(crossings(), front, speed, walker(-2.0)) <= 19.81


@pytest.mark.parametrize("front", [16.6, 17.2, 18.4])
def test_a_plan_beyond_the_stop_does_not_enter_the_crossing(front):
    speed = math.sqrt(2 * 2.99 * (19.7 - front))  # it is just not too late yet
    watched = crossings()
    assert demand_of(watched, front, speed, NOBODY).latest == math.inf
    demand = demand_of(watched, front, speed, walker(-2.0))
    assert LINE - 0.11 <= demand.stop <= demand.latest
    assert demand.latest == pytest.approx(19.7, abs=0.11)
    assert demand_of(watched, front, speed, NOBODY)[:3] == (math.inf, "", math.inf)


def test_who_heads_for_the_side_of_a_crossing_wants_to_cross():
    """The way-point at the kerb is a line; its middle is 1.8 m aside."""
    aside = Crowd.create(
        [[23.8, -3.9]], [[0, 1.4]], 1.4, [[(22.0, -3.2)]], passages=[[(0.0, 1.0, 2.0)]]
    )
    assert stop_of(crossings(), NEAR, 4.0, aside) < math.inf


def test_without_priority_people_wait_for_a_gap():
    assert stop_of(crossings(zebra=False), NEAR, 4.0, walker(-4.0)) == math.inf
    assert stop_of(crossings(zebra=False), NEAR, 4.0, walker(-2.0)) < math.inf


def test_hard_braking_is_not_demanded_but_a_begun_stop_goes_on():
    too_late = crossings()
    assert stop_of(too_late, 18.0, 4.0, walker(-2.0)) == math.inf  # 4 m/s^2 to the crossing
    begun = crossings()
    assert stop_of(begun, 16.0, 4.0, walker(-4.0)) < math.inf
    assert stop_of(begun, 18.0, 4.0, walker(-3.0)) == pytest.approx(LINE, abs=0.11)
    assert stop_of(begun, 19.5, 0.3, walker(-2.0)) == pytest.approx(LINE, abs=0.11)  # no creeping


def test_who_comes_as_the_ego_drives_off_is_stopped_for_farther_on():
    """Not at the line where it waited before, which would take 13 m/s^2."""
    watched = crossings()
    assert stop_of(watched, LINE, 0.0, walker(-2.0)) == pytest.approx(LINE, abs=0.11)
    assert stop_of(watched, LINE, 0.0, NOBODY) == math.inf
    stop = stop_of(watched, LINE - 0.1, 1.6, walker(-4.0))
    assert LINE - 0.1 + 1.6**2 / (2 * 3.0) <= stop <= 19.71


def test_it_waits_until_all_have_passed_and_nobody_comes_soon():
    waiting = crossings()
    both = walker(-2.0).concatenate(walker(3.4, target=-20.0))
    assert stop_of(waiting, LINE, 0.0, both) < math.inf
    assert stop_of(waiting, LINE, 0.0, walker(3.4, target=-20.0)) < math.inf  # 2.5 s away
    assert stop_of(waiting, LINE, 0.0, walker(0.2)) == math.inf
    assert stop_of(waiting, 21.0, 2.0, walker(-2.0)) == math.inf  # it is on the crossing


def test_a_wide_reach_at_the_kerb_makes_it_wait_earlier():
    assert stop_of(crossings(kerb_distance=0.2), NEAR, 4.0, walker(-4.0)) == math.inf
    assert stop_of(crossings(kerb_distance=3.0), NEAR, 4.0, walker(-6.0)) < math.inf
    # they have 1.4 m/s and 2.5 m to go
    assert stop_of(crossings(kerb_time=1.7), NEAR, 4.0, walker(-6.0)) == math.inf
    assert stop_of(crossings(kerb_time=1.9), NEAR, 4.0, walker(-6.0)) < math.inf


@pytest.mark.parametrize("beyond", [0.01, 0.1])
def test_a_person_just_over_the_line_at_the_kerb_costs_no_stop(beyond):
    """The model has not noted it yet; the nearest point of the line is behind them."""
    line, on = (22.0, SOUTHERN_KERB - 0.4), (18.0, -5.0)
    passages = [[(0.0, -1.0, 2.0), (0.0, 0.0, 0.0)]]
    at = [[22.3, line[1] - beyond]]
    gone = Crowd.create(at, [[0.0, -1.4]], 1.4, [[line, on]], passages=passages)
    assert stop_of(crossings(kerb_time=2.5), NEAR, 4.0, gone) == math.inf


@pytest.mark.parametrize(("front", "speed"), [(LINE, 0.0), (LINE - 1.0, 0.6), (LINE - 5.0, 3.5)])
@pytest.mark.parametrize("most", [1.5, 2.4])
def test_an_ego_that_starts_behind_a_person_does_not_stop_again(front, speed, most):
    """With 2.5 m/s^3 up to so many m/s^2."""
    watched, y, acceleration = crossings(), -2.0, 0.0
    stopped = [stop_of(watched, front, speed, walker(y)) < math.inf]
    while front < 20.0:
        y += 1.4 * 0.05
        stops = stop_of(watched, front, speed, walker(y)) < math.inf
        acceleration = -speed / 2.0 if stops else min(max(acceleration, 0.0) + 2.5 * 0.05, most)
        front += speed * 0.05
        speed = max(0.0, speed + acceleration * 0.05)
        stopped.append(stops)
    assert stopped[0]
    assert stopped == sorted(stopped, reverse=True)  # once it may go it may go on


@pytest.mark.parametrize(
    ("station", "speed", "stops"),
    [(28.0, 0.0, True), (31.0, 0.0, False), (28.0, 5.0, False), (15.0, 0.0, False)],
)
def test_it_does_not_drive_onto_a_crossing_that_it_cannot_leave(station, speed, stops):
    """A vehicle behind the crossing leaves room for 5 m and a gap, or not."""
    found = stop_of(crossings(), NEAR, 4.0, NOBODY, Leader(station, speed))
    assert found == (pytest.approx(LINE, abs=0.11) if stops else math.inf)


def test_it_brakes_firmly_at_most_for_who_becomes_slow_behind_a_crossing():
    """The brake takes time to build up: a stop that was begun goes on meanwhile."""
    slow, watched = Leader(28.0, 1.9), crossings()
    assert stop_of(crossings(), LINE - 1.6, 3.7, NOBODY, slow) == math.inf
    assert stop_of(watched, LINE - 4.0, 3.9, NOBODY, slow) < math.inf
    assert stop_of(watched, LINE - 1.6, 3.7, NOBODY, slow) < math.inf


@pytest.mark.parametrize(
    ("x", "then", "stops"),
    [
        (17.5, (22.0, 10.0), True),  # 4.5 m along the sidewalk to the kerb, and over the road
        (17.5, (40.0, -4.5), False),  # on along the sidewalk
        (14.0, (22.0, 10.0), False),  # too far away to tell
    ],
)
def test_who_walks_along_the_road_and_is_going_to_turn_in(x, then, stops):
    corner = (22.0, -4.0)
    walks = Crowd.create([[x, -4.5]], [[1.4, 0.0]], 1.4, [[corner, then]])
    assert (stop_of(crossings(kerb_time=3.5), NEAR, 4.0, walks) < math.inf) == stops


@pytest.mark.parametrize(
    ("y", "change", "stops"),
    [
        (-6.3, None, True),  # 2 s from the kerb, green for as long as anybody knows
        (-6.3, SignalChange(3.0, "r"), True),
        (-6.3, SignalChange(1.0, "r"), False),  # their light will be red before they are there
        (-6.3, SignalChange(1.0, "G"), True),  # or green in the next phase, too
        (-4.9, SignalChange(0.1, "r"), True),  # at the kerb nobody relies on that
        (-3.0, SignalChange(0.1, "r"), True),  # who is on the crossing may finish
    ],
)
def test_who_will_find_their_light_red_is_not_waited_for(y, change, stops):
    watched = crossings(zebra=False, light="G", kerb_time=2.5, change=change)
    assert (stop_of(watched, NEAR, 4.0, walker(y)) < math.inf) == stops


def test_a_wait_before_two_crossings_keeps_its_time_margin():
    """Between the two there is no room to stand; somebody else comes 3 s later."""
    ends = np.array([[0.0, NORTHERN_KERB], [0.0, SOUTHERN_KERB]])
    both = [Crossing(f":j_c{x}_0", ends + [x, 0.0], 4.0, True, "", -1) for x in (22.0, 28.0)]
    path = EgoPath.through([(0.0, LANE), (60.0, LANE)])
    found = crossings_on(path, SHAPE, both)
    waiting, fresh = (
        Crossings(found, length=SHAPE.length, gap=1.0, kerb_distance=1.5, kerb_time=2.5)
        for _ in range(2)
    )
    later = walker(SOUTHERN_KERB - 3.0 * 1.4, x=28.0)
    assert stop_of(fresh, LINE, 0.0, later) == math.inf
    assert stop_of(waiting, LINE, 0.0, walker(-3.4, speed=1.0, x=28.0)) < math.inf
    assert stop_of(waiting, LINE, 0.0, later) < math.inf
    assert stop_of(waiting, LINE, 0.0, NOBODY) == math.inf
    assert stop_of(waiting, LINE, 0.0, later) == math.inf


def test_what_it_keeps_free_and_how_far_it_has_to_drive_on():
    way = RuleSet([crossings()])
    places = (LINE, 20.5, 24.0, 28.0, 29.2)  # [m] of the front bumper; the body is 5 m long
    assert [way.keep_clear_distance(at) for at in places] == pytest.approx(
        [0, 8.5, 5.0, 1.0, 0], abs=0.11
    )
    assert RuleSet().keep_clear_distance(20.5) == 0.0


# --- a crossing behind a junction without a light -------------------------------------------------

ENTRANCE = 14.0  # [m] the line of a junction in which a stop before the crossing would be
THERE = {"junctions": [(ENTRANCE, ENTRANCE, 30.0)]}
EARLY = 5.0  # [m] from where it could stop before either


def test_it_waits_before_the_junction_rather_than_in_it():
    crowd = walker(-2.0, speed=0.5)
    assert stop_of(crossings(), EARLY, 4.0, crowd) == pytest.approx(LINE, abs=0.11)
    assert stop_of(crossings(**THERE), EARLY, 4.0, crowd) == ENTRANCE - STOP_BEFORE
    too_late = crossings(**THERE), ENTRANCE + 1.0, 3.0, crowd
    assert stop_of(*too_late) == pytest.approx(LINE, abs=0.11)
    near = crossings(junctions=[(18.0, 18.0, 30.0)])  # a stop just behind its line is not in it
    assert stop_of(near, EARLY, 4.0, crowd) == pytest.approx(LINE, abs=0.11)


def test_before_a_junction_it_looks_for_who_will_cross_behind_it():
    crowd = walker(SOUTHERN_KERB - 3.0)  # at the kerb when the ego is at the crossing
    assert stop_of(crossings(), EARLY, 6.0, crowd) == math.inf
    assert stop_of(crossings(**THERE), EARLY, 6.0, crowd) == ENTRANCE - STOP_BEFORE
    assert stop_of(crossings(**THERE), EARLY, 6.0, walker(SOUTHERN_KERB - 30.0)) == math.inf


def test_before_a_junction_it_heeds_those_with_priority_alone():
    """The others wait for a gap."""
    there = EARLY, 4.0, walker(-4.5)  # about to enter
    assert stop_of(crossings(**THERE), *there) == ENTRANCE - STOP_BEFORE
    assert stop_of(crossings(zebra=False, **THERE), *there) == math.inf


def test_a_stream_of_people_does_not_hold_it_before_a_junction():
    behind, stream = crossings(**THERE), walker(-2.0, speed=0.5)
    standing = ENTRANCE - STOP_BEFORE
    stops = [
        (behind.demand(Situation(time, standing, 0.0, stream)) or Demand()).stop
        for time in (0.0, 9.0, 11.0)
    ]
    assert stops == [standing, standing, pytest.approx(LINE, abs=0.11)]


def test_its_own_time_is_at_least_that_of_the_free_speed():
    crowd = walker(SOUTHERN_KERB - 1.0)  # on its way after 1.5 s, away from it after 3.6 s
    assert stop_of(crossings(kerb_time=2.5), EARLY, 6.0, crowd) < math.inf
    slow = crossings(kerb_time=2.5, duration=lambda begin, end: (end - begin) / 2.0)
    assert stop_of(slow, EARLY, 6.0, crowd) == math.inf


def test_it_waits_at_the_stop_line_that_the_network_sets():
    crowd = walker(-2.0, speed=0.5)
    line = {"lines": [(12.0, 19.0)]}  # 7 m before the lane's end, 8 m before the crossing
    assert stop_of(crossings(**line), EARLY, 4.0, crowd) == 12.0 - STOP_BEFORE
    for lines, front, speed in (([(12.0, 19.0)], 12.5, 3.0), ([(2.0, 9.0)], 1.0, 4.0)):
        assert stop_of(crossings(lines=lines), front, speed, crowd) == pytest.approx(LINE, abs=0.11)
