"""The lanes inside junctions, which SUMO puts between the lanes of the edges."""

from typing import Any


def lanes_inside(sumo: Any, lane: str) -> tuple[str, ...]:
    """Return the lanes inside a junction from ``lane`` on, in driving order.

    Args:
        sumo: The libsumo module, while a simulation runs.
        lane: First of the lanes, or an empty text if the network has none.
    """
    lanes: list[str] = []
    while lane and lane not in lanes:
        lanes.append(lane)
        onwards = sumo.lane.getLinks(lane)
        lane = onwards[0][4] if onwards else ""
    return tuple(lanes)
