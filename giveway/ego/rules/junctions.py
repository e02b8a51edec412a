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
SIGHT = 60.0  # distance [m] before a junction from which on others are looked at
_ASIDE = 0.3  # [m] between bodies that just do not touch
_ONWARDS = 10.0  # [m] behind a junction, where ways that join are one
_JOINED = 2.0  # [m] after which a vehicle that joins a way is its next one's leader


class PathJunction(NamedTuple):
    """A junction that a path leads through; all stations are the path's."""

    entry: float  # [m] of the line before it
    exit: float  # [m] where the next edge's lane begins
    waiting: tuple[float, ...]  # [m] inside, where one may wait for others to pass
    movement: Movement  # the path's own
    movements: Mapping[int, Movement]  # of everybody, by number
    conflicts: Mapping[int, Conflict]  # with the path; the others' stations count from their lines
    beside: frozenset[int]  # movements of other lanes that come nowhere near the path
    gap: Gap  # that its driver wants where no light shows green
    gap_at_lights: Gap


class Approach(NamedTuple):
    """A vehicle on its way through a junction."""

    name: str
    number: int  # of its movement
    distance: float  # [m] of its front from its line; negative: inside the junction
    speed: float  # [m/s]
    length: float  # [m]
    standing: float  # [s] for which it has stood


Traffic = Mapping[str, Sequence[Approach]]
"""Who approaches each junction, by its id; the nearest first, the egos among them."""


def junctions_on(
    path: EgoPath, passages: Sequence[Passage], width: float, junctions: Junctions, lanes: Lanes
) -> tuple[PathJunction, ...]:
    """The junctions on a path at which vehicles may meet, in its order.

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
                continue  # it is behind the same leader
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
                    gap_of(own, at_lights=False, major=_is_major(own, movements)),
                    gap_of(own, at_lights=True, major=False),
                )
            )
    return tuple(found)


def _on_path(where: Conflict, entry: float, joins: bool) -> Conflict:
    """A conflict in the path's stations; where two ways join, it is over once one has joined."""
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
    """(k, 2) [m] the path between two stations."""
    inside = (path.stations > start) & (path.stations < end)
    at = np.concatenate([[start], path.stations[inside], [min(end, path.length)]])
    return path.points(at)


def _way(movement: Movement, lanes: Lanes) -> Array:
    """(k, 2) [m] the way of a movement's vehicles from their line on."""
    onwards = lanes.shape(movement.target)
    along = stations_of(onwards)
    at = np.concatenate([along[along < _ONWARDS], [min(_ONWARDS, along[-1])]])
    return np.concatenate([*map(lanes.shape, movement.inside), points_at(onwards, along, at)])


def letter_of(movement: Movement, states: Mapping[str, str]) -> str:
    """The running light's letter for a movement, or the network's where no light governs it."""
    state = states.get(movement.system, "")
    return state[movement.link] if 0 <= movement.link < len(state) else movement.state
