"""The cell list finds the neighbours that all pairs have."""

from __future__ import annotations

import numpy as np
import pytest
from crowd_forces import forces_apart
from hypothesis import given, settings
from hypothesis import strategies as st

from pedestrian_model import Crowd, CrowdModel, Vehicles

seeds = st.integers(0, 2**31 - 1)


few = settings(max_examples=40)


@few
@given(seeds, st.floats(0.001, 3.0), st.integers(2, 200))
def test_the_cell_list_finds_the_same_neighbours(random_crowd, seed, density, n):
    crowd = random_crowd(n, seed, density)
    all_pairs = forces_apart(CrowdModel(cell_list_from=10**6), crowd, Vehicles.empty())
    cells = forces_apart(CrowdModel(cell_list_from=0), crowd, Vehicles.empty())
    np.testing.assert_allclose(cells.total, all_pairs.total, rtol=1e-9, atol=1e-7)


@pytest.mark.parametrize("cell_list_from", [0, 1000])
def test_a_pile_of_people_at_one_point_comes_apart(cell_list_from):
    crowd = Crowd.create(np.zeros((20, 2)), np.zeros((20, 2)), 1.0, [[(0.0, 0.0)]] * 20)
    model = CrowdModel(cell_list_from=cell_list_from)
    for _ in range(200):
        crowd = model.step(crowd, Vehicles.empty())
    gaps = np.linalg.norm(crowd.position[:, None] - crowd.position[None], axis=2)
    assert gaps[~np.eye(20, dtype=bool)].min() > 0.4
