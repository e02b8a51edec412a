"""What the tests of the pedestrian model share."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from pedestrian_model import Crowd, Vehicles

sys.path.insert(0, str(Path(__file__).parent))
import vci_reference


@pytest.fixture(scope="session")
def reference():
    """The independent re-implementation beside this file."""
    return vci_reference


@pytest.fixture(scope="session")
def random_crowd():
    """A crowd of n at a density [1/m^2], each on the way to a point anywhere about."""

    def make(n, seed, density=0.5):
        rng = np.random.default_rng(seed)
        side = (n / density) ** 0.5
        return Crowd.create(
            rng.uniform(0.0, side, (n, 2)),
            rng.normal(0.0, 0.8, (n, 2)),
            rng.uniform(0.5, 2.2, n),
            list(rng.uniform(-side, 2.0 * side, (n, 1, 2))),
        )

    return make


@pytest.fixture(scope="session")
def random_vehicles():
    """Vehicles of all kinds: moving, reversing, standing, and lopsided reference points."""

    def make(seed, side=8.0):
        rng = np.random.default_rng(seed)
        speed = np.array([4.0, -1.5, 0.1, -0.1, 0.0, 0.2])[rng.integers(0, 6, 3)]
        return Vehicles.create(
            rng.uniform(0.0, side, 3),
            rng.uniform(0.0, side, 3),
            rng.uniform(-7.0, 7.0, 3),
            speed,
            rng.uniform(0.0, 4.0, 3),
            rng.uniform(0.5, 3.0, 3),
            rng.uniform(0.5, 2.5, 3),
        )

    return make


@pytest.fixture(scope="session")
def walkers():
    """Pedestrians from ``start`` (n, 2) straight to ``goal`` (n, 2), already walking (or not)."""

    def make(start, goal, speed=1.4, walking=True):
        start, goal = (np.atleast_2d(np.asarray(ends, float)) for ends in (start, goal))
        way = goal - start
        length = np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-12)
        return Crowd.create(
            start, way / length * speed * walking, speed, [point[None] for point in goal]
        )

    return make


@pytest.fixture(scope="session")
def clearance():
    """Distance (n,) [m] of points to the bare rectangle of the one vehicle; negative inside."""

    def measure(points, vehicles):
        x, y, psi, _, front, rear, width = vehicles.array[0]
        d = np.asarray(points) - (x, y)
        along = d @ (np.cos(psi), np.sin(psi))
        across = np.abs(d @ (-np.sin(psi), np.cos(psi))) - width / 2
        over = np.maximum(-rear - along, along - front)
        outside = np.hypot(np.maximum(over, 0.0), np.maximum(across, 0.0))
        return outside + np.minimum(np.maximum(over, across), 0.0)

    return measure
