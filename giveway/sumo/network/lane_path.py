"""The path along the lanes of a route: its centre line, lights, limits and junctions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeVar

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
    offset: float = 0.0  # [m] distance of the stop line before the junction


class SpeedLimit(NamedTuple):
    """A speed limit that holds from a station of a lane path on."""

    station: float  # [m] station along the lane path
    speed: float  # [m/s] limit
    lanes: tuple[str, ...] = ()  # lanes whose limit it is


class LaneWidth(NamedTuple):
    """The width of the lane from a station of a lane path on."""

    station: float  # [m] station along the lane path
    width: float  # [m]


_Place = TypeVar("_Place", Light, SpeedLimit, LaneWidth, Height)


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
    widths: tuple[LaneWidth, ...] = ()  # widths of the lanes, in order

    def moved(self, points: Array, station: Callable[[float], float]) -> LanePath:
        """Return the same lane path along another line.

        Args:
            points: Line (k, 2) [m].
            station: Function that returns the station [m] on it of a station on this one.
        """

        def there(place: _Place) -> _Place:
            return place._replace(station=station(place.station))

        passages = (
            each._replace(
                entry=station(each.entry),
                exit=station(each.exit),
                waiting=tuple(map(station, each.waiting)),
            )
            for each in self.passages
        )
        return replace(
            self,
            points=points,
            lights=tuple(map(there, self.lights)),
            edges=tuple(map(station, self.edges)),
            limits=tuple(map(there, self.limits)),
            passages=tuple(passages),
            heights=tuple(map(there, self.heights)),
            widths=tuple(map(there, self.widths)),
        )
