"""What the controllers see of the crowd: the truth, or less."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.config import EgoRunConfig
from giveway.ego.perception.protocol import OwnState
from giveway.ego.perception.sensing import Perception
from giveway.ego.perception.truth import Truth
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import Pose
from pedestrian_model import Crowd, CrowdModel, Vehicles


def make_crowd(n: int = 40) -> Crowd:
    random = np.random.default_rng(7)
    place = random.uniform(-10.0, 10.0, (n, 2))
    speeds = random.uniform(0.6, 2.0, n)
    return Crowd.create(place, np.zeros((n, 2)), speeds, list(place[:, None] + (0.0, 30.0)))


def eyes(seed: int = 1, ego: str = "ego", **perception) -> Perception:
    config = EgoRunConfig(seed=seed, perception={"tracker": False} | perception, ego={"id": ego})
    return Perception(config, 3.0, 0.05)


OWN = OwnState(Pose(0.0, 0.0, 0.0), 0.0, 0, VehicleShape(4.5, 1.8))


def observed(seen_by: Perception, crowd: Crowd, ids=None) -> Crowd:
    ids = np.arange(len(crowd)) if ids is None else ids
    percept = seen_by.observe(Truth.of_people(crowd), ids, OWN)
    assert percept.person_ids is ids
    return percept.people


def bound_of(seen_by: Perception, crowd: Crowd) -> np.ndarray:
    """How far the perceived positions are off at most [m]."""
    percept = seen_by.observe(Truth.of_people(crowd), np.arange(len(crowd)), OWN)
    assert percept.position_bound is not None
    return percept.position_bound.copy()


def test_without_errors_the_very_crowd_is_seen():
    crowd = make_crowd()
    assert eyes().exact
    assert observed(eyes(), crowd) is crowd


def test_nobody_is_seen_as_nobody():
    crowd = Crowd.empty()
    assert observed(eyes(position_noise=1.0, desired_speeds="typical"), crowd) is crowd


def test_position_errors_are_at_most_two_deviations_per_axis():
    crowd, seen_by = make_crowd(), eyes(position_noise=0.3)
    offsets = np.array([observed(seen_by, crowd).position - crowd.position for _ in range(500)])
    assert np.abs(offsets).max() <= 0.6 + 1e-12
    assert np.abs(offsets.mean()) < 0.01
    assert offsets.std() == pytest.approx(0.3 * 0.8796, rel=0.02)  # of a normal cut off at 2
    apart = np.corrcoef(offsets[:-1].ravel(), offsets[1:].ravel())[0, 1]
    assert abs(apart) < 0.02  # each step anew


def test_the_truth_is_not_touched_and_the_rest_is_seen_as_it_is():
    crowd, before = make_crowd(), make_crowd()
    seen = observed(eyes(position_noise=0.3), crowd)
    assert (crowd.position == before.position).all()
    assert (seen.position != crowd.position).all()
    assert (seen.velocity == crowd.velocity).all()
    assert (seen.desired_speed == crowd.desired_speed).all()
    assert (seen.waypoints == crowd.waypoints).all()
    assert (seen.waypoint_index == crowd.waypoint_index).all()


def test_a_crowd_that_has_been_stepped_is_seen_where_it_is_now():
    crowd, seen_by = make_crowd(), eyes(position_noise=1e-9, desired_speeds="typical")
    observed(seen_by, crowd)
    for _ in range(5):
        CrowdModel().advance(crowd, Vehicles.empty())
    seen = observed(seen_by, crowd)
    assert np.allclose(seen.position, crowd.position, atol=1e-8)
    assert (seen.velocity == crowd.velocity).all()
    left = crowd.select(np.arange(len(crowd)) % 2 == 0)
    assert np.allclose(observed(seen_by, left).position, left.position, atol=1e-8)
    assert len(observed(seen_by, left).desired_speed) == len(left)


def test_typical_desired_speeds_are_the_mean_for_everybody():
    crowd = make_crowd()
    seen = observed(eyes(desired_speeds="typical"), crowd)
    assert (seen.desired_speed == 1.394).all()
    assert (seen.position == crowd.position).all()


def test_desired_speeds_are_learnt_from_the_pace_that_is_seen():
    crowd, seen_by = make_crowd(), eyes(desired_speeds="typical", tracker=None)
    assert (observed(seen_by, crowd).desired_speed == 1.394).all()  # all stand
    crowd.velocity[:, 1] = crowd.desired_speed
    fast = crowd.desired_speed > 1.394
    errors = []
    for _ in range(20):  # [0.05 s]
        errors.append(np.abs(observed(seen_by, crowd).desired_speed - crowd.desired_speed))
    assert (np.diff(errors, axis=0) <= 1e-12).all()
    assert (errors[-1][fast] < 0.03 * errors[0][fast]).all()
    assert (errors[-1][~fast] > 0.7 * errors[0][~fast]).all()  # might be slowed down by somebody
    for _ in range(400):
        learnt = observed(seen_by, crowd).desired_speed.copy()
    assert learnt == pytest.approx(crowd.desired_speed, abs=0.02)
    crowd.velocity[:] = 0.0  # they let somebody pass
    assert (observed(seen_by, crowd).desired_speed == learnt).all()


def test_what_is_learnt_is_kept_by_person():
    crowd, seen_by = make_crowd(), eyes(desired_speeds="typical", tracker=None)
    crowd.velocity[:, 1] = 2.0
    learnt = observed(seen_by, crowd).desired_speed.copy()
    crowd.velocity[:] = 0.0
    left = crowd.select(np.arange(len(crowd)) % 2 == 0)
    again = observed(seen_by, left, np.arange(0, len(crowd), 2))
    assert (again.desired_speed == learnt[::2]).all()
    newcomers = observed(seen_by, left, np.arange(100, 100 + len(left)))
    assert (newcomers.desired_speed == 1.394).all()


def test_the_papers_controllers_learn_no_pace():
    config = EgoRunConfig(controller="mpc-paper", perception={"desired_speeds": "typical"})
    crowd = make_crowd()
    crowd.velocity[:, 1] = 2.0
    seen = observed(Perception(config, 3.0, 0.05), crowd)
    assert (seen.desired_speed == 1.394).all()


def test_the_same_seed_sees_the_same_and_every_ego_for_itself():
    crowd = make_crowd()

    def look(**who):
        return observed(eyes(**who, position_noise=0.3), crowd).position.copy()

    assert (look(seed=3) == look(seed=3)).all()
    assert (look(seed=3) != look(seed=4)).all()
    assert (look(ego="a") != look(ego="b")).all()


PEOPLE = {"pedestrians": 6, "spawn_area": (12.0, -6.0, 20.0, -2.0)}


def test_noise_changes_the_drive_but_the_tables_keep_the_truth(run_once):
    plain = run_once(seed=2, time_limit=4.0, crowd=PEOPLE)
    noisy = run_once(seed=2, time_limit=4.0, crowd=PEOPLE, perception={"position_noise": 0.4})
    drive = noisy.egos[0]
    assert not np.array_equal(drive.track.force, plain.egos[0].track.force)
    crowd = drive.crowd
    for k in range(len(drive.track.time)):
        now = crowd.step == k
        ahead = crowd.x[now] - drive.track.front_x[k]
        front = ahead[(np.abs(crowd.y[now] - drive.track.front_y[k]) <= 1.25) & (ahead >= 0.0)]
        assert drive.track.gap[k] == pytest.approx(front.min(initial=np.inf), abs=1e-9)


def test_a_run_with_unseen_desired_speeds_predicts_otherwise(run_once):
    plain = run_once(seed=2, time_limit=4.0, crowd=PEOPLE)
    typical = run_once(
        seed=2, time_limit=4.0, crowd=PEOPLE, perception={"desired_speeds": "typical"}
    )
    assert not np.array_equal(typical.egos[0].track.force, plain.egos[0].track.force)


def walking_crowd() -> Crowd:
    place = np.array([[0.0, 0.0], [3.0, 1.0], [5.0, 5.0]])
    velocity = np.array([[1.0, 0.0], [0.0, -2.0], [0.01, 0.0]])
    routes = [np.array([[0.0, 9.0], [9.0, 9.0]]), np.array([[3.0, 9.0]]), np.array([[9.0, 5.0]])]
    return Crowd.create(place, velocity, 1.4, routes)


def test_unknown_goals_lie_ahead_and_standing_people_stay():
    crowd = walking_crowd()
    seen = observed(eyes(goals="heading"), crowd)
    way = seen.waypoints - crowd.position
    assert np.allclose(way[0], (1000.0, 0.0))
    assert np.allclose(way[1], (0.0, -1000.0))
    assert (way[2] == 0.0).all()
    assert (seen.velocity == crowd.velocity).all()
    assert (seen.position == crowd.position).all()
    assert len(crowd.waypoints) == 4  # the crowd itself knows


def test_unknown_goals_turn_with_the_heading():
    crowd, seen_by = walking_crowd(), eyes(goals="heading")
    observed(seen_by, crowd)
    crowd.velocity[0] = (0.0, 1.0)
    assert np.allclose((observed(seen_by, crowd).waypoints - crowd.position)[0], (0.0, 1000.0))


def test_a_person_who_comes_back_is_new_to_the_tracker():
    crowd, seen_by = make_crowd(), eyes(position_noise=0.1, tracker=True)
    for _ in range(20):
        bound = bound_of(seen_by, crowd)
    assert (bound < 0.28).all()
    assert not len(bound_of(seen_by, Crowd.empty()))
    elsewhere = make_crowd()
    elsewhere.position[:] += 0.1
    assert bound_of(seen_by, elsewhere) == pytest.approx(np.full(40, 0.2 * np.sqrt(2.0)))
