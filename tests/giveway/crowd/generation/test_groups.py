"""Groups of pedestrians: their sizes, places and starts."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.config.tables.crowd import CrowdConfig
from giveway.crowd.generation.groups import formation, party_sizes, slowest
from giveway.crowd.generation.spawn import spawn
from giveway.geometry.path import EgoPath

MANY = 20_000


AXIS = EgoPath.through([(-20, 0), (100, 0)])


def test_sizes_of_groups_are_zero_truncated_poisson() -> None:
    sizes = np.array(party_sizes(MANY, 0.6, np.random.default_rng(1)))
    grouped = sizes[sizes > 1]
    assert grouped.sum() / sizes.sum() == pytest.approx(0.6, abs=0.02)
    assert grouped.max() == 5
    ratio = np.mean(grouped == 3) / np.mean(grouped == 2)
    assert ratio == pytest.approx(1.11 / 3.0, abs=0.03)  # lambda^3/3! over lambda^2/2!
    assert sum(sizes) == MANY


def test_up_to_three_walk_abreast_and_larger_groups_in_two_rows() -> None:
    for size in (1, 2, 3):
        assert np.ptp(formation(size)[:, 1]) == 0.0
    assert np.ptp(formation(4)[:, 1]) == 1.0
    assert slowest(np.array([1.0, 1.5, 1.2]), [1, 2]).tolist() == [1.0, 1.2, 1.2]


def test_groups_start_together_and_share_speed_and_way() -> None:
    config = CrowdConfig(pedestrians=40, groups=0.8, two_sided=True, minimum_spacing=0.5)
    crowd = spawn(config, AXIS, 5)
    x_min, y_min, x_max, y_max = config.spawn_area
    assert ((crowd.position[:, 0] >= x_min) & (crowd.position[:, 0] <= x_max)).all()
    assert (np.abs(crowd.position[:, 1]) <= -y_min).all()
    assert (np.abs(crowd.position[:, 1]) >= -y_max).all()
    groups = {group for group in crowd.groups if group}
    assert len(groups) >= 5
    for group in groups:
        rows = [i for i, own in enumerate(crowd.groups) if own == group]
        assert crowd.ids[rows[0]] == group
        assert np.ptp(crowd.desired_speed[rows]) == 0.0
        way = crowd.destination[rows] - crowd.position[rows]
        assert np.abs(np.diff(way, axis=0)).max() < 1e-9
        assert np.abs(np.diff(crowd.position[rows], axis=0)).max() <= 1.51
