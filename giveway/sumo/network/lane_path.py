"""The path along the lanes of a route: its centre line, lights, limits and junctions."""

from dataclasses import dataclass
from typing import NamedTuple

from giveway.geometry.kernel import Array
from giveway.sumo.network.heights import Height


class Light(NamedTuple):
    """The traffic light at the end of a lane, for vehicles that go on to the path's next lane."""

    station: float  # [m] station of the stop line along the lane path
    system: str  # SUMO's id of the traffic light
    link: int  # index of the movement in the state of the traffic light


class Passage(NamedTuple):
    """The part of a lane path inside a junction."""

    entry: float  # [m] station of the line before the junction
    exit: float  # [m] station at which the next edge's lane begins
    inside: tuple[str, ...]  # lanes in between
    waiting: tuple[float, ...]  # [m] stations inside at which SUMO's vehicles wait for others

    def shifted(self, by: float) -> "Passage":
        """Return the same passage of a path that begins ``by`` [m] earlier."""
        waiting = tuple(station + by for station in self.waiting)
        return self._replace(entry=self.entry + by, exit=self.exit + by, waiting=waiting)


class SpeedLimit(NamedTuple):
    """A speed limit that holds from a station of a lane path on."""

    station: float  # [m] station along the lane path
    speed: float  # [m/s] limit


@dataclass(frozen=True)
class LanePath:
    """The path along a route: the lanes' centre line, the traffic lights and limits on it."""

    points: Array  # (k, 2) [m] centre line
    lights: tuple[Light, ...]
    first: str  # lane that it begins on
    edges: tuple[float, ...]  # station [m] at which each edge of the route begins
    # limits of the lanes, in order; the first one holds from the beginning
    limits: tuple[SpeedLimit, ...]
    passages: tuple[Passage, ...]  # junctions whose inner lanes are in the network
    lanes: tuple[tuple[str, str], ...]  # lanes on which the path enters and leaves each edge
    heights: tuple[Height, ...] = ()  # heights of the lanes' vertices, in order
