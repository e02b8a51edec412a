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

_LANE = re.compile(r"^(:.*)_c\d+_0$")  # lane ids of crossings in SUMO
_PRIORITY = "MOo"  # states of the link; at a light that is off, people have priority as at a zebra


class Crossing(NamedTuple):
    """A crossing, from kerb to kerb."""

    lane: str  # SUMO's id of the crossing's lane
    ends: Array  # (2, 2) [m] middle of each kerb
    width: float  # [m]
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
    junctions = set(found.values())
    states: dict[str, str] = {}
    for lane in lanes:
        junction, mark, _ = lane.rpartition("_w")
        if mark and junction in junctions:
            states |= {link[0]: link[5] for link in sumo.lane.getLinks(lane) if link[0] in found}
    lights = {target: light for (_, target), light in movements.items() if target in found}
    return tuple(
        Crossing(
            lane,
            np.array([shape[0], shape[-1]], dtype=np.float64),
            float(sumo.lane.getWidth(lane)),
            lane in lights or states.get(lane, "m") in _PRIORITY,
            *lights.get(lane, ("", -1)),
        )
        for lane in found
        if len(shape := sumo.lane.getShape(lane)) > 1
    )
