"""The files of a SUMO scenario whose only road is a given path."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

DRIVE, GATE = "drive", "gate"
"""Ids of the edge along the path, and of the edge at which SUMO registers people."""
_WIDTH = 3.2  # Width [m] of the lane along the path
_AWAY = 12.0  # Distance [m] of the gate below the path's lowest point
_GATE = 20.0  # Length [m] of the gate
_NET = """<?xml version="1.0" encoding="UTF-8"?>

<net version="1.20" junctionCornerDetail="5" limitTurnSpeed="5.50">

    <location netOffset="0.00,0.00" convBoundary="{bounds}" origBoundary="{bounds}" \
projParameter="!"/>

    <edge id="gate" from="gate_west" to="gate_east" priority="-1" spreadType="center">
        <lane id="gate_0" index="0" allow="pedestrian" speed="2.78" length="{gate_length:.2f}" \
width="3.00" shape="{gate}"/>
    </edge>
    <edge id="drive" from="begin" to="end" priority="-1" spreadType="center">
        <lane id="drive_0" index="0" disallow="pedestrian" speed="{limit:.2f}" \
length="{length:.2f}" width="{width:.2f}" shape="{shape}"/>
    </edge>

    <junction id="begin" type="dead_end" {begin} incLanes="" intLanes="" shape="{begin_shape}"/>
    <junction id="end" type="dead_end" {end} incLanes="drive_0" intLanes="" shape="{end_shape}"/>
    <junction id="gate_east" type="dead_end" {gate_east} incLanes="gate_0" intLanes="" \
shape="{gate_east_shape}"/>
    <junction id="gate_west" type="dead_end" {gate_west} incLanes="" intLanes="" \
shape="{gate_west_shape}"/>

</net>
"""


def network_along(path: Array, limit: float) -> str:
    """Return the text of a network with one lane along a path, and one for people beside it.

    Args:
        path: Points (k, 2) [m] of the lane's middle.
        limit: Speed limit of the lane [m/s].
    """
    path = np.round(path, 2)
    low, high = path.min(axis=0), path.max(axis=0)
    gate = np.round(np.array([[0.0, -_AWAY], [_GATE, -_AWAY]]) + low, 2)
    first, last = path[1] - path[0], path[-1] - path[-2]
    places = {"begin": path[0], "end": path[-1], "gate_west": gate[0], "gate_east": gate[1]}
    ways = {"begin": first, "end": -last, "gate_west": gate[1] - gate[0]}
    ways["gate_east"] = -ways["gate_west"]
    junctions = {name: f'x="{x:.2f}" y="{y:.2f}"' for name, (x, y) in places.items()}
    shapes = {f"{name}_shape": _across(places[name], way) for name, way in ways.items()}
    bounds = (low[0], gate[0, 1], max(high[0], gate[1, 0]), high[1])
    return _NET.format(
        bounds=",".join(f"{number:.2f}" for number in bounds),
        gate=_points(gate),
        gate_length=_GATE,
        limit=limit,
        length=np.hypot(*np.diff(path, axis=0).T).sum(),
        width=_WIDTH,
        shape=_points(path),
        **junctions,
        **shapes,
    )


def _points(points: Array) -> str:
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in points)


def _across(place: Array, way: Array) -> str:
    """Return the line across the end of a lane, which leads away along ``way`` (2,)."""
    side = _WIDTH / 2.0 * np.array([-way[1], way[0]]) / np.hypot(*way)
    return _points(np.array([place + side, place - side]))
