"""The crossings on an ego's path, and the stretch of the path that lies on each."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.crowd.crossings import ASIDE, place_on
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath, fine_near
from giveway.sumo.network.pedestrian_crossings import Crossing

_SAMPLE, _COARSE = 0.1, 2.0  # fine and coarse spacing [m] of the sampled stations
_GRAIN = 0.5  # largest spacing [m] of the points of the outline
_BESIDE = 0.8  # distance [m] from the ego's side to the centre of a person who is not in its way


class MarkedArea(NamedTuple):
    """The rectangle of a crossing about its middle line."""

    kerb: Array  # one end (2,) [m] of the crossing's middle line
    along: Array  # unit vector (2,) from this end to the other one
    length: float  # distance [m] between the kerbs
    half_width: float  # half width [m] of the crossing, with the margin at its sides


class PathCrossing(NamedTuple):
    """A crossing that a path leads over, in the crossing's own coordinates."""

    entry: float  # station [m] of the front bumper from which on the body is on the crossing
    exit: float  # station [m] of the rear at which the body has left the crossing
    area: MarkedArea
    low: float  # distance [m] from the kerb at which a person enters the strip the ego covers
    high: float  # distance [m] from the kerb at which a person leaves this strip
    zebra: bool  # whether the crossing is a zebra
    system: str  # SUMO's id of its signal system; empty without one
    link: int  # index of its light in the system's state


def crossings_on(
    path: EgoPath, shape: VehicleShape, crossings: Sequence[Crossing]
) -> tuple[PathCrossing, ...]:
    """The crossings that a path leads over, in the path's order.

    Args:
        path: Path of the ego.
        shape: Length and width of its body [m].
        crossings: Crossings of the network.
    """
    if not crossings:
        return ()
    found: list[PathCrossing] = []
    coarse = np.arange(0.0, path.length, _COARSE)
    middles = _points(path, coarse)
    for crossing in crossings:
        kerb, other = crossing.ends
        length = float(np.hypot(*(other - kerb)))
        if length <= 0.0:
            continue
        away = np.hypot(*(middles - crossing.ends.mean(axis=0)).T)
        reach = (length + crossing.width) / 2 + shape.length + shape.width + _COARSE
        near = coarse[away <= reach]
        if not len(near):
            continue
        along = (other - kerb) / length
        stations = fine_near(near, _COARSE, near[0], path.length, _SAMPLE)
        outline = _outlines(path, shape, stations)
        u, w = place_on(outline.reshape(-1, 2), kerb, along)
        u, w = u.reshape(outline.shape[:2]), w.reshape(outline.shape[:2])
        inside = (u >= 0.0) & (u <= length) & (np.abs(w) <= crossing.width / 2)
        for visit in _runs(np.asarray(inside.any(axis=1))):
            swept = u[visit][inside[visit]]
            found.append(
                PathCrossing(
                    float(stations[visit[0]]),
                    float(stations[visit[-1]]) - shape.length,
                    MarkedArea(kerb, along, length, crossing.width / 2 + ASIDE),
                    float(swept.min()) - _BESIDE,
                    float(swept.max()) + _BESIDE,
                    crossing.zebra,
                    crossing.system,
                    crossing.link,
                )
            )
    return tuple(sorted(found, key=lambda place: place.entry))


def _points(path: EgoPath, stations: Array) -> Array:
    """The points (n, 2) [m] at ``stations`` (n,) [m] of a path that begins straight.

    Stations below 0 lie on the straight line that leads to its first point.
    """
    points = path.points(stations)
    heading = path.headings[0]
    points += np.outer(np.minimum(stations, 0.0), (np.cos(heading), np.sin(heading)))
    return points


def _outlines(path: EgoPath, shape: VehicleShape, stations: Array) -> Array:
    """The points (n, p, 2) [m] of the body's sides and middle line at ``stations`` (n,) [m]."""
    front, rear = _points(path, stations), _points(path, stations - shape.length)
    forward = front - rear
    forward /= np.maximum(np.hypot(forward[:, 0], forward[:, 1]), 1e-9)[:, None]
    left = np.column_stack([-forward[:, 1], forward[:, 0]])
    back = np.linspace(0.0, shape.length, max(2, math.ceil(shape.length / _GRAIN)))
    sides = [(distance, side) for distance in back for side in (-0.5, 0.0, 0.5)]
    points = [front - a * forward + side * shape.width * left for a, side in sides]
    return np.stack(points, axis=1)


def _runs(inside: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """The indices of each run of at least two successive points that are inside."""
    places = np.flatnonzero(inside)
    if not len(places):
        return []
    pieces = np.split(places, np.flatnonzero(np.diff(places) > 1) + 1)
    return [piece for piece in pieces if len(piece) > 1]
