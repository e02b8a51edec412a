"""The pedestrian crossings of the loaded network: their places, and who has priority there.

For each link that leads people onto a crossing, a network says whether they have priority (state
``M``, a zebra crossing) or have to wait for a gap (``m``). If a traffic light governs the link, the
light's present letter says so. The network does not keep the ``priority`` that netconvert was
given.
"""

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from giveway.geometry.kernel import Array
from giveway.walkways.beside_lanes import part_beside

_LANE = re.compile(r"^(:.*)_c\d+_0$")  # lane ids of crossings in SUMO
_TURN = re.compile(r"^(:.*)_\d+_\d+$")  # lane ids of vehicles' lanes in junctions
_PRIORITY = "MOo"  # states of the link; at a light that is off, people have priority as at a zebra


class Crossing(NamedTuple):
    """A crossing, from kerb to kerb."""

    lane: str  # SUMO's id of the crossing's lane
    ends: Array  # (2, 2) [m] middle of each kerb, of the part that no lane runs along
    width: float  # [m] width of this part
    zebra: bool  # True if people have priority where no light says otherwise
    system: str  # SUMO's id of the traffic light; empty without one
    link: int  # index of the movement in the light's state


def crossings(
    sumo: Any, movements: Mapping[tuple[str, str], tuple[str, int]]
) -> tuple[Crossing, ...]:
    """Return all crossings of the network.

    Args:
        sumo: The libsumo module, while a simulation runs.
        movements: Traffic light of each link from lane to lane that has one: the light's id and the
            index of the movement in its state.
    """
    lanes = sumo.lane.getIDList()
    found = {lane: match[1] for lane in lanes if (match := _LANE.match(lane))}
    if not found:
        return ()
    states: dict[str, str] = {}
    inside: dict[str, list[Array]] = {junction: [] for junction in found.values()}
    for lane in lanes:
        junction, mark, _ = lane.rpartition("_w")
        if mark and junction in inside:
            states |= {link[0]: link[5] for link in sumo.lane.getLinks(lane) if link[0] in found}
        elif (turn := _TURN.match(lane)) and turn[1] in inside:
            inside[turn[1]].append(np.array(sumo.lane.getShape(lane)))
    lights = {target: light for (_, target), light in movements.items() if target in found}
    parts = {}
    for lane, junction in found.items():
        shape, width = np.array(sumo.lane.getShape(lane)), float(sumo.lane.getWidth(lane))
        if len(shape) == 2:
            parts[lane] = part_beside(shape, width, inside[junction])
        elif len(shape) > 2:
            parts[lane] = shape[[0, -1]], width
    return tuple(
        Crossing(
            lane,
            *part,
            lane in lights or states.get(lane, "m") in _PRIORITY,
            *lights.get(lane, ("", -1)),
        )
        for lane, part in parts.items()
    )
