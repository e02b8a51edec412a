"""The places where other lanes join a route's lanes: lane changes and zippers.

At neither of them does a sign give priority. At a zipper (link state ``Z``) two lanes become one
and vehicles go in turn. A vehicle that changes lanes joins the vehicles on the other lane.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from giveway.geometry.kernel import Array
from giveway.sumo.network.internal_lanes import lanes_inside

_ZIPPER = "Z"  # SUMO's state of a link at which lanes join in turn
_NARROW = 30.0  # Distance [m] before the junction at which two roads may be close


class Merging(NamedTuple):
    """A place at which a route and other vehicles come onto one lane."""

    lane: str  # the shared lane
    origin: float  # [m] station at which that lane begins
    begin: float  # [m] station before which the paths are apart
    end: float  # [m] station beyond which they are one, or apart again
    lines: tuple[Array, ...]  # (k, 2) [m] each: centre lines along which the others come
    over: frozenset[str]  # lanes before the shared one from which they come; empty if from any


def mergings(
    sumo: Any,
    lanes: Sequence[tuple[str, str]],
    begins: Sequence[float],
    shape: Callable[[str], Array],
) -> tuple[Merging, ...]:
    """Return the places along a route at which it shares a lane with others.

    Args:
        sumo: The libsumo module.
        lanes: Lanes on which the route enters and leaves each of its edges.
        begins: Station [m] at which each edge begins.
        shape: Function that returns the centre line of a lane.
    """
    found: list[Merging] = []
    ends = [*begins[1:], float("inf")]
    for number, (entry, leave) in enumerate(lanes):
        origin, end = begins[number], ends[number]
        edge, _, first = entry.rpartition("_")
        last = int(leave.rpartition("_")[2])
        step = 1 if last > int(first) else -1
        for index in range(int(first) + step, last + step, step) if entry != leave else ():
            lane = f"{edge}_{index}"
            found.append(Merging(lane, origin, origin, end, (shape(lane),), frozenset()))
        if number + 1 < len(lanes):
            found += _zipper(sumo, leave, lanes[number + 1][0], end, shape)
    return tuple(found)


def _zipper(
    sumo: Any, lane: str, target: str, origin: float, shape: Callable[[str], Array]
) -> list[Merging]:
    """Return the zipper at which ``lane`` joins ``target``, which begins at ``origin`` [m]."""
    states = [link[5] for link in sumo.lane.getLinks(lane) if link[0] == target]
    if _ZIPPER not in states:
        return []
    junction = sumo.edge.getFromJunction(sumo.lane.getEdgeID(target))
    lines, over = [], []
    longest = 0.0
    for edge in sumo.junction.getIncomingEdges(junction):
        for index in range(sumo.edge.getLaneNumber(edge)):
            other = f"{edge}_{index}"
            for link in sumo.lane.getLinks(other):
                if link[0] != target or link[5] != _ZIPPER:
                    continue
                longest = max(longest, link[7])
                if other != lane:
                    via = lanes_inside(sumo, link[4])
                    lines += [shape(name) for name in (other, *via)]
                    over.append(via[-1] if via else other)
    if not over:
        return []
    begin = origin - longest - _NARROW
    return [Merging(target, origin, begin, origin, tuple(lines), frozenset(over))]
