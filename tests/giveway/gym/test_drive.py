"""The Gymnasium environment: its rules, its seeds, and that it is every run's co-simulation."""

from __future__ import annotations

import re
import threading
from pathlib import Path

import numpy as np
import pytest

import giveway
from giveway.errors import ConfigError

gymnasium = pytest.importorskip("gymnasium")
from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AsyncVectorEnv  # noqa: E402

from giveway.gym import DriveEnv  # noqa: E402

CROWD = {"crowd": {"pedestrians": 12}}


@pytest.fixture
def env():
    made = DriveEnv(CROWD)
    yield made
    made.close()


def make():
    return DriveEnv({"crowd": {"pedestrians": 5}})


def drive(env, seed, action, most=2000):
    """Observations, rewards and what was told last."""
    seen, _ = env.reset(seed=seed)
    observed, rewards = [seen], []
    for _ in range(most):
        seen, reward, terminated, truncated, told = env.step(action(seen))
        observed.append(seen)
        rewards.append(reward)
        if terminated or truncated:
            return observed, rewards, terminated, told
    return observed, rewards, False, told


def keep_pace(seen):
    return np.array([np.clip((4.0 - seen["ego"][0]) / 5.0, -1.0, 1.0)], dtype=np.float32)


@pytest.mark.filterwarnings("error")
def test_gymnasiums_own_checks_have_nothing_to_say(env):
    check_env(env, skip_render_check=True)


def test_constructing_starts_nothing():
    before = threading.active_count()
    envs = [make() for _ in range(3)]
    assert threading.active_count() == before
    with pytest.raises(gymnasium.error.ResetNeeded):
        envs[0].step(np.zeros(1, dtype=np.float32))


def test_equal_seed_and_actions_give_the_runs_own_drive(env):
    first, rewards, _, told = drive(env, 3, keep_pace)
    again, same, _, _ = drive(env, 3, keep_pace)
    assert rewards == same
    assert all(np.array_equal(a[k], b[k]) for a, b in zip(first, again, strict=True) for k in a)
    other, *_ = drive(env, 4, keep_pace)
    assert not np.array_equal(other[0]["people"], first[0]["people"])
    assert told["summary"]["ego"] == "ego"
    assert env.result.config.seed == 4
    run = giveway.run(CROWD | {"seed": 3, "controller": "pid-paper"})
    at = run.crowd_track.step == 0
    x, y = run.crowd_track.x[at], run.crowd_track.y[at]
    ego = run.egos[0].track
    nearest = np.sort(np.hypot(x - ego.front_x[0], y - ego.front_y[0]))[:8]
    seen = first[0]["people"]
    assert np.hypot(seen[:, 0], seen[:, 1]) == pytest.approx(nearest, rel=1e-5)


def test_who_does_not_brake_hits_somebody_and_pays_for_it():
    env = DriveEnv({"crowd": {"pedestrians": 40, "model": "constant-velocity"}})
    _, rewards, terminated, told = drive(env, 1, keep_pace)
    assert terminated
    assert told["hit"]
    assert told["summary"]["frontal_contacts"] == 1
    assert rewards[-1] < -99.0
    assert told["summary"]["ending"] == "interrupted"
    env.close()


def test_a_false_detection_is_seen_and_not_hit():
    sees = {"perception": {"sensor": "sight"}, "sensor_options": {"false_rate": 10.0}}
    env = DriveEnv({"crowd": {"pedestrians": 0}} | sees)
    observed, _, terminated, told = drive(env, 1, keep_pace)
    assert terminated
    assert not told["hit"]
    closest = min(np.hypot(*step["people"][0, :2]) for step in observed if step["people"][0, 4])
    assert closest < 0.5
    env.close()


def test_a_picture_shows_ego_and_people():
    env = DriveEnv({"scenario": "encounter"}, render_mode="rgb_array")
    assert env.render() is None
    env.reset(seed=4)
    picture = env.render()
    people = env.step(np.zeros(1))[0]["people"][:, 4].sum()
    env.close()
    assert (picture.shape, picture.dtype) == ((320, 640, 3), np.uint8)
    red, _, blue = picture.astype(int).transpose(2, 0, 1)
    assert people > 0
    assert (blue - red > 80).sum() > 1000
    assert (red - blue > 80).sum() > 50


def test_a_free_drive_reaches_the_goal_and_loses_nothing():
    env = DriveEnv({"crowd": {"pedestrians": 0}})
    observed, rewards, terminated, told = drive(env, 1, keep_pace)
    assert terminated
    assert not told["hit"]
    assert told["summary"]["ending"] == "completed"
    assert sum(rewards) == pytest.approx(0.0, abs=0.3)
    assert observed[-1]["ego"][0] == pytest.approx(4.0, abs=0.2)
    env.close()


def test_standing_ends_at_the_time_limit_and_costs_its_seconds():
    env = DriveEnv({"crowd": {"pedestrians": 0}, "time_limit": 5.0}, action="force")
    stop = np.array([-1.0], dtype=np.float32)
    _, rewards, terminated, told = drive(env, 1, lambda _: stop)
    assert not terminated
    assert told["summary"]["ending"] == "time limit"
    assert len(rewards) == 100 + 1  # the last one tells that it is over
    assert rewards[-1] == 0.0
    assert -5.0 - 2.0 < sum(rewards) < -4.0  # the seconds, and the discomfort of braking
    env.close()


def test_an_action_is_a_share_of_largest_force_or_acceleration():
    driven = {}
    for action in ("force", "acceleration"):
        env = DriveEnv({"crowd": {"pedestrians": 0}, "vehicle": {"mass": 2000.0}}, action=action)
        env.reset(seed=1)
        for _ in range(3):
            env.step(np.array([-0.2], dtype=np.float32))
        env.close()
        driven[action] = env.result.egos[0].track.force[1]
    limit = giveway.RunConfig().vehicle.force_limit
    assert driven["force"] == pytest.approx(-0.2 * limit)
    speed = 4.0 - 0.2 * limit / 2000.0 * 0.05
    assert driven["acceleration"] == pytest.approx(-0.2 * limit + 100.0 * speed, rel=1e-2)


@pytest.mark.parametrize("context", ["fork", "spawn"])
def test_several_at_once_in_processes_of_their_own(context):
    envs = AsyncVectorEnv([make, make], context=context)
    try:
        seen, _ = envs.reset(seed=[1, 2])
        assert not np.array_equal(seen["people"][0], seen["people"][1])
        for _ in range(10):
            seen, reward, *_ = envs.step(np.zeros((2, 1), dtype=np.float32))
        assert seen["ego"].shape == (2, 4)
        assert np.isfinite(reward).all()
    finally:
        envs.close()


def test_the_printed_example_runs(capsys):
    page = (Path(__file__).parents[3] / "docs" / "gym.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"<!-- example -->\n```python\n(.*?)```", page, re.DOTALL)
    exec(compile(text, "gym.md", "exec"), {})
    time, conflicts, total = map(float, capsys.readouterr().out.split())
    assert 17.5 < time < 60.0
    assert conflicts >= 0.0
    assert -time < total < 0.0


def test_gymnasium_makes_it_by_its_name():
    made = gymnasium.make("giveway/Drive-v0", config=CROWD)
    seen, _ = made.reset(seed=1)
    assert made.observation_space.contains(seen)
    made.close()


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"config": {"crowd.pedestrian": 3}}, "pedestrian"),
        ({"config": {"ego": {"none": True}}}, "0 egos; expected exactly one"),
        ({"action": "speed"}, "expected 'force' or 'acceleration'"),
        ({"people": 0}, "expected at least 1"),
    ],
)
def test_what_cannot_be_is_said_by_the_constructor(settings, said):
    with pytest.raises(ConfigError, match=said):
        DriveEnv(**settings)


def test_the_seat_is_for_the_environment_only():
    with pytest.raises(giveway.GivewayError, match=r"for giveway\.gym\.DriveEnv only"):
        giveway.run({"controller": "giveway.gym:Seat", "time_limit": 1.0})
