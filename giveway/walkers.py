"""The scenario's own persons: taken over where they walk, handed back to SUMO afterwards."""

from __future__ import annotations

import enum
import itertools
import math
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from giveway.traffic import angle_to_heading

if TYPE_CHECKING:
    from collections.abc import Container, Sequence

    from numpy.typing import NDArray

_WALKING = 2  # SUMO's stage type


class Arrival(enum.Enum):
    """What becomes of a person that has reached the end of its walk."""

    ARRIVED = "arrived"  # nothing was left to do: it has left SUMO
    CONTINUED = "continued"  # a stop, a ride or another walk follows in SUMO


@dataclass(frozen=True)
class Walker:
    """A person as SUMO walks it, at SUMO's present instant."""

    id: str
    type: str
    x: float  # [m]
    y: float  # [m]
    heading: float  # [rad], counter-clockwise from +x
    speed: float  # [m/s]
    desired_speed: float  # [m/s] > 0
    edges: tuple[str, ...]  # the present walk's remaining normal edges, the current one first
    lane: str  # SUMO's present lane, may lie inside a junction
    arrival_position: float  # [m] on the last edge
    stages_left: int  # after this walk


class ScenarioWalkers:
    """Who of the scenario's persons is SUMO's at present, and who is ours.

    Args:
        sumo: the libsumo module.
        ours: ids of persons that giveway added: never touched.
    """

    def __init__(self, sumo: Any, ours: Container[str]) -> None:
        self._sumo = sumo
        self._ours = ours
        self.held: set[str] = set()
        self.counts: Counter[str] = Counter()
        self._free: dict[str, None] | None = None
        self._walks: dict[str, Walker] = {}

    def positions(self) -> tuple[list[str], NDArray[np.float64]]:
        """Ids and positions (n, 2) [m] of every departed person that is not held."""
        simulation = self._sumo.simulation
        if self._free is None:
            self._free = dict.fromkeys(
                n for n in self._sumo.person.getIDList() if n not in self._ours
            )
        else:
            for name in simulation.getDepartedPersonIDList():
                if name not in self._ours:
                    self._free[name] = None
            for name in simulation.getArrivedPersonIDList():
                self._free.pop(name, None)
        ids = list(self._free)
        flat = itertools.chain.from_iterable(map(self._sumo.person.getPosition, ids))
        return ids, np.fromiter(flat, dtype=np.float64, count=2 * len(ids)).reshape(-1, 2)

    def take(self, ids: Sequence[str]) -> list[Walker]:
        """Take over those of ``ids`` that walk at present."""
        person, walkers = self._sumo.person, []
        for name in ids:
            if name in self.held or not person.getLaneID(name):
                continue
            stage = person.getStage(name)
            if stage.type != _WALKING:
                continue
            x, y = person.getPosition(name)
            road, edges = person.getRoadID(name), tuple(stage.edges)
            walker = Walker(
                id=name,
                type=person.getTypeID(name),
                x=x,
                y=y,
                heading=angle_to_heading(person.getAngle(name)),
                speed=person.getSpeed(name),
                desired_speed=max(person.getMaxSpeed(name), 0.1),
                edges=edges[edges.index(road) :] if road in edges else edges,
                lane=person.getLaneID(name),
                arrival_position=stage.arrivalPos,
                stages_left=person.getRemainingStages(name) - 1,
            )
            walkers.append(walker)
            self.held.add(name)
            self._walks[name] = walker
            if self._free is not None:
                self._free.pop(name, None)
            self.counts["taken"] += 1
        return walkers

    def hand_back(self, name: str, x: float, y: float, place: tuple[str, float]) -> bool:
        """Give a held person back to SUMO at ``place``, an edge and a position [m] on it."""
        if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(place[1])):
            return False
        edge, position = place
        person = self._sumo.person
        try:
            person.moveTo(name, f"{edge}_0", position)
        except self._sumo.TraCIException:
            return False
        self._release(name)
        self.counts["handed_back"] += 1
        return True

    def arrive(self, name: str) -> Arrival:
        """Let a held person who is at its walk's end arrive, or go on with its next stage."""
        walker = self._walks[name]
        if walker.stages_left == 0:
            self._sumo.person.removeStages(name)
            self.held.discard(name)
            self.counts["arrived"] += 1
            return Arrival.ARRIVED
        self._sumo.person.removeStage(name, 0)
        self._release(name)
        self.counts["continued"] += 1
        return Arrival.CONTINUED

    def _release(self, name: str) -> None:
        self.held.discard(name)
        del self._walks[name]
        if self._free is not None:
            self._free[name] = None
