"""The lanes inside junctions, which SUMO puts between those of the edges."""

from typing import Any


def lanes_inside(sumo: Any, lane: str) -> tuple[str, ...]:
    """The lanes inside a junction from ``lane`` on, as SUMO's vehicles go on.

    Args:
        sumo: the libsumo module, while a simulation runs.
        lane: the first of them; empty where the network has none.
    """
    lanes: list[str] = []
    while lane and lane not in lanes:
        lanes.append(lane)
        onwards = sumo.lane.getLinks(lane)
        lane = onwards[0][4] if onwards else ""
    return tuple(lanes)
