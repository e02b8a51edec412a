"""Trees as masks of leaves answer as the nodes do."""

from __future__ import annotations

import numpy as np
import pytest

from pedestrian_model.drift.features import ALONG, FEATURES
from pedestrian_model.drift.forest import Forest, fill_corrections, masked
from pedestrian_model.drift.trained import fits


def walked(forest, horizon, axis, numbers):
    """The sum of the trees' answers, from node to node."""
    total = forest.start[horizon, axis]
    for node in forest.roots[horizon, axis]:
        while forest.feature[node] >= 0:
            higher = numbers[forest.feature[node]] > forest.value[node]
            node = forest.below[node] + int(higher)
        total += forest.value[node]
    return total


def corrections(forest, numbers, heading=None):
    out = np.empty((len(numbers), 3, 2))
    heading = np.tile([1.0, 0.0], (len(numbers), 1)) if heading is None else heading
    fill_corrections(masked(forest), heading, numbers, out)
    return out


@pytest.fixture
def numbers():
    found = np.random.default_rng(1).normal(0.0, 0.5, (40, FEATURES))
    found[:, 0] = found[:, len(ALONG)] = abs(found[:, 0])
    return found


@pytest.mark.parametrize("name", list(fits()))
def test_masks_answer_as_a_walk_from_node_to_node(numbers, name):
    forest, split = fits()[name].forest, len(ALONG)
    mirrored = -numbers[:, split:]
    mirrored[:, 0] = numbers[:, split]
    out = corrections(forest, numbers)
    for i in range(len(numbers)):
        for horizon in range(3):
            assert out[i, horizon, 0] == walked(forest, horizon, 0, numbers[i])
            left = walked(forest, horizon, 1, numbers[i, split:])
            right = walked(forest, horizon, 1, mirrored[i])
            assert out[i, horizon, 1] == 0.5 * (left - right)


def test_a_number_at_the_threshold_is_on_its_lower_side():
    feature, below = np.array([2, -1, 0, -1, -1]), np.array([1, 0, 3, 0, 0])
    value = np.array([0.5, 1.0, 1.0, 2.0, 4.0])  # at most 0.5: 1; else 2, and 4 above a speed of 1
    roots = np.zeros((3, 2, 1), dtype=np.int64)
    forest = Forest(feature, value, below, roots, np.full((3, 2), 0.25))
    numbers = np.zeros((4, FEATURES))
    numbers[:, 0], numbers[:, 2] = (1.0, 1.0, 1.0, 1.5), (0.0, 0.5, 0.6, 0.6)
    assert corrections(forest, numbers)[:, 1, 0].tolist() == [1.25, 1.25, 2.25, 4.25]


def test_nobody_who_stands_is_corrected(numbers):
    heading = np.zeros((40, 2))
    heading[1::2, 0] = 1.0
    out = corrections(fits()["exact"].forest, numbers, heading)
    assert (out[::2] == 0.0).all()
    assert (out[1::2] != 0.0).any()
