"""Notes on when each person comes in sight of an ego, and is lost from sight again."""

import numpy as np

from giveway.ego.perception.protocol import Ids, OwnState
from giveway.geometry.kernel import Array

NO_CHANGES: Array = np.empty((0, 3))


class Sights:
    """Notes who is perceived, from one observation to the next."""

    def __init__(self) -> None:
        self._known = np.empty(0, dtype=np.int64)

    def changes(self, ids: Ids, position: Array, own: OwnState) -> Array:
        """Return who is perceived from now on (1) and no longer (0).

        Args:
            ids: Ids (n,) of the perceived people.
            position: Their positions (n, 2) [m].
            own: State of the ego.

        Returns:
            Rows (k, 3): id, 1 or 0, distance [m] from the middle of the front bumper to the
            place where the person is perceived; NaN for who is lost.
        """
        if np.array_equal(ids, self._known):
            return NO_CHANGES
        new, lost = ~np.isin(ids, self._known), np.setdiff1d(self._known, ids)
        self._known = ids.copy()
        if not new.any() and not len(lost):
            return NO_CHANGES
        off = position[new] - own.pose[:2]
        rows = np.full((int(new.sum()) + len(lost), 3), np.nan)
        rows[:, 0] = np.concatenate([ids[new], lost])
        rows[:, 1] = np.arange(len(rows)) < new.sum()
        rows[: len(off), 2] = np.hypot(off[:, 0], off[:, 1])
        return rows
