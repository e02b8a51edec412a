"""Random accelerations of the actual pedestrians: real, but within what people can do."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.config import RunConfig
from giveway.crowd.motion.disturbance import Disturbance, disturbance_of, pushed
from pedestrian_model import OPEN_GROUND, SIM, Crowd, CrowdModel, Vehicles

DT = 0.05
WALKING = (0.0, 1.4)  # [m/s] as they wish to: the model itself leaves them room to accelerate


def make_crowd(velocity: np.ndarray) -> Crowd:
    n = len(velocity)
    place = np.column_stack((30.0 * np.arange(n), np.zeros(n)))
    return Crowd.create(place, velocity, 1.4, list(place[:, None] + (0.0, 30.0)))


def test_without_noise_there_is_no_disturbance():
    assert disturbance_of(RunConfig(), CrowdModel()) is None
    assert disturbance_of(RunConfig(crowd={"acceleration_noise": 0.1}), CrowdModel()) is not None


@given(st.integers(0, 10**6), st.floats(0.01, 5.0))
def test_no_step_exceeds_the_model_s_limits(seed, deviation):
    """|v' - v| <= a_max dt and |v'| <= v_max, and the way is that of constant acceleration."""
    random = np.random.default_rng(seed)
    angle, speed = random.uniform(0.0, 2.0 * np.pi, 12), random.uniform(0.0, SIM.max_speed, 12)
    before = np.column_stack((speed * np.cos(angle), speed * np.sin(angle)))
    crowd = make_crowd(before)
    place = crowd.position.copy()
    disturbance = Disturbance(CrowdModel(SIM, DT), deviation, seed)
    disturbance.advance(crowd, Vehicles.empty(), OPEN_GROUND, np.arange(12), 12)
    change = np.hypot(*(crowd.velocity - before).T)
    assert (change <= SIM.max_acceleration * DT + 1e-12).all()
    assert (np.hypot(*crowd.velocity.T) <= SIM.max_speed + 1e-12).all()
    assert np.allclose(crowd.position, place + 0.5 * DT * (before + crowd.velocity), atol=1e-12)


def test_a_push_within_the_limits_is_added_as_it_is():
    crowd = make_crowd(np.array([[0.0, 1.0]]))
    place, before = crowd.position.copy(), crowd.velocity.copy()
    pushed(CrowdModel(SIM, DT), crowd, before, np.array([[0.1, -0.05]]))
    assert crowd.velocity == pytest.approx(np.array([[0.1, 0.95]]))
    assert crowd.position - place == pytest.approx(0.5 * DT * np.array([[0.1, -0.05]]))


def test_a_push_beyond_the_limit_keeps_its_direction():
    crowd = make_crowd(np.array([[0.0, 1.0]]))
    pushed(CrowdModel(SIM, DT), crowd, crowd.velocity.copy(), np.array([[3.0, 4.0]]))
    assert crowd.velocity == pytest.approx(np.array([[0.15, 1.2]]))  # 0.25 m/s of (0.6, 0.8)


def test_it_is_drawn_for_all_so_that_leaving_changes_no_others():
    pushes = []
    for present in ([0, 1, 2, 3], [1, 3]):
        crowd = make_crowd(np.tile(WALKING, (len(present), 1)))
        model, after = CrowdModel(SIM, DT), crowd.copy()
        model.advance(after, Vehicles.empty())
        Disturbance(model, 0.5, 9).advance(
            crowd, Vehicles.empty(), OPEN_GROUND, np.array(present), 4
        )
        pushes.append(dict(zip(present, crowd.velocity - after.velocity, strict=True)))
    for person in (1, 3):
        assert pushes[0][person] == pytest.approx(pushes[1][person])
        assert np.abs(pushes[0][person]).max() > 0.0


def test_its_size_is_that_of_a_normal_cut_at_two_deviations():
    crowd = make_crowd(np.tile(WALKING, (400, 1)))
    model, after = CrowdModel(SIM, DT), crowd.copy()
    model.advance(after, Vehicles.empty())
    Disturbance(model, 0.5, 1).advance(crowd, Vehicles.empty(), OPEN_GROUND, np.arange(400), 400)
    added = (crowd.velocity - after.velocity) / DT
    assert np.abs(added).max() <= 1.0 + 1e-9
    assert added.std() == pytest.approx(0.5 * 0.8796, rel=0.05)


def test_runs_with_it_repeat_and_differ_from_those_without(run_once):
    people = {"pedestrians": 5, "spawn_area": (12.0, -6.0, 20.0, -2.0)}
    shaken = people | {"acceleration_noise": 0.5}
    plain = run_once(seed=4, time_limit=2.0, crowd=people).crowd_track
    first = run_once(seed=4, time_limit=2.0, crowd=shaken).crowd_track
    again = run_once(seed=4, time_limit=2.0, crowd=shaken, controller="mpc").crowd_track
    assert not np.array_equal(plain.x, first.x)
    assert np.array_equal(first.x, again.x)
    assert np.array_equal(first.vy, again.vy)
    steps = np.diff(first.vx.reshape(-1, 5), axis=0), np.diff(first.vy.reshape(-1, 5), axis=0)
    assert np.hypot(*steps).max() <= SIM.max_acceleration * DT + 1e-9
