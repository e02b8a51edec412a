"""The crossings and edges on which people walk."""

from typing import Final, NamedTuple

from giveway.geometry.kernel import Array


class Footway(NamedTuple):
    """A crossing or an edge on which people walk."""

    id: str  # SUMO's id of the crossing's lane, or of the edge
    points: Array  # (k, 2) [m] centre line
    width: float  # width [m] of a crossing; 0 for an edge
    light: bool  # whether a traffic light governs the crossing


class Footways(NamedTuple):
    """The places of a network where people walk."""

    crossings: tuple[Footway, ...] = ()
    edges: tuple[Footway, ...] = ()


NO_FOOTWAYS: Final = Footways()
"""The footways of a run that moves nobody of SUMO's people."""
