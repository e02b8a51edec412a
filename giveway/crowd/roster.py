"""The pedestrians that giveway moves: who they are, where they came from, where they went."""

import itertools
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from pedestrian_model import Crowd


class Roster:
    """The crowd and the names of those in it.

    Attributes:
        ids: of all that ever were in the crowd; the tables refer to them by index.
        crowd: the state of those who are in it now.
        present: (n,) index into ``ids`` of each of them.
        names: the ids of each of them.
        newcomers: indices of those who joined since somebody last emptied the list.
        added: ids of those that giveway added; the others are the scenario's own.
    """

    def __init__(self, ids: Sequence[str] = (), crowd: Crowd | None = None) -> None:
        self.ids: list[str] = list(ids)
        self.crowd = Crowd.empty() if crowd is None else crowd
        self.present = np.arange(len(self.ids))
        self.names = list(ids)
        self.added = frozenset(ids)
        self.newcomers = list(range(len(self.ids)))
        self._index = {name: i for i, name in enumerate(self.ids)}
        self._counts = {"taken_over": 0, "handed_back": 0, "arrived": 0, "continued": 0}

    def __len__(self) -> int:
        return len(self.present)

    @property
    def ledger(self) -> dict[str, int]:
        """Where they are; added + taken over = handed back + arrived + continued + walking."""
        added, walking = len(self.added), len(self.present)
        return {"added": added, **self._counts, "walking": walking}

    def take_in(self, names: Iterable[str], crowd: Crowd) -> None:
        """Add walkers of the scenario; who comes back keeps the index."""
        indices = []
        names = list(names)
        for name in names:
            if name not in self._index:
                self._index[name] = len(self.ids)
                self.ids.append(name)
            indices.append(self._index[name])
        self.present = np.concatenate([self.present, np.array(indices, dtype=np.int64)])
        self.newcomers += indices
        self.names += names
        self.crowd = self.crowd.concatenate(crowd) if len(self.crowd) else crowd
        self._counts["taken_over"] += len(indices)

    def release(self, gone: NDArray[np.bool_]) -> list[str]:
        """Drop those where ``gone`` (n,) is true from the crowd; their ids."""
        names = [self.names[i] for i in np.flatnonzero(gone)]
        self.names = list(itertools.compress(self.names, (~gone).tolist()))
        self.crowd = self.crowd.select(~gone)
        self.present = self.present[~gone]
        return names

    def count(self, event: str, number: int = 1) -> None:
        """Note what became of pedestrians that left the crowd."""
        self._counts[event] += number
