"""The predictor drift in a run: memory, positions and covariance."""

from __future__ import annotations

import numpy as np
import pytest

from pedestrian_model import SIM, Crowd, unmoved
from pedestrian_model.drift.predictor import DriftPredictor

DT = 0.05
NOBODY = np.empty((20, 0, 7))


def crowd_of(position, velocity):
    n = len(position)
    return Crowd.create(position, velocity, 1.3, [np.array([[50.0, 0.0]])] * n)


def seen(predictor, people, steps=61, ids=None):
    """Let people walk straight on for some steps, and return them as they are at the end."""
    ids = np.arange(len(people)) if ids is None else ids
    for ago in range(steps - 1, -1, -1):
        now = crowd_of(people.position - ago * DT * people.velocity, people.velocity)
        predictor.remember(now, ids)
    return now


@pytest.fixture
def predictor():
    return DriftPredictor(unmoved(SIM), 0.1, 20, interval=DT)


def test_a_slow_walker_is_expected_to_walk_faster_than_now(predictor):
    """Recorded people who walk slowly alone get faster more often than slower."""
    people = seen(predictor, crowd_of([[0.0, 0.0]], [[0.5, 0.0]]))
    there = predictor.predict(people, NOBODY)
    assert there.shape == (20, 1, 2)
    assert 1.0 < there[-1, 0, 0] < 2.0
    assert abs(there[-1, 0, 1]) < 1e-9


def test_a_standing_person_stays(predictor):
    people = seen(predictor, crowd_of([[2.0, 1.0]], [[0.0, 0.0]]))
    assert predictor.predict(people, NOBODY) == pytest.approx(np.tile([[2.0, 1.0]], (20, 1, 1)))


def test_a_turned_scene_is_predicted_turned(predictor):
    position, velocity = np.array([[0.0, 0.0], [1.5, 0.4]]), np.array([[1.2, 0.1], [0.7, 0.2]])
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    there = predictor.predict(seen(predictor, crowd_of(position, velocity)), NOBODY).copy()
    other = DriftPredictor(unmoved(SIM), 0.1, 20, interval=DT)
    turned = other.predict(seen(other, crowd_of(position @ turn, velocity @ turn)), NOBODY)
    assert turned == pytest.approx(there @ turn)


def test_only_those_who_are_chosen_are_predicted(predictor):
    people = crowd_of([[0.0, 0.0], [5.0, 5.0]], [[1.2, 0.0], [0.0, 1.0]])
    people = seen(predictor, people, ids=np.array([7, 3]))
    both = predictor.predict(people, NOBODY).copy()
    predictor.choose(np.array([3]))
    one = people.select(np.array([False, True]))
    assert predictor.predict(one, NOBODY)[:, 0] == pytest.approx(both[:, 1])


def test_who_was_out_of_sight_has_no_past(predictor):
    walker = crowd_of([[0.0, 0.0]], [[1.0, 0.0]])
    known = predictor.predict(seen(predictor, walker), NOBODY).copy()
    predictor.remember(crowd_of(np.empty((0, 2)), np.empty((0, 2))), np.empty(0, dtype=np.int64))
    fresh = DriftPredictor(unmoved(SIM), 0.1, 20, interval=DT)
    for each in (predictor, fresh):
        each.remember(walker, np.array([0]))
    assert predictor.predict(walker, NOBODY) == pytest.approx(fresh.predict(walker, NOBODY))
    assert known.shape == (20, 1, 2)


def test_the_covariance_is_a_growing_one_along_the_heading(predictor):
    people = seen(predictor, crowd_of([[0.0, 0.0], [9.0, 9.0]], [[0.0, 1.3], [0.0, 0.0]]))
    covariance = predictor.covariance(people)
    assert covariance.shape == (20, 2, 2, 2)
    assert (np.linalg.eigvalsh(covariance) > 0.0).all()
    assert (np.diff(covariance[:, 0, 1, 1]) > 0.0).all()
    assert covariance[-1, 0, 1, 1] > covariance[-1, 0, 0, 0], "people are surer of their way"
