"""Of a large crowd only who matters to the ego is predicted: its plan does not notice."""

from __future__ import annotations

from contextlib import ExitStack

import numpy as np
import pytest

from controller import Manoeuvre
from giveway.config import EgoRunConfig
from giveway.ego.controllers import make_controller
from giveway.ego.ego import Course, Ego
from giveway.ego.foresight.relevance import MARGIN
from giveway.ego.perception.truth import Truth
from giveway.ego.preparation import make_waiting_ego
from giveway.ego.rules.rule_set import RuleSet
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from pedestrian_model import OPEN_GROUND, Crowd

BEND = [(-50.0, 0.0), (0.0, 0.0), (30.0, 0.0), (60.0, 20.0), (100.0, 60.0)]
CONFIG = EgoRunConfig(controller="mpc-paper")
PLANNING = EgoRunConfig(controller="mpc")


def crowd(rng: np.random.Generator, widest: float = 60.0) -> Crowd:
    """200 to 1,500 people in a square of 50 to 120 m about the ego, walking anywhere."""
    count, size = int(rng.integers(200, 1500)), rng.uniform(25, widest)
    position, destination = rng.uniform(-size, size, (2, count, 2))
    speed = rng.uniform(0.5, 2.0, count)
    way = destination - position
    velocity = speed[:, None] * way / np.hypot(*way.T)[:, None]
    return Crowd.create(position, velocity, speed, list(destination[:, None]))


def test_who_is_left_out_changes_nothing_that_a_plan_can_notice(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rng = np.random.default_rng(1)
    shape, left_out, in_reach = VehicleShape(), 0, 0
    for _ in range(25):
        speed = rng.uniform(0.0, 10.0)
        people = crowd(rng)
        truth, ids = Truth.of_people(people), np.arange(len(people))
        seen = []
        for predict_all in (150, 10**9):
            monkeypatch.setattr("giveway.ego.foresight.relevance.PREDICT_ALL", predict_all)
            with ExitStack() as stack:
                waiting = make_waiting_ego(CONFIG, make_controller(CONFIG, 0.05), 0.05, stack)
                waiting.start(speed)
                course = Course(EgoPath.through(BEND), 50.0, 100.0)
                ego = Ego(waiting, course, shape, RuleSet(), 0.05)
                poses = np.zeros((waiting.horizon, 1, 7))
                poses[:, :, 4:] = shape.length / 2, shape.length / 2, shape.width
                ego.corridor.fill_poses(poses, 0, ego.front, speed)
                perceived = ego.look(0, poses, truth, OPEN_GROUND, ids)
                seen.append(perceived.ahead.copy())
                left_out += perceived.relevant is not None and not perceived.relevant.all()
        reach = ego.front + (speed + 8.0 * 0.75 / 2) * 0.75 + CONFIG.regulation.safe_distance
        matters = (seen[0] <= reach) | (seen[1] <= reach)
        in_reach += int(matters.any())
        assert seen[0][matters] == pytest.approx(seen[1][matters], abs=1e-6)
    assert left_out > 15
    assert in_reach > 15


def test_people_left_out_hardly_change_a_manoeuvres_outcome(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rng = np.random.default_rng(2)
    shape, left_out, met, alike, compared = VehicleShape(), 0, 0, 0, 0
    for _ in range(12):
        speed = rng.uniform(1.0, 10.0)
        people = crowd(rng, widest=150.0)
        truth, ids = Truth.of_people(people), np.arange(len(people))
        seen = []
        for margin in (MARGIN, 1e9):
            monkeypatch.setattr("giveway.ego.foresight.relevance.MARGIN", margin)
            with ExitStack() as stack:
                waiting = make_waiting_ego(PLANNING, make_controller(PLANNING, 0.05), 0.05, stack)
                waiting.start(speed)
                course = Course(EgoPath.through(BEND), 50.0, 100.0)
                ego = Ego(waiting, course, shape, RuleSet(), 0.05)
                N = waiting.horizon
                poses = np.zeros((N, 1, 7))
                poses[:, :, 4:] = shape.length / 2, shape.length / 2, shape.width
                ego.corridor.fill_poses(poses, 0, ego.front, speed)
                look = ego.look(0, poses, truth, OPEN_GROUND, ids)
                assert look.foresight is not None
                left_out += look.relevant is not None and not look.relevant.all()
                way = speed * 0.05 * np.arange(N + 1)
                steady = Manoeuvre(way, np.full(N + 1, speed), np.zeros(N + 1))
                seen.append([column.copy() for column in look.foresight.evaluate(steady)])
        met += int(np.isfinite(seen[0][0]).any() and seen[0][1].any())
        gap, all_gap = seen[0][0], seen[1][0]
        near = np.minimum(gap, all_gap) < CONFIG.regulation.safe_distance
        same = np.isclose(gap[near], all_gap[near], atol=0.1)
        alike += int(same.sum())
        compared += len(same)
        soon = near[: round(1.0 / 0.05)]  # nobody who is left out can be there yet
        assert gap[: len(soon)][soon] == pytest.approx(all_gap[: len(soon)][soon], abs=0.1)
    assert left_out > 6
    assert met > 6
    assert compared > 100
    assert alike > 0.8 * compared
