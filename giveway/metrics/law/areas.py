"""The areas of crossings that the ego's body sweeps over and shares with people."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import directions, fine_near, points_at
from giveway.metrics.law.drive import Drive
from giveway.metrics.standing import runs
from giveway.run_data.way import CrossingOnWay

_STEP = 0.05  # [m] distance between two places of the body
_GRAIN = 0.25  # [m] largest distance between two points of its outline


class Area(NamedTuple):
    """The part of a crossing that the ego's body sweeps over in one visit.

    Lengths along the crossing count from its first end.
    """

    crossing: CrossingOnWay
    kerb: Array  # (2,) [m] first end
    along: Array  # (2,) unit vector to the second end
    length: float  # [m] between the ends
    entry: float  # [m] station of the front bumper at which the body reaches the crossing
    leave: float  # [m] station of the front bumper at which the body has left it
    low: float  # [m] beginning of the swept part, along the crossing
    high: float  # [m] end of that part, along the crossing

    def place(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Return the points' lengths along the crossing, and offsets from its middle line [m]."""
        d_x, d_y = x - self.kerb[0], y - self.kerb[1]
        c, s = self.along
        return d_x * c + d_y * s, d_y * c - d_x * s


def areas_of(drive: Drive) -> tuple[Area, ...]:
    """Return the areas on a drive's path, in driving order, without those beyond its end."""
    if not drive.way.crossings:
        return ()
    line = _Line(drive)
    visits = (_visits(line, drive.shape, crossing) for crossing in drive.way.crossings)
    kept = (area for areas in visits for area in areas if area.entry < drive.end)
    return tuple(sorted(kept, key=lambda area: area.entry))


class _Line:
    """The path, with straight extensions before its beginning and beyond its end.

    Args:
        drive: Drive along the path.
    """

    def __init__(self, drive: Drive) -> None:
        path, more = drive.path, drive.shape.length + 1.0
        first, last = path.headings[0], path.headings[-1]
        before = path.vertices[0] - more * np.array([np.cos(first), np.sin(first)])
        after = path.vertices[-1] + more * np.array([np.cos(last), np.sin(last)])
        self.vertices = np.concatenate([[before], path.vertices, [after]])
        self.stations = np.concatenate([[-more], path.stations, [path.length + more]])

    def at(self, station: Array) -> Array:
        """Return the points (n, 2) [m] at ``station`` (n,) [m]."""
        return points_at(self.vertices, self.stations, station)


def _visits(line: _Line, shape: VehicleShape, crossing: CrossingOnWay) -> list[Area]:
    ends = np.array(crossing.ends)
    length = float(np.hypot(*(ends[1] - ends[0])))
    if length <= 0.0:
        return []
    base = Area(crossing, ends[0], (ends[1] - ends[0]) / length, length, 0.0, 0.0, 0.0, 0.0)
    coarse = np.arange(line.stations[0] + shape.length, line.stations[-1], 1.0)
    away = np.hypot(*(line.at(coarse) - ends.mean(axis=0)).T)
    near = coarse[away <= (length + crossing.width) / 2 + shape.length + shape.width + 1.0]
    if not len(near):
        return []
    stations = fine_near(near, 1.0, near[0] - 1.0, line.stations[-1], _STEP)
    u, w = base.place(*_outline(line, shape, stations))
    inside: NDArray[np.bool_] = (u >= 0.0) & (u <= length) & (np.abs(w) <= crossing.width / 2)
    areas = []
    for begin, end in runs(np.asarray(inside.any(axis=1))):
        swept = u[begin:end][inside[begin:end]]
        entry, leave = float(stations[begin]), float(stations[end - 1])
        low, high = float(swept.min()), float(swept.max())
        areas.append(base._replace(entry=entry, leave=leave, low=low, high=high))
    return areas


def _outline(line: _Line, shape: VehicleShape, stations: Array) -> tuple[Array, Array]:
    """Return points of the body's outline x, y (n, p) [m] for each station (n,) of its front."""
    front, rear = line.at(stations), line.at(stations - shape.length)
    heading = directions(front - rear)[:, None]
    back = np.linspace(0.0, shape.length, 1 + int(np.ceil(shape.length / _GRAIN)))
    side = np.linspace(-0.5, 0.5, 1 + int(np.ceil(shape.width / _GRAIN))) * shape.width
    # the two sides from front to rear, and the front
    a = np.concatenate([-back, -back, np.zeros(len(side))])
    b = np.concatenate([np.full(len(back), side[0]), np.full(len(back), side[-1]), side])
    c, s = np.cos(heading), np.sin(heading)
    return front[:, :1] + a * c - b * s, front[:, 1:] + a * s + b * c
