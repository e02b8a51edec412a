"""An ego's path and the rules of the road on it (crossings, lines, junctions), at its departure.

The recorder keeps one line of JSON per ego. Therefore the judgement over the tables
(:mod:`giveway.metrics.law`) needs neither SUMO nor the ego's own reading of the network.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

Point = tuple[float, float]


class CrossingOnWay(NamedTuple):
    """A pedestrian crossing on the ego's path."""

    lane: str  # SUMO's id of the crossing's lane
    ends: tuple[Point, Point]  # [m] middle of each kerb
    width: float  # [m]
    zebra: bool  # True if people have priority where no light says otherwise
    system: str  # SUMO's id of the traffic light; empty without one
    link: int  # index of the movement in the light's state


class StopLine(NamedTuple):
    """The stop line of a traffic light on the ego's path."""

    station: float  # [m] station along the path
    system: str  # SUMO's id of the traffic light
    link: int  # index of the movement in the light's state


class JunctionOnWay(NamedTuple):
    """A part of the path that crosses or joins the paths of other vehicles."""

    entry: float  # [m] station of its beginning
    exit: float  # [m] station of its end
    waiting: tuple[float, ...]  # [m] stations inside at which a front bumper may wait
    stop_sign: bool = False  # True if a vehicle has to stop before it first
    offset: float = 0.0  # [m] distance of the stop line before it


class Halt(NamedTuple):
    """A scheduled stop."""

    start: float  # [m] station from which on a halt counts
    end: float  # [m] station up to which the ego drives


class LimitOnWay(NamedTuple):
    """A speed limit that holds from a station on."""

    station: float  # [m]
    speed: float  # [m/s]


@dataclass(frozen=True)
class EgoWay:
    """An ego's path and the rules on it; stations count along ``points``.

    Attributes:
        ego: Id of the ego in SUMO.
        points: Points of the path's polyline [m].
        departure: Station [m] of the front bumper where the ego's position is 0.
        crossings: Pedestrian crossings on the path.
        lines: Stop lines of traffic lights, in order.
        junctions: Junctions, in order.
        halts: Scheduled stops, in order.
        limits: Speed limits of the lanes at the ego's departure, in order.
    """

    ego: str
    points: tuple[Point, ...]
    departure: float = 0.0
    crossings: tuple[CrossingOnWay, ...] = ()
    lines: tuple[StopLine, ...] = ()
    junctions: tuple[JunctionOnWay, ...] = ()
    halts: tuple[Halt, ...] = ()
    limits: tuple[LimitOnWay, ...] = ()

    @property
    def is_ruled(self) -> bool:
        """True if another road user has priority anywhere on the path."""
        return bool(self.crossings or self.lines or self.junctions)

    @property
    def systems(self) -> frozenset[str]:
        """The traffic lights that govern anything on the path."""
        found = [crossing.system for crossing in self.crossings]
        found += [line.system for line in self.lines]
        return frozenset(system for system in found if system)

    def as_dict(self) -> dict[str, Any]:
        """Return the path as JSON values."""
        plain = asdict(self)
        for name in ("crossings", "lines", "junctions", "halts", "limits"):
            plain[name] = [place._asdict() for place in getattr(self, name)]
        return plain

    def to_json(self) -> str:
        """Return the path as one line of JSON."""
        return json.dumps(self.as_dict(), separators=(",", ":"), ensure_ascii=False)

    @classmethod
    def from_dict(cls, kept: dict[str, Any]) -> EgoWay:
        """Return the path from the values of ``as_dict``.

        Raises:
            KeyError, TypeError, ValueError: the values are not those of a path.
        """
        return cls(
            ego=str(kept["ego"]),
            points=tuple(map(_point, kept["points"])),
            departure=float(kept["departure"]),
            crossings=tuple(
                CrossingOnWay(**place | {"ends": tuple(map(_point, place["ends"]))})
                for place in kept["crossings"]
            ),
            lines=tuple(StopLine(**place) for place in kept["lines"]),
            junctions=tuple(
                JunctionOnWay(**place | {"waiting": tuple(place["waiting"])})
                for place in kept["junctions"]
            ),
            halts=tuple(Halt(**place) for place in kept["halts"]),
            limits=tuple(LimitOnWay(**place) for place in kept.get("limits", ())),
        )


def _point(kept: Any) -> Point:
    x, y = kept
    return float(x), float(y)
