"""Who is believed to let the ego pass: hand-made walkers, and the formula by itself."""

import math

import numpy as np
import pytest

from controller import LongitudinalModel, Planner, PlannerParameters
from controller.planning import Road
from giveway.ego.foresight.crowd_foresight import CrowdForesight, EgoAssumptions, plan_predictor
from giveway.ego.foresight.expected_motions import KEEPS_ON, STOPS, WALKS
from giveway.ego.foresight.intent import IntentEstimator, shifted
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from pedestrian_model import OPEN_GROUND, SIM, Crowd, CrowdModel, Vehicles

DT, EVERY, HALF = 0.05, 2, 1.15
PREDICTOR = plan_predictor(SIM, DT, 20)
STRAIGHT = EgoPath.through([(0.0, 0.0), (100.0, 0.0)])
BEND = EgoPath.through([(0.0, -20.0), (0.0, 0.0), (50.0, 0.0)])
FRONT = 10.0
PACE = 1.39


def estimator(path=STRAIGHT):
    return IntentEstimator(path, HALF, PREDICTOR, DT)


def walker(y, v_y, *, x=18.0, to=20.0):
    return Crowd.create([(x, y)], [(0.0, v_y)], PACE, [[(x, to)]])


def expect(crowd):
    """What the model without a vehicle expects of a crowd one step of the prediction on."""
    model, after = CrowdModel(SIM, DT), crowd.copy()
    for _ in range(EVERY):
        after = model.step(after, Vehicles.empty())
    return np.column_stack([after.position, after.velocity]).ravel()


def watch(seen, speed_at, y=-4.0, steps=60, front=FRONT):
    """Somebody walks towards the way at ``speed_at(room)``; the odds at each look."""
    odds, expected, ways = [], np.empty(0), []
    v = speed_at(-y - HALF)
    for _ in range(steps):
        crowd = walker(y, v)
        seen.update(crowd, np.array([7]), front, expected)
        odds.append(seen.odds(7))
        ways.append(crowd.waypoints[0].copy())
        expected = expect(crowd)
        v += min(max(speed_at(-y - HALF) - v, -3.0 * DT), 3.0 * DT)
        y += DT * v
    return odds, ways


def test_who_walks_on_is_expected_to():
    odds, ways = watch(estimator(), lambda _: PACE, y=-6.0)
    assert max(odds) < -2.9
    assert all((way == (18.0, 20.0)).all() for way in ways)


def test_a_person_who_slows_down_is_found_out_before_standing():
    odds, ways = watch(estimator(), lambda room: min(PACE, max(room, 0.0) / 2.0))
    first = next(i for i, found in enumerate(odds) if found > 0.0)
    assert first < 20
    assert odds[-1] > 0.0  # and so he stays
    for found, way in zip(odds, ways, strict=True):
        if found <= 0.0:
            assert (way == (18.0, 20.0)).all()
        else:
            assert way[0] == 18.0
            assert -4.0 < way[1] < -HALF


@pytest.mark.parametrize(("share", "expected"), [(0.9, KEEPS_ON), (0.5, STOPS)])
def test_who_becomes_slower_on_the_way_is_expected_to_stop(share, expected):
    """Not only once they stand: half a second is two metres at 4 m/s."""
    seen = estimator()
    for k in range(40):
        pace = PACE if k < 38 else share * PACE
        seen.update(walker(0.0, pace), np.array([7]), FRONT, np.empty(0))
    assert seen.yielding[0].tolist() == [expected]


@pytest.mark.parametrize(
    ("y", "pace", "expected"),
    [(0.0, PACE, KEEPS_ON), (0.0, 0.0, KEEPS_ON), (-2.4, 0.0, KEEPS_ON), (-2.4, PACE, WALKS)],
    ids=["walks on the way", "stands on the way", "stands beside it", "walks beside it"],
)
def test_who_is_on_the_way_or_stands_is_not_pushed_aside(y, pace, expected):
    seen = estimator()
    seen.update(walker(y, pace), np.array([7]), FRONT, np.empty(0))
    assert seen.yielding[0].tolist() == [expected]


@pytest.mark.parametrize(
    ("course", "sees"),
    [
        ((-1.2, 0.0), True),  # towards the ego
        ((0.0, 1.2), True),  # across
        ((0.5, 1.2), False),  # across and away, 113 degrees off
        ((1.2, 0.0), False),  # away
        ((0.0, 0.0), False),  # never seen walking
    ],
)
def test_people_see_what_they_walk_towards_or_past(course, sees):
    seen = estimator()
    for velocity in (course, course, (0.0, 0.0)):
        crowd = Crowd.create([(14.0, 0.3)], [velocity], PACE, [[(14.0, 20.0)]])
        seen.update(crowd, np.array([3]), FRONT, np.empty(0))
    assert seen.unaware.tolist() == [not sees]


def test_who_goes_on_after_all_is_believed():
    seen = estimator()
    odds, _ = watch(seen, lambda room: min(PACE, max(room, 0.0) / 2.0), steps=50)
    assert odds[-1] > 0.0
    odds, _ = watch(seen, lambda _: PACE, y=-HALF - 0.4, steps=7)
    assert odds[-1] < 0.0


@pytest.mark.parametrize("left", [0.3, 0.6, 0.9])
def test_the_place_of_a_stop_follows_from_the_approach_speed(left):
    """VCI's walk towards a destination, seen in the middle of it; a hand is kept to spare."""
    seen = estimator()
    watch(seen, lambda _: 0.0, y=-HALF - 0.5, steps=6)
    pace = PACE * left / math.hypot(left, SIM.destination_smoothing)
    crowd = walker(-2.4, pace)
    seen.update(crowd, np.array([7]), FRONT, np.empty(0))
    assert crowd.waypoints[0] == pytest.approx((18.0, -2.4 + left + 0.1))
    crowd = walker(-2.4, PACE)  # at full pace: the edge
    seen.update(crowd, np.array([7]), FRONT, np.empty(0))
    assert crowd.waypoints[0] == pytest.approx((18.0, -HALF - 0.05))


def test_a_person_who_waits_at_the_edge_is_expected_to_stay():
    """VCI by itself expects that he is pushed back, which would seem to allow a higher speed."""
    N, y = 40, -HALF - 0.3
    planner = Planner(LongitudinalModel(time_step=DT), PlannerParameters(horizon=N))
    expected = []
    for believed in (estimator(), None):
        ahead = CrowdForesight(
            plan_predictor(SIM, DT, N),
            STRAIGHT,
            EgoAssumptions(VehicleShape(5.0, 1.8), HALF, 0.05, 8.0, None),
            horizon=N,
            time_step=DT,
            estimator=believed,
        )
        poses = np.zeros((N, 1, 7))
        poses[:, :, 4:] = 2.5, 2.5, 1.8
        for _ in range(8):
            ego = (poses, 0, FRONT)
            ahead.look(walker(y, 0.0, x=14.0), OPEN_GROUND, ego, numbers=np.array([0]))
            planner.plan(3.0, 0.0, 3.0, Road(np.full(N, np.inf)), ahead)
        expected.append(ahead.best[:, 0, 1])
    assert y <= expected[0].min()
    assert expected[0].max() <= y + 0.1
    assert np.ptp(expected[1]) > 0.3


def test_who_stands_is_found_out_at_once():
    odds, _ = watch(estimator(), lambda _: 0.0, y=-HALF - 0.5, steps=6)
    assert odds[1] == odds[0] == -3.0  # two looks make a step of the prediction
    assert odds[3] > 0.0


@pytest.mark.parametrize(
    ("x", "y", "to"),
    [
        (18.0, -HALF + 0.2, 20.0),  # is on the way
        (5.0, -HALF - 0.5, 20.0),  # is behind the front
        (18.0, -9.0, 20.0),  # too far aside
        (40.0, -HALF - 0.5, 20.0),  # too far ahead
        (18.0, -HALF - 0.5, -20.0),  # wants away from it
    ],
)
def test_of_others_nothing_is_believed(x, y, to):
    seen, expected = estimator(), np.empty(0)
    for _ in range(20):
        crowd = walker(y, 0.0, x=x, to=to)
        seen.update(crowd, np.array([0]), FRONT, expected)
        expected = expect(crowd)
        assert (crowd.waypoints[0] == (x, to)).all()
    assert seen.odds(0) == -3.0


def test_the_way_may_bend():
    """The same walker beside the part behind a bend, and a way of several points with a light."""
    seen, expected = estimator(BEND), np.empty(0)
    for _ in range(8):
        crowd = Crowd.create(
            [(8.0, 1.7)],
            [(0.0, 0.0)],
            PACE,
            [[(8.0, -1.0), (8.0, -20.0)]],
            passages=[[(0.0, -1.0, 2.0), (0.0, 0.0, 0.0)]],
            signals=[[0, -1]],
        )
        seen.update(crowd, np.array([0]), 15.0, expected)
        expected = np.array([8.0, 1.7, 0.0, -0.6])
    assert seen.odds(0) > 0.0
    assert crowd.waypoints == pytest.approx(np.array([(8.0, 1.7 - 0.1)] * 2))
    assert not crowd.waypoint_passage.any()
    assert (crowd.waypoint_signal == -1).all()


def test_people_come_and_go():
    """Who was out of sight is known again by number, and no speed is compared over the gap."""
    seen = estimator()
    watch(seen, lambda _: 0.0, y=-HALF - 0.5, steps=6)
    before = seen.odds(7)
    for _ in range(3):
        seen.update(Crowd.empty(), np.zeros(0, dtype=np.int64), FRONT, np.empty(0))
    seen.update(walker(-HALF - 0.5, PACE), np.array([7]), FRONT, np.empty(0))
    assert seen.odds(7) == before > 0.0
    assert seen.odds(1000) == -3.0


@pytest.mark.parametrize("slower", [0.05, 0.3, 0.6])
def test_the_odds_move_by_the_likelihoods_of_both_hypotheses(slower):
    def log_normal(x):
        return -0.5 * (x / 0.1) ** 2

    for off in np.linspace(-slower, 0.0, 7):
        ratio = log_normal(off + slower) - log_normal(off)
        assert shifted(0.5, off, slower, False) == pytest.approx(
            math.copysign(min(abs(0.5 + ratio), 4.0), 0.5 + ratio)
        )
        # The same sight, told relative to what is expected of one who yields.
        assert shifted(0.5, off + slower, slower, True) == pytest.approx(
            shifted(0.5, off, slower, False)
        )
    assert shifted(0.5, 0.3, slower, False) == shifted(0.5, 0.0, slower, False)
    assert shifted(0.5, -2.0, slower, False) == shifted(0.5, -slower, slower, False)
