"""The scene that a run keeps for replays: the outlines near its road users, and all bodies."""

from itertools import chain

import numpy as np

from giveway.geometry.kernel import Array
from giveway.results.run_tables import RunTables
from giveway.run_data.scene import Scene

_AROUND = 60.0  # Distance [m] beyond the places of road users up to which the road is kept
_DECIMALS = 2  # Decimals of lengths [m]: centimetres


def scene_of(result: RunTables) -> Scene:
    """Return the part of a run's surroundings that a replay shows."""
    background = result.background_track
    _, first = np.unique(background.id, return_index=True)
    bodies = {
        str(background.id[i]): (float(background.length[i]), float(background.width[i]))
        for i in first
    }
    bodies |= {ego.id: (ego.shape.length, ego.shape.width) for ego in result.egos}
    low, high = _extent(result)
    near = [
        outline
        for outline in result.road
        if (outline.max(axis=0) >= low).all() and (outline.min(axis=0) <= high).all()
    ]
    ways = tuple(ego.law.way for ego in result.egos if ego.law is not None)
    road = tuple(tuple((x, y) for x, y in _rounded(outline)) for outline in near)
    marks = result.marks.within((low[0], low[1]), (high[0], high[1]))
    return Scene(road, bodies, ways, marks, result.opaque)


def _rounded(outline: Array) -> list[list[float]]:
    points: list[list[float]] = (np.round(outline, _DECIMALS) + 0.0).tolist()
    return points


def _extent(result: RunTables) -> tuple[Array, Array]:
    """Return the corners of the area in which road users were, with some room around it."""
    tracks = [(ego.track.front_x, ego.track.front_y) for ego in result.egos]
    tracks += [(result.background_track.x, result.background_track.y)]
    people = ((part.x, part.y) for part in result.crowd_track.pieces())
    corners = [(x.min(), y.min(), x.max(), y.max()) for x, y in chain(tracks, people) if x.size]
    if not corners:
        return np.full(2, -np.inf), np.full(2, np.inf)
    low, high = np.min(corners, axis=0)[:2], np.max(corners, axis=0)[2:]
    return low - _AROUND, high + _AROUND
