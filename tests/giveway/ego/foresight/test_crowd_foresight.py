"""What the planner is told of the crowd, against plain geometry and the safety layer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.manoeuvres import (
    DT,
    FRONT,
    HALF_WIDTH,
    LENGTH,
    STRAIGHT,
    WIDTH,
    WORST,
    N,
    manoeuvre,
)

from controller import (
    WorstMotion,
)
from giveway.ego.foresight.crowd_foresight import CrowdForesight, EgoAssumptions, plan_predictor
from giveway.geometry.bodies import VehicleShape
from pedestrian_model import OPEN_GROUND, SIM, Crowd

# --- the crowd under a manoeuvre ------------------------------------------------------------------


def foresight(**changes):
    shape = VehicleShape(LENGTH, WIDTH)
    ego = EgoAssumptions(shape, HALF_WIDTH, 0.05, 8.0, WORST)
    predictor = plan_predictor(SIM, DT, N)
    return CrowdForesight(predictor, STRAIGHT, ego._replace(**changes), horizon=N, time_step=DT)


def look(ahead, *, speed=4.0, off=6.0):
    """Somebody beside the corridor who wants to cross before the ego."""
    crowd = Crowd.create([(FRONT + off, -2.0)], [(0.0, 1.3)], 1.3, [[(FRONT + off, 10.0)]])
    poses = np.zeros((N, 1, 7))
    poses[:, :, 4:] = LENGTH / 2, LENGTH / 2, WIDTH
    ahead.look(crowd, OPEN_GROUND, (poses, 0, FRONT))


def test_calm_speeds_are_those_of_what_the_layer_below_assumes():
    threat_free = []
    for worst in (WorstMotion(5.0, 2.5), WORST, WorstMotion(1.0, 2.5), None):
        ahead = foresight(worst=worst)
        look(ahead, off=3.5)
        threat_free.append(ahead.evaluate(manoeuvre(4.0)).threat_free.min())
    assert threat_free[0] < threat_free[1] < threat_free[2] <= threat_free[3] == np.inf


def test_a_plan_is_predicted_in_steps_of_a_tenth_of_a_second():
    for time_step, horizon, every, count in ((0.05, 60, 2, 30), (0.02, 17, 5, 3), (0.1, 8, 1, 8)):
        made = plan_predictor(SIM, time_step, horizon)
        assert made.time_step == pytest.approx(every * time_step)
        assert made.horizon == count
        assert made.law[1:3] == (pytest.approx(every * time_step), 1)
    assert plan_predictor(SIM, 0.02, 4).horizon == 1


@pytest.mark.parametrize(
    ("changes", "step", "count"),
    [({"destination_gain": 1500.0}, 0.1, 1), ({"destination_smoothing": 0.1}, DT, 2)],
    ids=["quick", "precise"],
)
def test_people_too_precise_for_the_step_are_predicted_in_theirs(changes, step, count):
    """Those who are quick are not: the long step has the gain of speed of two short ones."""
    made = plan_predictor(replace(SIM, **changes), DT, N)
    assert (made.time_step, made.horizon) == (0.1, N // 2)
    assert made.law[1:3] == (step, count)


def test_positions_are_known_at_each_step():
    ahead = foresight()
    look(ahead)
    ahead.evaluate(manoeuvre(4.0))
    ahead.prefer()
    y = np.concatenate([[-2.0], ahead.best[:, 0, 1]])
    assert ahead.best.shape == (N, 1, 2)
    assert y[1::2] == pytest.approx((y[:-1:2] + y[2::2]) / 2.0)
    assert (np.diff(y) != 0.0).all()


def test_people_answer_to_the_manoeuvre():
    ahead = foresight()
    look(ahead)
    crossings = []
    for m in (manoeuvre(4.0), manoeuvre(4.0, -4.0)):
        ahead.evaluate(m)
        ahead.prefer()
        crossings.append(ahead.best[-1, 0, 1])
    assert abs(crossings[1] - crossings[0]) > 0.01


def test_the_best_is_remembered_until_the_next_look():
    ahead = foresight()
    look(ahead)
    assert ahead.best is None
    ahead.evaluate(manoeuvre(4.0))
    ahead.prefer()
    preferred = ahead.best.copy()
    ahead.evaluate(manoeuvre(4.0, -4.0))
    assert np.array_equal(ahead.best, preferred)
    look(ahead)
    assert ahead.best is None
