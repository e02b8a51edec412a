"""The sway of people: it lasts, no controller changes it, and it is within what people can do."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.config import RunConfig
from giveway.crowd.motion.sway import Sway, pushed, sway_of
from pedestrian_model import (
    OPEN_GROUND,
    SIM,
    Crowd,
    CrowdModel,
    ParameterError,
    Vehicles,
)

DT = 0.05
WALKING = (0.0, 1.4)  # [m/s] as they wish to: the model itself leaves them room to accelerate


def make_crowd(velocity: np.ndarray) -> Crowd:
    n = len(velocity)
    place = np.column_stack((30.0 * np.arange(n), np.zeros(n)))
    return Crowd.create(place, velocity, 1.4, list(place[:, None] + (0.0, 30.0)))


def swaying(deviation: float, time: float = 0.5) -> CrowdModel:
    return CrowdModel(replace(SIM, sway=deviation, sway_time=time), DT)


def pushes(model: CrowdModel, sway: Sway, present: list[int], known: int) -> np.ndarray:
    """The accelerations that the sway adds to people who walk as they wish to."""
    crowd = make_crowd(np.tile(WALKING, (len(present), 1)))
    after = crowd.copy()
    model.advance(after, Vehicles.empty())
    sway.advance(crowd, Vehicles.empty(), OPEN_GROUND, np.array(present), known)
    return (crowd.velocity - after.velocity) / DT


def test_only_people_of_vci_sway_and_by_default_nobody_does():
    assert sway_of(RunConfig(), CrowdModel(), 0) is None
    assert sway_of(RunConfig(), swaying(0.1), 0) is not None
    assert sway_of(RunConfig(crowd={"model": "orca"}), swaying(0.1), 0) is None
    with pytest.raises(ParameterError, match=r"sway_time = 0.0, expected a number > 0"):
        replace(SIM, sway_time=0.0)


@given(st.integers(0, 10**6), st.floats(0.01, 5.0))
def test_no_step_exceeds_the_model_s_limits(seed, deviation):
    """|v' - v| <= a_max dt and |v'| <= v_max, and the way is that of constant acceleration."""
    random = np.random.default_rng(seed)
    angle, speed = random.uniform(0.0, 2.0 * np.pi, 12), random.uniform(0.0, SIM.max_speed, 12)
    before = np.column_stack((speed * np.cos(angle), speed * np.sin(angle)))
    crowd = make_crowd(before)
    place = crowd.position.copy()
    sway = Sway(swaying(deviation), seed)
    sway.advance(crowd, Vehicles.empty(), OPEN_GROUND, np.arange(12), 12)
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
    model = swaying(0.5)
    everybody, some = Sway(model, 9), Sway(model, 9)
    for _ in range(3):
        all_four, two = pushes(model, everybody, [0, 1, 2, 3], 4), pushes(model, some, [1, 3], 4)
        assert two == pytest.approx(all_four[[1, 3]])
        assert np.abs(two).max() > 0.0


def test_it_has_the_deviation_and_the_correlation_time_of_the_preset():
    model = swaying(0.5, 0.4)
    sway, people = Sway(model, 1), list(range(2000))
    found = np.array([pushes(model, sway, people, 2000) for _ in range(9)])
    assert found.std(axis=(1, 2)) == pytest.approx(0.5, rel=0.05)
    lasting = (found[0] * found[8]).mean() / found.var()  # 0.4 s later
    assert lasting == pytest.approx(np.exp(-1.0), abs=0.03)


def test_a_person_who_comes_later_sways_from_the_first_step():
    model = swaying(0.5)
    sway = Sway(model, 3)
    pushes(model, sway, [0], 1)
    assert pushes(model, sway, list(range(1000)), 1000)[1:].std() == pytest.approx(0.5, rel=0.1)


def test_runs_with_it_repeat_and_differ_from_those_without(run_once, tmp_path: Path):
    preset = tmp_path / "swaying.toml"
    preset.write_text("base = 'SIM'\n[parameters]\nsway = 0.5\n")
    people = {"pedestrians": 5, "spawn_area": (12.0, -6.0, 20.0, -2.0)}
    shaken = people | {"preset": str(preset)}
    plain = run_once(seed=4, time_limit=2.0, crowd=people).crowd_track
    first = run_once(seed=4, time_limit=2.0, crowd=shaken).crowd_track
    again = run_once(seed=4, time_limit=2.0, crowd=shaken, controller="mpc").crowd_track
    assert not np.array_equal(plain.x, first.x)
    assert np.array_equal(first.x, again.x)
    assert np.array_equal(first.vy, again.vy)
    steps = np.diff(first.vx.reshape(-1, 5), axis=0), np.diff(first.vy.reshape(-1, 5), axis=0)
    assert np.hypot(*steps).max() <= SIM.max_acceleration * DT + 1e-9
