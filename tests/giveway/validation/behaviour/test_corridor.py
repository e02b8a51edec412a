"""People in periodic corridors: Weidmann's speeds, slowing with density, and lanes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from giveway.validation.behaviour.corridor import DENSITIES, walk, weidmann
from pedestrian_model import SIM, CrowdModel, PlainModel


def test_weidmann_s_speeds_are_those_of_his_table() -> None:
    assert weidmann() == pytest.approx([1.298, 1.058, 0.807, 0.606], abs=2e-3)


def test_people_who_see_nobody_keep_their_mean_speed() -> None:
    found = walk(PlainModel("constant-velocity", SIM, 0.05), 8.0)
    assert found.speed == pytest.approx(len(DENSITIES) * [1.34], abs=1e-6)


def test_people_of_the_model_slow_down_with_density() -> None:
    found = walk(CrowdModel(SIM, 0.05), 12.0).speed
    assert (np.diff(found) < 0.0).all()
    assert found[0] > 0.7 * weidmann()[0]


def test_one_way_is_one_lane_and_both_ways_are_not_at_once() -> None:
    assert walk(CrowdModel(SIM, 0.05), 2.0).lanes == pytest.approx(np.ones(4))
    assert walk(CrowdModel(SIM, 0.05), 0.2, both_ways=True).lanes.max() < 0.9


def test_the_same_seed_gives_the_same_speeds_and_a_sway_other_ones() -> None:
    model = CrowdModel(SIM, 0.05)
    swaying = CrowdModel(replace(SIM, sway=0.3), 0.05)
    assert walk(model, 3.0).speed.tobytes() == walk(model, 3.0).speed.tobytes()
    assert not np.array_equal(walk(model, 3.0).speed, walk(swaying, 3.0).speed)
