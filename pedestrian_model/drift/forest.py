"""Regression trees as flat arrays, and their compiled sum (Friedman 2001, gradient boosting)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined, kernel
from pedestrian_model.drift.features import ACROSS, ALONG

HORIZONS = (0.75, 2.0, 4.0)  # Times ahead [s] for which the trees are trained
Array = NDArray[np.float64]


class Forest(NamedTuple):
    """The trees of all horizons, along and across the heading.

    Attributes:
        feature: Index of the number that each node compares; -1 in a leaf.
        value: Threshold of each node, or the answer [m/s] of a leaf.
        below: Node (index) that follows if the number is at most the threshold; otherwise the next
            one after it.
        roots: First nodes (3, 2, T) of the trees of each horizon and axis.
        start: Sum (3, 2) [m/s] to which the trees add.
    """

    feature: NDArray[np.int64]
    value: Array
    below: NDArray[np.int64]
    roots: NDArray[np.int64]
    start: Array


@kernel
def fill_corrections(forest: Forest, heading: Array, numbers: Array, out: Array) -> None:
    """Fill the mean errors of constant velocity that the trees expect.

    Across the heading, half the difference between the answer and that to the mirrored numbers is
    taken, so that left and right are treated alike.

    Args:
        forest: Trees.
        heading: Headings (n, 2); zero of people who stand, whose corrections are zero.
        numbers: Numbers (n, FEATURES) of :func:`pedestrian_model.drift.features.fill_features`.
        out: Corrections (n, 3, 2) [m/s] along and across, filled.
    """
    split = len(ALONG)
    mirrored = np.empty(len(ACROSS))
    for i in range(heading.shape[0]):
        out[i, :, :] = 0.0
        if heading[i, 0] == 0.0 and heading[i, 1] == 0.0:
            continue
        mirrored[0] = numbers[i, split]
        for k in range(1, len(ACROSS)):
            mirrored[k] = -numbers[i, split + k]
        for horizon in range(len(HORIZONS)):
            out[i, horizon, 0] = _sum(forest, horizon, 0, numbers[i, :split])
            left = _sum(forest, horizon, 1, numbers[i, split:])
            out[i, horizon, 1] = 0.5 * (left - _sum(forest, horizon, 1, mirrored))


@inlined
def _sum(forest: Forest, horizon: int, axis: int, numbers: Array) -> float:
    """Return the sum of the trees of a horizon and an axis."""
    total = forest.start[horizon, axis]
    for root in forest.roots[horizon, axis]:
        node = root
        while forest.feature[node] >= 0:
            higher = numbers[forest.feature[node]] > forest.value[node]
            node = forest.below[node] + (1 if higher else 0)
        total += forest.value[node]
    return float(total)
