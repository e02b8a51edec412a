"""Where it is open who yields: branches of manoeuvres, and what is chosen among them."""

import numpy as np
import pytest

from controller.kernels import Trials, branch_off
from giveway.ego.foresight.contingency import hedged
from giveway.ego.foresight.crowd_foresight import plan_predictor
from giveway.ego.foresight.intent import IntentEstimator
from giveway.geometry.path import EgoPath
from pedestrian_model import SIM, Crowd

DT, N = 0.05, 50


def steady(*speeds):
    trials = Trials.empty(len(speeds), N, np.zeros(len(speeds)))
    trials.speed[:] = np.array(speeds)[:, None]
    trials.distance[:] = trials.speed * DT * np.arange(N + 1)
    return trials


@pytest.mark.parametrize("braking", [-2.5, -5.0])
def test_a_branch_starts_as_its_manoeuvre_and_keeps_the_limits(braking):
    trials, branch = steady(4.0), steady(4.0)
    branch_off(branch.of(0), 10, braking, 4.0, DT)
    distance, speed, acceleration = branch.of(0)
    assert np.array_equal(speed[:11], trials.speed[0, :11])
    assert np.array_equal(distance[:11], trials.distance[0, :11])
    assert speed[-1] < 4.0 - 0.9 * min(4.0, -braking * (N - 10) * DT - braking**2 / 16.0)
    assert acceleration.min() >= braking - 1e-9
    assert np.diff(acceleration[9:]).min() >= -8.0 * DT - 1e-9
    assert np.diff(distance) == pytest.approx(DT * speed[:-1])


def cost(time, stopped):
    """Under the likelier hypothesis a manoeuvre loses time; else all but who stops hits someone."""

    def of(trials, rows, alternative):
        if alternative:
            return 10.0 if trials.distance[rows, -1].min() > stopped else 2.0
        return min(time[row] for row in rows)

    return of


def test_the_quick_manoeuvre_is_chosen_while_its_branch_can_stop():
    trials = steady(4.0, 1.0)
    assert hedged(cost([0.0, 1.0], 8.0), trials, [0, 1], 0.6, 4.0, DT) == 0
    assert np.array_equal(trials.speed, steady(4.0, 1.0).speed)  # branches are copies


@pytest.mark.parametrize(("likely", "chosen"), [(0.6, 1), (0.98, 0)])
def test_where_it_does_not_the_odds_decide(likely, chosen):
    assert hedged(cost([0.0, 1.0], 3.0), steady(4.0, 1.0), [0, 1], likely, 4.0, DT) == chosen


def test_the_less_likely_intent_is_told_only_where_it_is_open():
    path = EgoPath.through([(0.0, 0.0), (100.0, 0.0)])
    seen = IntentEstimator(path, 1.15, plan_predictor(SIM, DT, 20), DT)
    numbers, told = np.array([0, 1]), []
    expected = np.empty(0)
    for _ in range(12):
        crowd = Crowd.create(
            [(18.0, -2.0), (25.0, -2.0)],
            [(0.0, 0.4), (0.0, 1.39)],
            1.39,
            [[(18.0, 20.0)], [(25.0, 20.0)]],
        )
        other = seen.update_both(crowd, numbers, 10.0, expected)
        expected = np.array([18.0, -1.9, 0.0, 0.7, 25.0, -1.9, 0.0, 1.39])
        if other is not None:
            told.append((seen.odds(0), crowd.waypoints[0, 1], other))
    assert told
    for odds, way, (people, (yields, *_), likely) in told:
        assert (way < 0.0) == (odds > 0.0)
        assert yields.tolist() == [odds <= 0.0, False]
        assert (people.waypoints[0, 1] < 0.0) == (odds <= 0.0)
        assert people.waypoints[1, 1] == 20.0
        assert likely == pytest.approx(1.0 / (1.0 + np.exp(-abs(odds))))
