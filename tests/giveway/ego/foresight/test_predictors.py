"""Predictors: what an ego believes people to do."""

from __future__ import annotations

import numpy as np
import pytest

import giveway
from pedestrian_model import PLAIN_MODELS

MODELS = ("vci", *PLAIN_MODELS)


ON_RECORD = {"record": {"predictions": 0.05}}


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


@pytest.mark.parametrize("model", MODELS)
def test_a_predictor_that_equals_the_crowds_model_is_exact(model):
    assert surprise(drive(model, model, **ON_RECORD)).max() < 1e-6


@pytest.mark.parametrize(("moving", "believed"), [("orca", "vci"), ("vci", "social-force")])
def test_who_believes_in_another_does_not(moving, believed):
    assert surprise(drive(moving, believed, **ON_RECORD)).max() > 1e-3


@pytest.mark.parametrize("controller", ["mpc", "mpc-paper"])
def test_drift_predicts_people_who_walk_by_another_model(controller):
    found = surprise(drive("vci", "drift", controller, **ON_RECORD))
    assert 1e-6 < found.mean() < 0.05
