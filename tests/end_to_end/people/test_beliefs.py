"""The model that moves people and the one that the controller believes in are chosen apart."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest
from support.plug_ins import printed

import giveway
from giveway.errors import ConfigError
from pedestrian_model import PLAIN_MODELS

MODELS = ("vci", *PLAIN_MODELS)
ON_RECORD = {"record": {"predictions": 0.05}}
GROUP = "giveway.pedestrian_models"


def drive(moving, believed, controller="mpc-paper", **settings):
    crowd = {"pedestrians": 20, "model": moving, "two_sided": True}
    run = {"controller": controller, "seed": 3, "crowd": crowd, "time_limit": 8.0}
    return giveway.run(run | {"perception": {"model": believed}} | settings, pictures=False)


def surprise(result):
    """[m] (k,) how far people are from where they were expected to be one control step later."""
    ahead = result.predictions
    ahead = ahead[np.isclose(ahead.look_ahead, 0.05)]
    ahead = ahead.assign(k=np.rint((ahead.time + 0.05) / 0.05).astype(int))
    track = result.trajectories.assign(k=lambda t: np.rint(t.time / 0.05).astype(int))
    met = ahead.merge(track, on=["k", "id"], suffixes=("", "_is"))
    assert len(met) > 200
    return np.hypot(met.x - met.x_is, met.y - met.y_is)


@pytest.mark.parametrize("believed", MODELS)
def test_the_planner_plans_by_any_of_them(believed):
    result = drive("orca", believed, "mpc", time_limit=None)
    assert result.summary["ending"] == "completed"
    assert result.summary["frontal_contacts"] == 0
    assert set(result.ego.controller) == {"mpc", "safety"} or set(result.ego.controller) == {"mpc"}
    other = drive("orca", "vci", "mpc", time_limit=None)
    assert np.array_equal(result.ego.force, other.ego.force) == (believed == "vci")


def test_on_a_road_with_lights_walls_and_people_of_its_own():
    crowd = {"model": "orca", "walls": True}
    run = {"scenario": "junction", "seed": 2, "crowd": crowd, "perception": {"model": "orca"}}
    result = giveway.run(run | {"time_limit": 40.0}, pictures=False)
    assert result.facts["pedestrians"]["taken_over"] > 3
    assert result.summary["failures_to_yield"] == 0
    assert result.summary["overlaps"] == 0


@pytest.fixture
def shy(installed):
    """The package of docs/own_pedestrians.md."""
    points = tomllib.loads(printed("file: shy pyproject.toml"))["project"]["entry-points"]
    ((name, value),) = points[GROUP].items()
    return installed(
        "shy_people", printed("file: shy_people.py"), declares=f"{name} = {value}", group=GROUP
    )


@pytest.mark.parametrize("controller", ["mpc", "mpc-paper"])
def test_a_plugged_in_model_that_moves_people_predicts_them_too(shy, controller):
    options = {"model_options": {"look": 2.0}}
    result = drive("shy", "shy", controller, **ON_RECORD, **options)
    if controller == "mpc-paper":  # the planner's people answer to its plan, not to its past
        assert surprise(result).max() < 1e-6
    assert result.summary["frontal_contacts"] == 0


def test_what_cannot_be_believed_in_is_said_in_one_line(shy, type_here):
    with pytest.raises(
        ConfigError, match=r"\[perception\] model = 'shy': the people walk by 'vci'"
    ):
        drive("vci", "shy")
    typed = type_here("run", "--perception-model", "orka", "-q")
    assert typed.returncode == 2
    assert "--perception-model = 'orka': expected 'vci', 'social-force'" in typed.stderr
    typed = type_here("run", "--crowd-model", "orca", "--perception-model", "shy", "-q")
    assert typed.returncode == 2
    assert "[perception] model = 'shy': the people walk by 'orca'; expected" in typed.stderr
    assert len(typed.stderr.strip().splitlines()) == 1
