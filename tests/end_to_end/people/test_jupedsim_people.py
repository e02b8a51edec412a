"""Runs whose people walk by JuPedSim's models."""

from __future__ import annotations

import sys
from importlib.util import find_spec

import numpy as np
import pytest

import giveway
from giveway.config.files.layers import read_toml
from giveway.config.files.loading import load
from giveway.errors import CrowdError
from pedestrian_model import JUPEDSIM_MODELS

NEEDED = pytest.mark.skipif(find_spec("jupedsim") is None, reason="needs JuPedSim")


def drive(model, results=None, **settings):
    crowd = {"pedestrians": 12, "model": model}
    run = {"scenario": "shared_space", "seed": 3, "crowd": crowd}
    return giveway.run(run | settings, results=results, pictures=False)


@NEEDED
@pytest.mark.parametrize("model", JUPEDSIM_MODELS)
def test_a_run_with_its_twin_and_again_from_its_folder(model, tmp_path):
    result = drive(model, twin=True, results=tmp_path / "run")
    assert result.summary["ending"] == "completed"
    assert result.summary["frontal_contacts"] == 0
    assert np.isfinite(result.summary["mean_people_delay"])
    config, _ = load([read_toml(tmp_path / "run" / "config.toml")])  # ours: nobody's leave needed
    assert config.crowd.model == model
    again = giveway.run(tmp_path / "run" / "config.toml", pictures=False)
    assert np.array_equal(again.crowd_track.x, result.crowd_track.x)
    other = drive("social-force").crowd_track
    assert not np.array_equal(other.x, result.crowd_track.x)


@NEEDED
@pytest.mark.parametrize("model", JUPEDSIM_MODELS)
def test_on_a_road_with_signals_walls_and_cars(model):
    run = {"scenario": "junction", "seed": 2, "time_limit": 40.0}
    result = giveway.run(run | {"crowd": {"model": model, "walls": True}}, pictures=False)
    assert result.facts["pedestrians"]["taken_over"] > 3
    assert result.summary["overlaps"] == 0


@NEEDED
def test_it_is_believed_in_too():
    model = JUPEDSIM_MODELS[0]
    crowd = {"pedestrians": 12, "model": model, "two_sided": True}
    settings = {"controller": "mpc-paper", "seed": 3, "crowd": crowd, "time_limit": 8.0}
    settings |= {"perception": {"model": model}, "record": {"predictions": 0.05}}
    ahead = giveway.run(settings, pictures=False).predictions
    assert np.isfinite(ahead[["x", "y"]]).all(axis=None)
    assert len(ahead) > 100


def test_who_has_no_jupedsim_is_told_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "jupedsim", None)
    with pytest.raises(CrowdError, match=r"JuPedSim is not installed; .*'giveway\[jupedsim\]'"):
        drive(JUPEDSIM_MODELS[0])


def test_a_model_of_jupedsims_that_is_not_offered_is_named(type_here):
    typed = type_here("run", "--crowd-model", "jupedsim:WarpDriverModel", "-q")
    assert typed.returncode == 2
    assert "expected 'vci', " in typed.stderr
    assert "'jupedsim:SocialForceModel'" in typed.stderr


@NEEDED
def test_giveway_check_says_that_it_is_sound(type_here):
    typed = type_here("check", "model", "jupedsim:CollisionFreeSpeedModel")
    assert "kept    does not depend on the order of people" in typed.stdout
