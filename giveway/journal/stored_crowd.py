"""The track of a crowd whose records stay in the journal's file, for runs of any length."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from giveway.journal.stored_rows import Rows, StoredRows
from giveway.run_data.tracks import COORDINATES, CrowdTrack, as_indices

_PART = 500_000  # Number of records that are measured at once
_AT_ONCE = 6  # Number of such parts that are gathered each time the file is read


class StoredCrowd(CrowdTrack):
    """The records of a long run's crowd: read in pieces, or a column at a time.

    Args:
        rows: Rows of the journal.
        first, last: First control instant of the records, which is step 0, and the one after them.
        about: Ids of the people, and what is known about them, as in :class:`CrowdTrack`.
    """

    is_long = True
    _rows: StoredRows
    _first: int
    _last: int
    _about: dict[str, Any]

    def __init__(self, rows: StoredRows, first: int, last: int, about: dict[str, Any]) -> None:
        vars(self).update(_rows=rows, _first=first, _last=last, _about=about, **about)

    def pieces(self) -> Iterator[CrowdTrack]:
        """Yield the records in order of time, some control instants at once."""
        parts = map(self._track, self._own_rows())
        nobody: Rows = np.empty(0, self._rows.row)
        yield next(parts, None) or self._track(nobody)
        yield from parts

    def by_people(self) -> Iterator[CrowdTrack]:
        """Yield the records of some people at a time, in the order of ``ids``."""
        records = np.zeros(len(self.ids), dtype=np.int64)
        for part in self.pieces():
            records += np.bincount(part.pedestrian, minlength=len(records))
        ends = [0]
        while ends[-1] < len(records):
            total = np.cumsum(records[ends[-1] :])
            ends.append(ends[-1] + max(1, int(np.searchsorted(total, _PART, side="right"))))
        for first in range(0, len(ends) - 1, _AT_ONCE):
            cuts = ends[first : first + _AT_ONCE + 1]
            parts: list[Rows] = [np.empty(0, self._rows.row)]
            parts += [_of_people(rows, cuts[0], cuts[-1]) for rows in self._own_rows()]
            read = np.concatenate(parts)
            for begin, end in pairwise(cuts):
                yield self._track(_of_people(read, begin, end)).of_people(begin, end)

    def _own_rows(self) -> Iterator[Rows]:
        for rows in self._rows.pieces():
            a, b = np.searchsorted(rows["step"], (self._first, self._last))
            if b > a:
                yield rows[a:b]

    def _track(self, rows: Rows) -> CrowdTrack:
        columns: dict[str, Any] = {name: np.ascontiguousarray(rows[name]) for name in COORDINATES}
        columns |= {"step": as_indices(rows["step"]) - self._first}
        columns |= {"pedestrian": as_indices(rows["pedestrian"])}
        return CrowdTrack(**columns | self._about)

    def during(self, first: int, instants: int) -> CrowdTrack:
        """Return the records of ``instants`` control instants from ``first`` on, as step 0."""
        begin, about = self._first + first, dict(self._about)
        if about["reacts_from"] is not None:
            about["reacts_from"] = about["reacts_from"] - first
        return StoredCrowd(self._rows, begin, min(begin + instants, self._last), about)

    def __getattr__(self, name: str) -> NDArray[Any]:
        """Return a whole column, which is read anew each time."""
        if name not in ("step", "pedestrian", *COORDINATES):
            raise AttributeError(name)
        return np.concatenate([getattr(part, name) for part in self.pieces()])


def _of_people(rows: Rows, begin: int, end: int) -> Rows:
    person = rows["pedestrian"]
    return rows[(person >= begin) & (person < end)]
