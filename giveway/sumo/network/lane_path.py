"""The path along the lanes of a route: its centre line, and what lies on it."""

from dataclasses import dataclass
from typing import NamedTuple

from giveway.geometry.kernel import Array
from giveway.sumo.network.heights import Height


class Light(NamedTuple):
    """The traffic light at the end of a lane, for vehicles that go on to the path's next lane."""

    station: float  # [m] station of the stop line along the lane path
    system: str  # SUMO's id of the traffic light
    link: int  # index of the movement in the system's state


class Passage(NamedTuple):
    """The part of a lane path inside a junction."""

    entry: float  # [m] station of the line before it
    exit: float  # [m] station of the next edge's lane
    inside: tuple[str, ...]  # lanes in between
    waiting: tuple[float, ...]  # [m] stations inside at which SUMO's vehicles wait for others

    def shifted(self, by: float) -> "Passage":
        """The same passage of a path that begins ``by`` [m] earlier."""
        waiting = tuple(station + by for station in self.waiting)
        return self._replace(entry=self.entry + by, exit=self.exit + by, waiting=waiting)


class SpeedLimit(NamedTuple):
    """A station of a lane path from which another lane's limit holds."""

    station: float  # [m] along the lane path
    speed: float  # [m/s]


@dataclass(frozen=True)
class LanePath:
    """The path along a route: the lanes' centre line, the traffic lights and limits on it."""

    points: Array  # (k, 2) [m]
    lights: tuple[Light, ...]
    first: str  # the lane that it begins on
    edges: tuple[float, ...]  # station [m] at which each edge of the route begins
    limits: tuple[SpeedLimit, ...]  # limits of the lanes in order; the first holds from the start
    passages: tuple[Passage, ...]  # through junctions whose lanes inside the network has
    lanes: tuple[tuple[str, str], ...]  # lanes on which it enters and leaves each edge
    heights: tuple[Height, ...] = ()  # heights of the lanes' vertices, in order
