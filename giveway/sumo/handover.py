"""How SUMO is made to let go of a walking person, and to walk it on again.

``person.moveTo`` ends a ``moveToXY``: the person walks on in SUMO from the lane position given,
with its id, type, parameters and remaining stages. It takes effect at once. What SUMO 1.28 gets
wrong, found by experiment and in its sources:

* a person moved as a ghost stays in the books of the lane where it was: SUMO's pedestrians walk
  round that spot and cars wait for ever at a crossing that it has long left. Far outside of the
  lane it is in nobody's way;
* a person taken over inside a junction keeps that inner edge in its books, from which moveTo
  derives a wrong walking direction: it would leave the network, and the simulation end with
  "Disconnected walk". A fresh walk has clean books;
* on the last edge the direction is the one from the former position to the new one, so that a
  person put before its destination must come from the right side: else it arrives at once;
* a fresh walk is as fast as the person likes, whatever speed the scenario gave to the former one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from giveway.sumo.footpaths import Foot

_WALKING = 2  # SUMO's stage type
NOWHERE = -1000.0  # [m] on its lane: where a held person is in SUMO's books
_RUN_UP = 0.5  # [m] before the place where a person is put on its last edge


@dataclass(frozen=True, slots=True)
class Walk:
    """What is remembered of a held person's walk."""

    edges: tuple[str, ...]  # remaining, the current one first
    arrival_position: float  # [m] on the last edge
    stages_left: int  # after this walk
    type: str
    own_speed: float | None  # [m/s] that the scenario gives to this walk
    was_inside: bool  # taken over inside a junction


class Handover:
    """Moves persons in SUMO's books.

    All methods may raise one of ``refusals``.

    Args:
        sumo: the libsumo module.

    Attributes:
        refusals: the exceptions that SUMO's refusals become.
    """

    refusals: tuple[type[Exception], ...]

    def __init__(self, sumo: Any) -> None:
        self._simulation = sumo.simulation
        self._person = sumo.person
        self._paced: dict[str, tuple[float, int]] = {}  # the usual speed factor, until when
        self.refusals = (sumo.TraCIException, sumo.FatalTraCIError)  # neither is the other's base

    def park(self, name: str, lane: str) -> None:
        """Put a person out of everybody's way, in the books of a lane of its walk."""
        self._person.moveTo(name, lane, NOWHERE)

    def walk_on(self, name: str, walk: Walk, step: int, foot: Foot) -> None:
        """Let a person walk on from ``foot``, which lies on edge ``step`` of its walk."""
        edges = walk.edges[step:]
        if len(edges) == 1:
            self._approach(name, walk, foot)
            return
        present = tuple(self._person.getStage(name).edges)
        rerouted = present[-len(walk.edges) :] != walk.edges  # by one of SUMO's devices
        if rerouted or walk.was_inside or edges[0] in edges[1:] + walk.edges[:step]:
            self._restart(name, walk, edges)
        self._person.moveTo(name, foot.lane, foot.position, foot.lateral)

    def walk_anew(self, name: str, walk: Walk, edge: str, foot: Foot) -> bool:
        """Let a person walk to its walk's end from ``foot`` on any ``edge``; False if no way leads.

        The way is SUMO's fastest one.
        """
        found = self._simulation.findIntermodalRoute(
            edge,
            walk.edges[-1],
            departPos=foot.position,
            arrivalPos=walk.arrival_position,
            pType=walk.type,
        )
        if len(found) != 1 or found[0].type != _WALKING or not found[0].edges:
            return False
        if len(found[0].edges) == 1:
            self._approach(name, walk, foot)
        else:
            self._restart(name, walk, tuple(found[0].edges))
            self._person.moveTo(name, foot.lane, foot.position, foot.lateral)
        return True

    def finish(self, name: str, lane: str, walk: Walk) -> None:
        """Put a person on the end of its walk, where SUMO's next step ends it."""
        self._person.moveTo(name, lane, walk.arrival_position)

    def _approach(self, name: str, walk: Walk, foot: Foot) -> None:
        """Put a person on the last edge of its walk, facing the end."""
        last = walk.edges[-1:]
        ahead = walk.arrival_position >= foot.position
        behind = foot.position - _RUN_UP if ahead else foot.position + _RUN_UP
        if walk.was_inside or len(walk.edges) > 1:
            self._restart(name, walk, last)
        self._person.moveTo(name, foot.lane, max(behind, 0.0))
        self._restart(name, walk, last)  # departs there, since it is on this edge already
        self._person.moveTo(name, foot.lane, foot.position, foot.lateral)

    def _restart(self, name: str, walk: Walk, edges: tuple[str, ...]) -> None:
        """Replace the person's walk by a fresh one along ``edges`` to the same end."""
        person = self._person
        stage = person.getStage(name)
        stage.edges = edges
        person.replaceStage(name, 0, stage)
        if walk.own_speed is not None:
            self._set_pace(name, walk.own_speed, walk.stages_left)

    def _set_pace(self, name: str, speed: float, stages_left: int) -> None:
        """Have a person like to walk at ``speed`` [m/s] until ``stages_left`` stages are left."""
        person = self._person
        factor = person.getSpeedFactor(name)
        own_factor, _ = self._paced.get(name, (factor, 0))
        person.setSpeedFactor(name, factor * speed / person.getMaxSpeed(name))
        self._paced[name] = own_factor, stages_left

    def end_paces(self) -> None:
        """Whoever has ended the walk that had a speed of its own likes its usual speed again."""
        for name, (factor, stages_left) in list(self._paced.items()):
            try:
                if self._person.getRemainingStages(name) > stages_left:
                    continue
                self._person.setSpeedFactor(name, factor)
            except self.refusals:
                pass  # it has arrived
            del self._paced[name]
