"""The junctions of the loaded network: the movements through them, and their priorities."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

from giveway.scenario_files.right_of_way import JunctionLogic, right_of_way
from giveway.sumo.network.internal_lanes import lanes_inside
from giveway.sumo.network.lanes import Lanes
from giveway.sumo.network.pedestrian_crossings import Crossing


@dataclass(frozen=True, slots=True)
class Movement:
    """A link through a junction, from one lane to another."""

    junction: str  # SUMO's id of the junction
    number: int  # index of the link in the junction
    source: str  # lane before the junction
    target: str  # lane behind the junction
    inside: tuple[str, ...]  # lanes in between, in order; a vehicle may wait at the end of one
    state: str  # SUMO's letter for the link without a traffic light
    direction: str  # SUMO's letter: "s" straight on, "l", "L" left, "r", "R" right, "t" turn
    speed: float  # [m/s] speed limit of the lanes inside
    system: str  # SUMO's id of the traffic light; empty without one
    link: int  # index of the movement in the light's state
    yields_to: frozenset[int]  # numbers of links whose vehicles go first
    meets: frozenset[int]  # numbers of links whose paths cross or join this one

    @property
    def has_stop_sign(self) -> bool:
        """True if a vehicle has to stop before the link, and no light governs it."""
        return self.state in ("s", "w") and not self.system


class Junctions:
    """Reads the movements through junctions, each junction once.

    Args:
        sumo: The libsumo module, while a simulation runs.
        net_file: File of the network.
        lanes: Lanes of the network.

    Attributes:
        of: Function that returns all movements of vehicles through a junction, by number. It raises
            ``ScenarioError`` if the network's file cannot be read.
    """

    def __init__(self, sumo: Any, net_file: Path, lanes: Lanes) -> None:
        self._sumo = sumo
        self._net_file = net_file
        self._lanes = lanes
        self.of = cache(self._movements)

    def at(self, inside: str) -> dict[int, Movement]:
        """Return the movements of the junction in which a link ends with the lane ``inside``."""
        return self.of(self._junctions.get(inside, ""))

    def beside(self, crossings: Iterable[Crossing]) -> list[Movement]:
        """Return the movements through the junctions of crossings."""
        junctions = {self._junctions.get(crossing.lane, ""): None for crossing in crossings}
        return [movement for name in junctions for movement in self.of(name).values()]

    def yielding_to(self, crossing: str) -> frozenset[str]:
        """Return the lanes inside a junction whose vehicles give way to people on a crossing.

        Args:
            crossing: Lane of the crossing.
        """
        logic = self._logic.get(self._junctions.get(crossing, ""))
        if logic is None or crossing not in logic.inside[: len(logic.requests)]:
            return frozenset()
        request = logic.requests[logic.inside.index(crossing)]
        return frozenset(logic.inside[number] for number in request.meets - request.yields_to)

    @cached_property
    def _logic(self) -> dict[str, JunctionLogic]:
        return right_of_way(self._net_file)

    @cached_property
    def _junctions(self) -> dict[str, str]:
        """Return the junction of each lane that ends a link inside one."""
        return {lane: name for name, logic in self._logic.items() for lane in logic.inside}

    def _movements(self, junction: str) -> dict[int, Movement]:
        logic = self._logic.get(junction)
        if logic is None:
            return {}
        numbers = {lane: i for i, lane in enumerate(logic.inside[: len(logic.requests)])}
        found: dict[int, Movement] = {}
        for source in logic.incoming:
            if source.startswith(":"):
                continue  # a link for people
            for link in self._sumo.lane.getLinks(source):
                inside = lanes_inside(self._sumo, link[4])
                number = numbers.get(inside[-1]) if inside else None
                if number is not None:
                    found[number] = Movement(
                        junction,
                        number,
                        source,
                        link[0],
                        inside,
                        link[5],
                        link[6],
                        min(map(self._lanes.speed_limit, inside)),
                        *self._lanes.signals.get((source, link[0]), ("", -1)),
                        *logic.requests[number],
                    )
        return found
