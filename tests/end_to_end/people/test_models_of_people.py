"""Runs whose people walk by another model than VCI, with everything that a run has."""

import numpy as np
import pytest

import giveway
from pedestrian_model import PLAIN_MODELS


def drive(model, **settings):
    crowd = {"pedestrians": 20, "model": model}
    run = {"scenario": "shared_space", "seed": 3, "crowd": crowd}
    return giveway.run(run | settings, pictures=False)


@pytest.mark.parametrize("model", PLAIN_MODELS)
def test_a_run_with_its_twin_before_other_people(model):
    result, vci = drive(model, twin=True), drive("vci")
    assert result.summary["ending"] == "completed"
    assert result.summary["frontal_contacts"] == 0
    assert np.isfinite(result.summary["mean_people_delay"])
    assert not np.array_equal(result.pedestrians.path_length, vci.pedestrians.path_length)
    assert result.config.crowd.model == model


def test_at_constant_velocity_a_vehicle_costs_nobody_anything():
    delays = drive("constant-velocity", twin=True).pedestrians.delay
    assert delays.abs().max() < 1e-9


@pytest.mark.parametrize("model", ["social-force", "gap-acceptance"])
def test_on_a_road_with_signals_and_walls(model):
    run = {"scenario": "junction", "seed": 2, "time_limit": 60.0}
    result = giveway.run(run | {"crowd": {"model": model, "walls": True}}, pictures=False)
    assert result.summary["failures_to_yield"] == 0
    assert result.summary["overlaps"] == 0


def test_who_lets_the_ego_pass_is_found_out():
    """Before people who stop for it the ego need not wait; nobody of VCI's is taken for one."""
    run = {"crowd": {"pedestrians": 30}, "seed": 208}
    yielding = run | {"crowd": {"pedestrians": 30, "model": "gap-acceptance"}}
    told = giveway.run(yielding, pictures=False).summary
    assert told["completion_time"] < 30.0
    assert told["frontal_contacts"] == 0
