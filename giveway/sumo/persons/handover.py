"""The handover of a walking person: SUMO releases the person, and walks it on again later.

``person.moveTo`` ends a ``moveToXY``: the person walks on in SUMO from the given lane position,
with its id, type, parameters and remaining stages. It takes effect at once. These defects of SUMO
1.28 were found by experiment and in its sources:

* A person moved as a ghost stays in the records of its former lane. SUMO's pedestrians walk round
  that spot, and vehicles wait for ever at a crossing that the person has long left. Therefore the
  person's recorded place is moved far outside of the lane.
* A person taken over inside a junction keeps that inner edge in its records, from which moveTo
  derives a wrong walking direction: the person would leave the network, and the simulation would
  end with "Disconnected walk". A new walk has no such record.
* On the last edge, the walking direction is the one from the former position to the new one.
  Therefore a person put before its destination must come from the right side, or it arrives at
  once.
* Where both ends of an edge touch the following one, moveTo lets the person walk to the edge's end,
  but SUMO keeps the lane behind its beginning as the next one, onto which the person is thrown. It
  finds the right one for a person who comes from another edge.
* A new walk has the person's desired speed, although the scenario may give another speed to the
  former walk.
"""

from dataclasses import dataclass
from typing import Any

from giveway.sumo.network.footpaths import Foot, FootPaths

_WALKING = 2  # SUMO's number of the walking stage type
NOWHERE = -1000.0  # [m] position of a held person on its lane in SUMO's records
_RUN_UP = 0.5  # Distance [m] before its place at which a person is put on its last edge first


@dataclass(frozen=True, slots=True)
class Route:
    """The remembered route of a held person: the rest of its present walk in SUMO."""

    edges: tuple[str, ...]  # remaining edges, the current one first
    arrival_position: float  # [m] position on the last edge at which the walk ends
    stages_left: int  # number of stages after this route
    type: str
    own_speed: float | None  # [m/s] speed that the scenario gives to this walk alone, or None
    was_inside: bool  # True if it was taken over inside a junction
    begun_anew: bool = False  # True if SUMO's walk began on the first of these edges


class Handover:
    """Moves persons in SUMO's records of lanes and walks.

    All methods may raise one of ``refusals``.

    Args:
        sumo: The libsumo module.
        paths: Lanes that people walk on.

    Attributes:
        refusals: The exceptions that SUMO's refusals become.
        sums: Whether an output adds up the persons on edges. It leaves out those whose walk begins
            anew on the edge where they are.
    """

    refusals: tuple[type[Exception], ...]

    def __init__(self, sumo: Any, paths: FootPaths) -> None:
        self._paths = paths
        self.sums = False
        self._simulation = sumo.simulation
        self._person = sumo.person
        # usual speed factor; stages left when it applies again
        self._paced: dict[str, tuple[float, int]] = {}
        # neither is the base class of the other
        self.refusals = (sumo.TraCIException, sumo.FatalTraCIError)

    def park(self, name: str, lane: str) -> None:
        """Put a person outside of a lane of its route in SUMO's records, where nobody heeds it."""
        self._person.moveTo(name, lane, NOWHERE)

    def walk_on(self, name: str, route: Route, step: int, foot: Foot) -> None:
        """Let a person walk on from ``foot``, which lies on edge ``step`` of its route."""
        edges = route.edges[step:]
        if len(edges) == 1:
            self._approach(name, route, foot)
            return
        present = tuple(self._person.getStage(name).edges)
        # a rerouting device of SUMO has changed the route
        rerouted = present[-len(route.edges) :] != route.edges
        if rerouted or route.was_inside or edges[0] in edges[1:] + route.edges[:step]:
            self.restart(name, route, edges)
        self._put(name, edges, foot)

    def way_anew(self, route: Route, edge: str, foot: Foot) -> tuple[str, ...]:
        """Return the edges from ``foot`` on ``edge`` to a route's end, empty if there is no way.

        It is the route that SUMO finds fastest.
        """
        found = self._simulation.findIntermodalRoute(
            edge,
            route.edges[-1],
            departPos=foot.position,
            arrivalPos=route.arrival_position,
            pType=route.type,
        )
        if len(found) != 1 or found[0].type != _WALKING:
            return ()
        return tuple(found[0].edges)

    def walk_anew(self, name: str, route: Route, edges: tuple[str, ...], foot: Foot) -> None:
        """Let a person walk from ``foot`` along other ``edges`` to the end of its route."""
        if len(edges) == 1:
            self._approach(name, route, foot)
        else:
            self.restart(name, route, edges)
            self._put(name, edges, foot)

    def _put(self, name: str, edges: tuple[str, ...], foot: Foot) -> None:
        """Put a person on the first of ``edges``, facing the second."""
        self._person.moveTo(name, foot.lane, foot.position, foot.lateral)
        if self._paths.forward(*edges[:2]) is not None:
            return
        junction = self._person.getNextEdge(name)[1:].rpartition("_")[0]
        following = self._paths.lane(edges[1])
        if junction != self._paths.junctions(edges[0])[1] and following is not None:
            # outputs that add up persons on edges would count it twice, so only if needed
            self._person.moveTo(name, following, NOWHERE)
            self._person.moveTo(name, foot.lane, foot.position, foot.lateral)

    def finish(self, name: str, lane: str, route: Route) -> None:
        """Put a person on the end of its route, so that SUMO's next step ends its walk."""
        self._person.moveTo(name, lane, route.arrival_position)

    def _approach(self, name: str, route: Route, foot: Foot) -> None:
        """Put a person on the last edge of its route, facing the end."""
        last = route.edges[-1:]
        ahead = route.arrival_position >= foot.position
        behind = foot.position - _RUN_UP if ahead else foot.position + _RUN_UP
        comes_to_it = route.was_inside or len(route.edges) > 1
        if comes_to_it:
            self.restart(name, route, last)
        self._person.moveTo(name, foot.lane, max(behind, 0.0))
        if not (self.sums and (comes_to_it or route.begun_anew)):
            # the walk departs at once, since the person is on this edge already
            self.restart(name, route, last)
        self._person.moveTo(name, foot.lane, foot.position, foot.lateral)

    def restart(self, name: str, route: Route, edges: tuple[str, ...]) -> None:
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
                pass  # the person has arrived
            del self._paced[name]
