"""The junctions on an ego's path, and the movements that cross or join it."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from giveway.ego.rules.gap_acceptance import Gap, gap_of
from giveway.geometry.bodies import BODY
from giveway.geometry.conflict import Conflict, conflict
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath, points_at, stations_of
from giveway.sumo.network.junction_links import Junctions, Movement
from giveway.sumo.network.lane_path import Passage
from giveway.sumo.network.lanes import Lanes

RED = frozenset("rRu")  # letters of a signal state: red, red with yellow
YELLOW = frozenset("yY")
SIGHT = 60.0  # sight distance [m] ahead of a junction
_ASIDE = 0.3  # lateral gap [m] between two bodies from which on their paths do not conflict
_ONWARDS = 10.0  # distance [m] behind a junction after which joining paths count as one
_JOINED = 2.0  # distance [m] after the merge point at which a joining vehicle becomes a leader


class Gaps(NamedTuple):
    """The headways that the ego accepts at a junction."""

    unsignalled: Gap  # headways without a light
    at_lights: Gap  # headways at a green or yellow light


class PathJunction(NamedTuple):
    """A junction that a path leads through. All stations are those of the path."""

    entry: float  # station [m] at which the junction begins
    exit: float  # station [m] at which the lane of the next edge begins
    waiting: tuple[float, ...]  # stations [m] inside at which a vehicle may wait for others
    movement: Movement  # movement of the path itself
    movements: Mapping[int, Movement]  # all movements of the junction, by number
    conflicts: Mapping[int, Conflict]  # conflicts with the path; other stations from their lines
    beside: frozenset[int]  # numbers of the movements that stay clear of the path
    gaps: Gaps
    offset: float = 0.0  # distance [m] of the stop line before the junction

    def line(self, front: float) -> float:
        """The station [m] before which the ego waits: the stop line, or the junction behind it."""
        return self.entry - (self.offset if front <= self.entry - self.offset else 0.0)


class Approach(NamedTuple):
    """A vehicle on its way through a junction."""

    name: str
    number: int  # number of its movement
    distance: float  # distance [m] of its front from its line; negative inside the junction
    speed: float  # speed [m/s]
    length: float  # length of its body [m]
    standing: float  # time [s] for which it has stood


Traffic = Mapping[str, Sequence[Approach]]
"""The vehicles, egos included, that approach each junction, by its id; the nearest comes first."""


def junctions_on(
    path: EgoPath, passages: Sequence[Passage], width: float, junctions: Junctions, lanes: Lanes
) -> tuple[PathJunction, ...]:
    """The junctions at which the ego may meet other vehicles, in the path's order.

    Args:
        path: Path of the ego.
        passages: Junction passages of its lane path.
        width: Width of its body [m].
        junctions: Junctions of the network.
        lanes: Lanes of the network.
    """
    found = []
    for passage in passages:
        movements = junctions.at(passage.inside[-1])
        own = next((m for m in movements.values() if m.inside == passage.inside), None)
        if own is None:
            continue
        way = _piece(path, passage.entry, passage.exit + _ONWARDS)
        apart = (width + BODY.width) / 2 + _ASIDE
        conflicts: dict[int, Conflict] = {}
        beside = set[int]()
        for number, other in sorted(movements.items()):
            if other.source == own.source:
                continue  # vehicles from the ego's own lane queue with it
            where = conflict(way, _way(other, lanes), apart)
            if where is None:
                beside.add(number)
            elif number in own.meets or number in own.yields_to:
                conflicts[number] = _on_path(where, passage.entry, own.target == other.target)
        if conflicts:
            found.append(
                PathJunction(
                    passage.entry,
                    passage.exit,
                    passage.waiting,
                    own,
                    movements,
                    conflicts,
                    frozenset(beside),
                    Gaps(
                        gap_of(own, at_lights=False, major=_is_major(own, movements)),
                        gap_of(own, at_lights=True, major=False),
                    ),
                    passage.offset,
                )
            )
    return tuple(found)


def _on_path(where: Conflict, entry: float, joins: bool) -> Conflict:
    """The conflict in the path's stations. If the paths join, it ends shortly after they do."""
    if joins:
        where = where._replace(
            leave=min(where.leave, where.enter + _ONWARDS),
            other_leave=min(where.other_leave, where.other_enter + _JOINED),
        )
    return where._replace(enter=where.enter + entry, leave=where.leave + entry)


def _is_major(own: Movement, movements: Mapping[int, Movement]) -> bool:
    """Return whether vehicles that go straight on from the same edge have priority."""
    edge = own.source.rpartition("_")[0]
    return any(
        other.direction == "s" and other.state == "M" and other.source.rpartition("_")[0] == edge
        for other in movements.values()
    )


def _piece(path: EgoPath, start: float, end: float) -> Array:
    """The points (k, 2) [m] of the path between two stations."""
    inside = (path.stations > start) & (path.stations < end)
    at = np.concatenate([[start], path.stations[inside], [min(end, path.length)]])
    return path.points(at)


def _way(movement: Movement, lanes: Lanes) -> Array:
    """The path (k, 2) [m] of a movement's vehicles from their stop line on."""
    onwards = lanes.shape(movement.target)
    along = stations_of(onwards)
    at = np.concatenate([along[along < _ONWARDS], [min(_ONWARDS, along[-1])]])
    return np.concatenate([*map(lanes.shape, movement.inside), points_at(onwards, along, at)])


def letter_of(movement: Movement, states: Mapping[str, str]) -> str:
    """The letter of the traffic light for a movement, or that of the network without a light."""
    state = states.get(movement.system, "")
    return state[movement.link] if 0 <= movement.link < len(state) else movement.state
