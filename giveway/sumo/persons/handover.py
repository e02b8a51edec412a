"""The handover of a walking person: SUMO lets go of it, and walks it on again later.

``person.moveTo`` ends a ``moveToXY``: the person walks on in SUMO from the lane position given,
with its id, type, parameters and remaining stages. It takes effect at once. What SUMO 1.28 gets
wrong, found by experiment and in its sources:

* a person moved as a ghost stays in the books of the lane where it was: SUMO's pedestrians walk
  round that spot and vehicles wait for ever at a crossing that it has long left. Far outside of
  the lane it stands in nobody's way;
* a person taken over inside a junction keeps that inner edge in its books, from which moveTo
  derives a wrong walking direction: it would leave the network, and the simulation end with
  "Disconnected walk". A fresh walk has clean books;
* on the last edge the direction is the one from the former position to the new one, so that a
  person put before its destination must come from the right side: else it arrives at once;
* a fresh walk is as fast as the person likes, whatever speed the scenario gave to the former one.
"""

from dataclasses import dataclass
from typing import Any

from giveway.sumo.network.footpaths import Foot

_WALKING = 2  # SUMO's stage type
NOWHERE = -1000.0  # [m] position on its lane of a held person in SUMO's books
_RUN_UP = 0.5  # [m] distance before its place at which a person is put on its last edge


@dataclass(frozen=True, slots=True)
class Route:
    """The remembered route of a held person: the rest of its present walk in SUMO."""

    edges: tuple[str, ...]  # remaining, the current one first
    arrival_position: float  # [m] arrival position on the last edge
    stages_left: int  # number of stages after this route
    type: str
    own_speed: float | None  # [m/s] speed that the scenario gives to this walk alone
    was_inside: bool  # taken over inside a junction


class Handover:
    """Moves persons in SUMO's books.

    All methods may raise one of ``refusals``.

    Args:
        sumo: The libsumo module.

    Attributes:
        refusals: The exceptions that SUMO's refusals become.
    """

    refusals: tuple[type[Exception], ...]

    def __init__(self, sumo: Any) -> None:
        self._simulation = sumo.simulation
        self._person = sumo.person
        self._paced: dict[str, tuple[float, int]] = {}  # usual speed factor, until when
        self.refusals = (sumo.TraCIException, sumo.FatalTraCIError)  # neither is the other's base

    def park(self, name: str, lane: str) -> None:
        """Put a person where it stands in nobody's way, in the books of a lane of its route."""
        self._person.moveTo(name, lane, NOWHERE)

    def walk_on(self, name: str, route: Route, step: int, foot: Foot) -> None:
        """Let a person walk on from ``foot``, which lies on edge ``step`` of its route."""
        edges = route.edges[step:]
        if len(edges) == 1:
            self._approach(name, route, foot)
            return
        present = tuple(self._person.getStage(name).edges)
        rerouted = present[-len(route.edges) :] != route.edges  # by a device of SUMO
        if rerouted or route.was_inside or edges[0] in edges[1:] + route.edges[:step]:
            self._restart(name, route, edges)
        self._person.moveTo(name, foot.lane, foot.position, foot.lateral)

    def walk_anew(self, name: str, route: Route, edge: str, foot: Foot) -> bool:
        """Let a person walk from ``foot`` on any ``edge`` to the end of its route.

        It takes the route that SUMO finds fastest; False if SUMO finds none.
        """
        found = self._simulation.findIntermodalRoute(
            edge,
            route.edges[-1],
            departPos=foot.position,
            arrivalPos=route.arrival_position,
            pType=route.type,
        )
        if len(found) != 1 or found[0].type != _WALKING or not found[0].edges:
            return False
        if len(found[0].edges) == 1:
            self._approach(name, route, foot)
        else:
            self._restart(name, route, tuple(found[0].edges))
            self._person.moveTo(name, foot.lane, foot.position, foot.lateral)
        return True

    def finish(self, name: str, lane: str, route: Route) -> None:
        """Put a person on the end of its route, so that SUMO's next step ends its walk."""
        self._person.moveTo(name, lane, route.arrival_position)

    def _approach(self, name: str, route: Route, foot: Foot) -> None:
        """Put a person on the last edge of its route, facing the end."""
        last = route.edges[-1:]
        ahead = route.arrival_position >= foot.position
        behind = foot.position - _RUN_UP if ahead else foot.position + _RUN_UP
        if route.was_inside or len(route.edges) > 1:
            self._restart(name, route, last)
        self._person.moveTo(name, foot.lane, max(behind, 0.0))
        self._restart(name, route, last)  # departs there, since it is on this edge already
        self._person.moveTo(name, foot.lane, foot.position, foot.lateral)

    def _restart(self, name: str, route: Route, edges: tuple[str, ...]) -> None:
        """Replace the person's walk in SUMO by a fresh one along ``edges`` to the same end."""
        person = self._person
        stage = person.getStage(name)
        stage.edges = edges
        person.replaceStage(name, 0, stage)
        if route.own_speed is not None:
            self._set_pace(name, route.own_speed, route.stages_left)

    def _set_pace(self, name: str, speed: float, stages_left: int) -> None:
        """Set a person's desired speed [m/s] until ``stages_left`` stages are left."""
        person = self._person
        factor = person.getSpeedFactor(name)
        own_factor, _ = self._paced.get(name, (factor, 0))
        person.setSpeedFactor(name, factor * speed / person.getMaxSpeed(name))
        self._paced[name] = own_factor, stages_left

    def end_paces(self) -> None:
        """Restore the usual speed of persons whose walk with its own speed has ended."""
        for name, (factor, stages_left) in list(self._paced.items()):
            try:
                if self._person.getRemainingStages(name) > stages_left:
                    continue
                self._person.setSpeedFactor(name, factor)
            except self.refusals:
                pass  # it has arrived
            del self._paced[name]
