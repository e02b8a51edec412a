"""Who is predicted for a plan, against plain geometry."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
import shapely
import shapely.ops

from controller import SafetyParameters
from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.ego.foresight.relevance import MARGIN, Nearby, come_near
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from pedestrian_model import Crowd

angles = np.linspace(-np.pi / 2, np.pi / 2, 12)
PATHS = {
    "straight": EgoPath.through([(0.0, 0.0), (60.0, 0.0)]),
    "bend": EgoPath.through(np.column_stack([20.0 * np.cos(angles), 20.0 * np.sin(angles)])),
}
SPAN, EDGE = 3.0, 1e-6  # [s], [m]


def near(path, begin, end, position, velocity, margin):
    mask = np.empty(len(position), dtype=np.bool_)
    way, people = (path.vertices, path.stations), (position, velocity)
    come_near(way, (begin, end), people, SPAN, margin, mask)
    return mask


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("name", PATHS)
def test_people_whose_straight_walk_comes_near_the_path_count(name, seed):
    path, g = PATHS[name], np.random.default_rng(seed)
    begin, margin = g.uniform(5.0, 20.0), g.uniform(1.0, 6.0)
    end = begin + g.uniform(1.0, 25.0)
    position = np.array(path.pose((begin + end) / 2.0)[:2]) + g.uniform(-25.0, 25.0, (60, 2))
    velocity = g.uniform(-2.0, 2.0, (60, 2)) * (g.uniform(size=(60, 1)) < 0.8)
    mask = near(path, begin, end, position, velocity, margin)
    part = shapely.ops.substring(shapely.LineString(path.vertices), begin, end)
    ways = shapely.linestrings(np.stack([position, position + SPAN * velocity], axis=1))
    distance = shapely.distance(part, ways)
    clear = np.abs(distance - margin) > EDGE
    assert np.array_equal(mask[clear], (distance <= margin)[clear])
    assert 0 < mask.sum() < 60


def test_the_path_goes_on_straight_beyond_its_ends():
    path, still = PATHS["straight"], np.zeros((3, 2))
    people = np.array([(-9.0, 1.0), (66.0, 1.0), (72.0, 1.0)])
    assert list(near(path, -10.0, 20.0, people, still, 2.0)) == [True, False, False]
    assert list(near(path, 40.0, 70.0, people, still, 2.5)) == [False, True, True]


HALF_WIDTH, STEP = 1.15, 0.05  # [m], [s]


@pytest.mark.parametrize(("speed", "heeds"), [(4.0, False), (8.0, False), (13.9, True)])
@pytest.mark.parametrize("layer", [True, False])
def test_a_fast_ego_looks_as_far_aside_as_its_safety_layer_does(speed, heeds, layer):
    """Who stands 4 m beside its corridor could be before it within the 1.8 s of a stop."""
    config, _ = load([Layer("", {"scenario": "crossings"})])
    safety = SafetyParameters(walking_acceleration=3.0)
    waiting = SimpleNamespace(config=config.each_ego()[0], safety=safety if layer else None)
    path, shape = PATHS["straight"], VehicleShape(5.0, 1.8)
    nearby = Nearby(waiting, path, shape, 2.5, HALF_WIDTH, STEP)
    there = [(20.0, HALF_WIDTH + MARGIN + aside) for aside in (-0.1, 1.0, 3.0)]
    crowd = Crowd.create(there, np.zeros((3, 2)), 1.4, [[(20.0, 40.0)]] * 3)
    assert list(nearby.of(crowd, 10.0, speed)) == [True, heeds and layer, False]
