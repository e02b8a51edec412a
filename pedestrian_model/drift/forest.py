"""Regression trees as flat arrays, and their compiled sum (Friedman 2001, gradient boosting)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined, kernel
from pedestrian_model.drift.features import ACROSS, ALONG

HORIZONS = (0.75, 2.0, 4.0)  # Times ahead [s] for which the trees are trained
LEAVES = 8  # Largest number of leaves of a tree
_ALL = (1 << LEAVES) - 1  # Mask of all leaves
_FIRST = np.array([(k & -k).bit_length() - 1 for k in range(_ALL + 1)])  # First leaf of each mask
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


class Trees(NamedTuple):
    """The same trees as masks of leaves, up to ``LEAVES`` in each of T trees.

    All splits of a tree are compared, and each one that is exceeded rules out the leaves on its
    lower side; the first leaf that is left is the answer (Lucchese et al. 2015, QuickScorer).

    Attributes:
        feature: Index (3, 2, T, LEAVES - 1) of the number that each split compares.
        threshold: Threshold (3, 2, T, LEAVES - 1) of each split.
        mask: Leaves (3, 2, T, LEAVES - 1) that are left if the threshold is exceeded, one bit each.
        answer: Answers (3, 2, T, LEAVES) [m/s] of the leaves.
        start: Sum (3, 2) [m/s] to which the trees add.
    """

    feature: NDArray[np.int64]
    threshold: Array
    mask: NDArray[np.int64]
    answer: Array
    start: Array


def masked(forest: Forest) -> Trees:
    """Return the trees of a forest as masks of leaves."""
    shape = forest.roots.shape
    feature, mask = np.zeros((2, *shape, LEAVES - 1), dtype=np.int64)
    threshold, answer = np.full(feature.shape, np.inf), np.zeros((*shape, LEAVES))

    def lay_out(tree: tuple[int, ...], node: int, leaf: int, split: int) -> tuple[int, int]:
        """Add a node and those below; return the numbers of leaves and splits so far."""
        if forest.feature[node] < 0:
            answer[tree][leaf] = forest.value[node]
            return leaf + 1, split
        after, here = lay_out(tree, forest.below[node], leaf, split)
        feature[tree][here], threshold[tree][here] = forest.feature[node], forest.value[node]
        mask[tree][here] = _ALL & ~((1 << after) - (1 << leaf))
        return lay_out(tree, forest.below[node] + 1, after, here + 1)

    for tree in np.ndindex(shape):
        lay_out(tree, int(forest.roots[tree]), 0, 0)
    return Trees(feature, threshold, mask, answer, forest.start)


@kernel
def fill_corrections(trees: Trees, heading: Array, numbers: Array, out: Array) -> None:
    """Fill the mean errors of constant velocity that the trees expect.

    Across the heading, half the difference between the answer and that to the mirrored numbers is
    taken, so that left and right are treated alike.

    Args:
        trees: Trees.
        heading: Headings (n, 2); zero of people who stand, whose corrections are zero.
        numbers: Numbers (n, FEATURES) of :func:`pedestrian_model.drift.features.fill_features`.
        out: Corrections (n, 3, 2) [m/s] along and across, filled.
    """
    n, split = heading.shape[0], len(ALONG)
    along, across = np.empty((split, n)), np.empty((len(ACROSS), 2 * n))
    for i in range(n):
        along[:, i] = numbers[i, :split]
        across[:, i] = numbers[i, split:]
        across[:, n + i] = -numbers[i, split:]
        across[0, n + i] = numbers[i, split]
    left, total = np.empty(2 * n, dtype=np.int64), np.empty(2 * n)
    for horizon in range(len(HORIZONS)):
        _fill_sums(trees, (horizon, 0), along, left[:n], total[:n])
        out[:, horizon, 0] = total[:n]
        _fill_sums(trees, (horizon, 1), across, left, total)
        out[:, horizon, 1] = 0.5 * (total[:n] - total[n:])
    for i in range(n):
        if heading[i, 0] == 0.0 and heading[i, 1] == 0.0:
            out[i, :, :] = 0.0


@inlined
def _fill_sums(
    trees: Trees,
    which: tuple[int, int],
    numbers: Array,
    left: NDArray[np.int64],
    total: Array,
) -> None:
    """Fill the sums of the trees of a horizon and an axis, tree by tree.

    Args:
        trees: Trees.
        which: Index of the horizon and of the axis.
        numbers: Numbers (F, n), so that a split is compared for several people at once.
        left: Memory (n,) for the leaves that are left.
        total: Sums (n,) [m/s], filled.
    """
    horizon, axis = which
    total[:] = trees.start[horizon, axis]
    for tree in range(trees.feature.shape[2]):
        left[:] = _ALL
        for split in range(LEAVES - 1):
            compared = numbers[trees.feature[horizon, axis, tree, split]]
            threshold = trees.threshold[horizon, axis, tree, split]
            mask = trees.mask[horizon, axis, tree, split]
            for i in range(total.shape[0]):
                left[i] &= mask if compared[i] > threshold else _ALL
        for i in range(total.shape[0]):
            total[i] += trees.answer[horizon, axis, tree, _FIRST[left[i]]]
