"""The places at which SUMO would have persons who are handed back, and whether it moves them there.

SUMO puts people onto the usable part of a footpath. It may turn them round where both ends of an
edge touch the next one, and it throws them over junctions whose footpaths are not joined.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from giveway.sumo.network.footpaths import Foot, FootPaths
from giveway.sumo.persons.handover import Handover, Route

JUMP = 0.8  # largest distance [m] by which SUMO may move a person who is handed back
_LAST = 10.0  # distance [m] before a gap in the network from which on nobody is handed back


class Return(NamedTuple):
    """The place at which SUMO gets a person back, and the walk from there."""

    edges: tuple[str, ...]
    foot: Foot
    step: int | None  # index of its edge in the person's route; None for another route


class ReturnPlaces:
    """Finds where persons can be handed back.

    Args:
        paths: Lanes that people walk on.
        handover: Handover, which finds new routes.
    """

    def __init__(self, paths: FootPaths, handover: Handover) -> None:
        self._paths = paths
        self._handover = handover
        self._before_gap: dict[str, str] = {}  # edges before whose end persons must stay held

    def find(
        self,
        name: str,
        route: Route,
        place: tuple[float, float],
        edge: str,
        way: tuple[float, float] | None,
    ) -> Return | None:
        """Return where a person can be handed back, or None if SUMO would throw or turn it.

        Args:
            name: Id of the person.
            route: Rest of its walk.
            place: Position x, y [m].
            edge: Nearest edge for pedestrians, which is used if the route is too far away.
            way: Displacement x, y [m] to where it is going now; None if unknown.
        """
        feet = [(k, self._paths.foot(e, *place)) for k, e in enumerate(route.edges)]
        step, own = min(feet, key=lambda found: found[1].distance if found[1] else math.inf)
        if own is not None and own.apart <= JUMP:
            found = Return(route.edges[step:], own, step)
        else:
            foot = self._paths.foot(edge, *place)
            if foot is None or foot.apart > JUMP or self._before_gap.get(name) == edge:
                return None
            found = Return(self._handover.way_anew(route, edge, foot), foot, None)
        if not found.edges or self._before_gap.get(name) == found.edges[0]:
            return None
        return found if self._keeps_direction(found.edges, found.foot, way) else None

    def _keeps_direction(
        self, edges: Sequence[str], foot: Foot, way: tuple[float, float] | None
    ) -> bool:
        """Return whether SUMO would let a person walk on as it goes, towards the second edge."""
        if len(edges) < 2 or self._paths.forward(*edges[:2]) is not None:
            return True  # only one direction leads there
        return way is not None and self._paths.along(edges[0], foot.position, way) > 0.0

    def is_before_gap(self, name: str, place: Return, following: str) -> bool:
        """Return whether SUMO will soon throw a person over a gap, and remember it.

        Args:
            name: Id of the person.
            place: Place at which SUMO has got it.
            following: Edge onto which SUMO lets it walk next; empty if there is none.
        """
        edge = place.edges[0]
        onwards = place.edges[1:2]
        if following.startswith(":") and not all(self._paths.joins(following, e) for e in onwards):
            self._before_gap[name] = edge  # SUMO would end with "Disconnected walk"
            return True
        if not following or following.startswith(":") or self._paths.gap(edge, following) < JUMP:
            return False
        own, others = self._paths.junctions(edge), self._paths.junctions(following)
        shared = [end for end in own if end in others] or own  # SUMO throws over junctions, too
        ends = (self._paths.end_at(edge, end) for end in shared)
        if any(end is not None and abs(end - place.foot.position) < _LAST for end in ends):
            self._before_gap[name] = edge
            return True
        return False

    def forget(self, name: str) -> None:
        """Forget a person who is held no more."""
        self._before_gap.pop(name, None)
