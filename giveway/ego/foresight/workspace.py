"""The workspace of a branch and bound: arrays that are kept and reused by each search."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from controller import Evaluation
from controller.kernels import Batches, SearchResult
from giveway.geometry.kernel import Array

Arrays = tuple[NDArray[Any], ...]


class Workspace:
    """Arrays of a branch and bound: predicted crowds, outcomes and costs of each manoeuvre.

    Args:
        count: Number of manoeuvres.
        horizon: Number N of a manoeuvre's steps.
        predicted: Number M of prediction steps.
        people: Largest number n of people.

    Attributes:
        arrays: All arrays, as the kernel takes them.
    """

    def __init__(self, count: int, horizon: int, predicted: int, people: int) -> None:
        self.count, self.people, self._predicted = count, people, predicted
        self._state = np.empty(count * predicted * people * 4)
        self._index = np.empty(count * predicted * people, dtype=np.int64)
        evaluations = np.zeros((3, count, horizon))  # gaps, threat-free and passing speeds
        self._evaluations = [Evaluation(*rows) for rows in zip(*evaluations, strict=True)]
        # Rows: own and later cost, cost of others, missing distance, own cost
        self._sums = np.zeros((4, count))
        self._steps = np.zeros((2, count), dtype=np.int64)  # steps predicted, steps assessed
        self._alike = np.zeros((count, count), dtype=np.int64)  # leading steps that are equal
        self._rows: dict[Batches, NDArray[np.int64]] = {}  # by batches
        self._bad = np.zeros(1, dtype=np.int64)
        self.arrays: Arrays = (
            self._state,
            self._index,
            evaluations,
            self._sums,
            self._steps,
            self._alike,
            np.empty((people, 2)),
            np.empty((people, 5)),
            np.empty((people, 4)),
            self._bad,
        )

    @property
    def bad(self) -> int:
        """The index of a pedestrian whose predicted state is not finite, or -1."""
        return int(self._bad[0])

    def rows_of(self, batches: Batches) -> NDArray[np.int64]:
        """Return the candidate rows, one line per batch: (3, k + 1), padded with -1."""
        rows = self._rows.get(batches)
        if rows is None:
            rows = self._rows[batches] = np.full((3, self.count + 1), -1)
            for batch, trials in enumerate(batches):
                rows[batch, : len(trials)] = trials
        return rows

    def positions(self, k: int, n: int) -> Array:
        """Return the predicted positions (M, n, 2) [m] of n people under a finished manoeuvre k."""
        M = self._predicted
        size = M * n * 4
        return self._state[k * size : (k + 1) * size].reshape(M, n, 4)[:, :, :2]

    def soon(self, k: int, n: int) -> Array:
        """Return the states (4 n,) after the first step: x, y [m], v_x, v_y [m/s] of each person.

        Args:
            k: Row of the manoeuvre.
            n: Number of people.
        """
        at = 4 * k * self._predicted * n
        return self._state[at : at + 4 * n]

    def result(self, best: int, clear: bool, tried: int) -> SearchResult:
        """Return the result of the search."""
        return SearchResult(best, float(self._sums[2, best]), clear, tried, self._evaluations[best])
