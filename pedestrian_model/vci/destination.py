"""The target of each pedestrian: the next way-point, or the nearest point of its line."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined
from pedestrian_model.parameters import HELD
from pedestrian_model.routes import Routes, heading_for
from pedestrian_model.vci.buffers import MOST, PX, PY, SOFT, TX, TY, V0, VX, VY, WX, WY

# Value [m^2] that replaces s_des^2 for a way-point without a stop; it only avoids 0/0.
_NO_SLOWING = 1e-12


@inlined
def set_targets(
    rows: NDArray[np.float64],
    order: NDArray[np.int64],
    desired_speed: NDArray[np.float64],
    routes: Routes,
    waypoint_index: NDArray[np.int64],
    closed: NDArray[np.bool_],
    c: Any,
) -> None:
    """Advance ``waypoint_index`` past the way-points reached, and write the targets into the rows.

    Row k belongs to pedestrian ``order[k]``. Further rows are not changed. The last way-point is
    never passed, nor is one with a closed signal.

    The destination force fades towards a way-point at which people stop: the last one, or one with
    a closed signal. People walk to all others at their desired speed. This is giveway's own: with
    the fading everywhere, way-points at distances of 2 m would cost a quarter of the speed, and at
    distances of 5 m an eighth.

    A closed signal raises the largest total force to what stops a person at its line, up to
    ``HELD``: nobody stands on the road because of hardly accelerating of oneself.
    """
    start, most = routes.start, rows[MOST]
    for k in range(order.shape[0]):
        i = order[k]
        at, stops, to_x, to_y = heading_for(
            rows[PX, k],
            rows[PY, k],
            start[i] + waypoint_index[i],
            (start[i], start[i + 1] - 1),
            routes,
            closed,
            (c.r_waypoint, c.R),
        )
        waypoint_index[i] = at - start[i]
        rows[TX, k], rows[TY, k] = to_x, to_y
        rows[V0, k] = desired_speed[i]
        rows[SOFT, k] = c.s_des_2 if stops else _NO_SLOWING
        if stops and at < start[i + 1] - 1:  # a closed signal, and not the end of the route
            x, y = rows[PX, k] - to_x, rows[PY, k] - to_y
            v_x, v_y = rows[VX, k], rows[VY, k]
            needed = c.m * _braking(x, y, v_x, v_y, routes.passage[at])
            if needed > most[k]:  # it is held against its velocity, and no more by a wall
                most[k], speed = needed, math.sqrt(v_x * v_x + v_y * v_y)
                rows[WX, k], rows[WY, k] = -v_x / speed, -v_y / speed


@inlined
def _braking(x: float, y: float, v_x: float, v_y: float, passage: NDArray[np.float64]) -> float:
    """Return the deceleration [m/s^2] with which a person stops at a closed line.

    Args:
        x: Coordinate of the person [m], relative to the point of the line.
        y: Coordinate of the person [m], relative to the point of the line.
        v_x: Velocity of the person [m/s].
        v_y: Velocity of the person [m/s].
        passage: Passage (3,) of the way-point: its direction, half-width [m].
    """
    if passage[0] * x + passage[1] * y > 0.0:  # the line is crossed
        return HELD if passage[0] * v_x + passage[1] * v_y > 0.0 else 0.0
    nearing = -(v_x * x + v_y * y)  # speed towards the line, times the distance
    if nearing <= 0.0:
        return 0.0
    left_2 = x * x + y * y
    # v^2 / 2 d, for v = nearing / d
    return min(HELD, 0.5 * nearing * nearing / (left_2 * math.sqrt(left_2)))
