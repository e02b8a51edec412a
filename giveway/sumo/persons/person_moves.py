"""The moves of persons to giveway's positions in SUMO's next step."""

import collections
import itertools
import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from giveway.sumo.library import direct

_EXACT = 2  # libsumo's flag for a move exactly to x, y, independently of lanes
_ON_LANE = 5.0  # largest distance [m] to the lane onto which a person is moved
# libsumo's "ghost" mode, in which no lane is searched for (issue 17257)
_NO_MATCHING = -1.0
_NO_EDGE, _EXACTLY = itertools.repeat(""), itertools.repeat(_EXACT)
_WITHOUT_MATCHING = itertools.repeat(_NO_MATCHING)


class PersonMoves:
    """Moves persons, and compares SUMO's positions with giveway's afterwards.

    Args:
        sumo: The libsumo module.

    Attributes:
        onto: Persons who are no ghosts in SUMO's next step: the edge onto which each is moved, or
            None for those whom SUMO moves itself.
    """

    onto: Mapping[str, str | None]

    def __init__(self, sumo: Any) -> None:
        self._move = direct(sumo, "person", "moveToXY")
        self._position = direct(sumo, "person", "getPosition")
        self.onto = {}

    def make(
        self, ids: Sequence[str], x: Sequence[float], y: Sequence[float], angles: Sequence[float]
    ) -> None:
        """Move persons. SUMO carries the moves out in its next step.

        Args:
            ids: Ids of the persons.
            x: Coordinate x of each person [m], finite.
            y: Coordinate y of each person [m], finite.
            angles: Angles of each person [deg, 0 = north, clockwise], finite.
        """
        if not self.onto:
            moves = map(self._move, ids, _NO_EDGE, x, y, angles, _EXACTLY, _WITHOUT_MATCHING)
            collections.deque(moves, maxlen=0)  # runs through the moves
            return
        for name, *place in zip(ids, x, y, angles, strict=True):
            edge = self.onto.get(name, "")
            if edge is not None:
                self._move(name, edge, *place, _EXACT, _ON_LANE if edge else _NO_MATCHING)

    def compare(
        self,
        ids: Sequence[str],
        x: Sequence[float],
        y: Sequence[float],
        compare: Callable[[str, tuple[float, float], Sequence[float]], None],
    ) -> None:
        """Call ``compare`` with id, SUMO's position and ours of persons that may differ."""
        # most positions are equal to the last bit, so the differing ones are searched only if
        # needed
        if any(map(operator.ne, map(self._position, ids), zip(x, y, strict=True))):
            for name, here in zip(ids, zip(x, y, strict=True), strict=True):
                edge = self.onto.get(name, "")
                if edge is not None and not edge.startswith(":"):
                    compare(name, self._position(name), here)
