"""Held persons on the lanes of SUMO's records, for whatever looks for persons there.

A held person is moved as a ghost, which is on no lane. These facts of SUMO 1.28 were found by
experiment and in its sources:

* A crossing's light is asked for green as SUMO itself lets a person step from a sidewalk into the
  walkingarea. A ghost stays registered until it is put onto another lane. Therefore a person who
  comes to the end of the sidewalk is put on its very end and left to SUMO for one step, in which
  SUMO has it there, at most 2.5 m from its place. Then it is put into the walkingarea, where it
  would block the way in for others.
* Persons are added up as they leave an edge that their walk brought them to. It is left as they are
  put on a crossing, but nobody comes to an edge by being put there: the walk has to begin anew.
* Detectors see persons that are moved onto the lane itself, which is exact on straight lanes.
"""

import math
import re
from collections.abc import Callable, Iterable
from typing import Any

from giveway.sumo.network.footpaths import Foot, FootPaths
from giveway.sumo.persons.handover import NOWHERE
from giveway.sumo.persons.observers import Observers

_CROSSING = re.compile(r"^(:.*)_c\d+$")
_END = 0.06  # distance [m] to a lane's end, at which a person has come to it
_NEAR = 2.5  # largest distance [m] to a lane's end, at which SUMO moves a person
_ASIDE = 1.0  # distance [m] beside a lane, at which a person still walks on it
_STRAIGHT = 2.0  # distance [m] to a lane's bends, from which on SUMO moves people onto it exactly
_ROOM = 1.0  # distance [m] from its end, in which a person leaves room for others to enter
_FRESH = 2  # number of steps after a take-over until SUMO's speed of a person is its own
_TRIES = 3  # number of steps in a row in which SUMO may fail to move a person on

BeginAnew = Callable[[str, tuple[str, ...]], None]


class LaneRecords:
    """Keeps held persons on lanes in SUMO's records.

    Args:
        sumo: The libsumo module, with a simulation running.
        paths: Lanes that people walk on.
        observers: What looks for persons.
        begin_anew: Function that lets a person's walk in SUMO begin anew, given id and edges.

    Attributes:
        moves: Persons who are no ghosts in SUMO's next step: the edge onto which each is moved, or
            None for those whom SUMO moves itself. Inside junctions SUMO is not exact.
    """

    moves: dict[str, str | None]

    def __init__(
        self, sumo: Any, paths: FootPaths, observers: Observers, begin_anew: BeginAnew
    ) -> None:
        self._begin_anew = begin_anew
        self._person = sumo.person
        self._lane = sumo.lane
        self._paths = paths
        self._observers = observers
        self._at: dict[str, list[str]] = {}  # remaining edges of each person's walk
        self._left: set[str] = set()  # persons who have left their present edge
        self._tries: dict[str, int] = {}
        self._fresh: dict[str, int] = {}  # steps for which each person's speed in SUMO is wrong
        self._at_entry: dict[str, tuple[float, float]] = {}  # where each entered a walkingarea
        self._crossings: dict[str, str] = {}  # one crossing's lane of each junction
        for lane in sumo.lane.getIDList() if observers.edges or observers.junctions else ():
            if crossing := _CROSSING.match(lane.rpartition("_")[0]):
                self._crossings.setdefault(crossing[1], lane)
        self._shown: set[str] = set()
        self.moves = {}
        self._refusals = (sumo.TraCIException, sumo.FatalTraCIError)

    def __bool__(self) -> bool:
        return bool(self._observers)

    def keeps(self, lane: str) -> bool:
        """Return whether a person taken over inside a junction stays there in the records."""
        return self._follows(lane.rpartition("_")[0])

    def begin(self, name: str, edges: tuple[str, ...]) -> None:
        """Follow a person who has been taken over, from the first of ``edges`` on."""
        if self:
            self._at[name] = list(edges)
            self._fresh[name] = _FRESH

    def end(self, name: str) -> None:
        """Follow a person no more."""
        self._at.pop(name, None)
        self._tries.pop(name, None)
        self._shown.discard(name)
        self._left.discard(name)
        self._fresh.pop(name, None)
        self._at_entry.pop(name, None)
        self.moves.pop(name, None)

    def update(self, people: Iterable[tuple[str, float, float]]) -> None:
        """Put people on their lanes for SUMO's next step.

        Args:
            people: Id of each person, and its place x, y [m].
        """
        self.moves.clear()
        for name, x, y in people:
            if name not in self._at:
                continue
            try:
                if name not in self._left and self._person.getLaneID(name).startswith(":"):
                    self._left.add(name)
                if name in self._left:
                    self._in_junction(name, x, y)
                else:
                    self._on_edge(name, x, y)
            except self._refusals:
                self.end(name)

    def _follows(self, edge: str) -> bool:
        """Return whether people are followed over a junction, given one of its inner edges."""
        observers = self._observers
        return observers.edges or re.sub(r"_[cw]\d+$", "", edge) in observers.junctions

    def _on_edge(self, name: str, x: float, y: float) -> None:
        """Show a person to the detectors of a lane, or let it leave the lane at its end."""
        edge = self._at[name][0]
        foot = self._paths.foot(edge, x, y)
        if foot is None:
            return
        windows = self._observers.windows.get(foot.lane, ())
        if (
            any(start <= foot.position <= stop for start, stop in windows)
            and self._is_on(foot)
            and self._paths.is_straight(edge, foot.position, _STRAIGHT)
        ):
            if name not in self._shown:  # else SUMO's speed would be that of the move onto the lane
                self._person.moveTo(name, foot.lane, foot.position, foot.lateral)
                self._shown.add(name)
            self.moves[name] = edge
            return
        if name in self._shown:
            self._shown.discard(name)
            self._person.moveTo(name, foot.lane, NOWHERE)
        if self._fresh[name] > 0:  # detectors would take it for one that comes from far away
            self._fresh[name] -= 1
            return
        following = self._person.getNextEdge(name)
        if not following.startswith(":") or not self._follows(following):
            return
        junction = following[1:].rpartition("_")[0]
        end = self._paths.end_at(edge, junction)
        if end is None or abs(foot.position - end) > _END or foot.distance > _NEAR:
            self._tries.pop(name, None)
            return
        crossing = self._crossings.get(f":{junction}")
        tries = self._tries[name] = self._tries.get(name, 0) + 1
        if tries <= _TRIES and (f":{junction}" in self._observers.junctions or crossing is None):
            self._person.moveTo(name, foot.lane, abs(end - _END / 6), foot.lateral)
            self.moves[name] = None
            self._at_entry[name] = x, y
        elif crossing is not None:
            self._leave(name, crossing)

    def _leave(self, name: str, crossing: str) -> None:
        """Let a person leave its edge for a junction, unseen on one of its crossings."""
        self._person.moveTo(name, crossing, NOWHERE)
        self._left.add(name)

    def _in_junction(self, name: str, x: float, y: float) -> None:
        """End a person's request for green on the crossing, and let it enter the next edge."""
        edges = self._at[name]
        if len(edges) > 1:
            foot = self._paths.foot(edges[1], x, y)
            if foot is not None and self._is_on(foot):
                self._enter(name, foot)
                return
        lane = self._person.getLaneID(name)
        if not lane.startswith(":") or _CROSSING.match(lane.rpartition("_")[0]):
            return
        following = self._person.getNextEdge(name)
        if _CROSSING.match(following):
            crossing = self._paths.foot(following, x, y)
            if crossing is not None and self._is_on(crossing):
                self._leave(name, crossing.lane)
                return
        entry = self._at_entry.get(name)
        if entry is not None and math.dist(entry, (x, y)) > _ROOM:
            del self._at_entry[name]
            self.moves[name] = lane.rpartition("_")[0]

    def _enter(self, name: str, foot: Foot) -> None:
        """Let a person enter the next edge of its walk."""
        edges = self._at[name]
        del edges[0]
        self._left.discard(name)
        self._at_entry.pop(name, None)
        if self._observers.edges:
            self._begin_anew(name, tuple(edges))
        self._person.moveTo(name, foot.lane, NOWHERE)

    def _is_on(self, foot: Foot) -> bool:
        """Return whether a person walks on a lane, between its ends."""
        inner = float(self._lane.getLength(foot.lane)) - _END
        beside = foot.distance - float(self._lane.getWidth(foot.lane)) / 2.0
        return _END < foot.position < inner and beside < _ASIDE
