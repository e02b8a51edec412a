"""The target of each pedestrian: the next way-point, or the nearest point of its line."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined
from pedestrian_model.routes import Routes, heading_for
from pedestrian_model.vci.buffers import PX, PY, SOFT, TX, TY, V0

# [m^2] instead of s_des^2 towards a way-point at which nobody stops: 1 um, against 0/0 only
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
    """Pass the way-points reached (not the last, none that is closed); targets into the rows.

    Row k is that of pedestrian ``order[k]``; further rows stay as they are.

    The destination force fades towards a way-point at which somebody stops: the last, or one
    whose signal is closed. Towards all others people walk at their desired speed (ours: with the
    fading everywhere, way-points 2 m apart cost a quarter of it, 5 m apart an eighth).
    """
    start = routes.start
    for k in range(order.shape[0]):
        i = order[k]
        at, stops, to_x, to_y = heading_for(
            rows[PX, k],
            rows[PY, k],
            start[i] + waypoint_index[i],
            start[i + 1] - 1,
            routes,
            closed,
            (c.r_waypoint, c.R),
        )
        waypoint_index[i] = at - start[i]
        rows[TX, k], rows[TY, k] = to_x, to_y
        rows[V0, k] = desired_speed[i]
        rows[SOFT, k] = c.s_des_2 if stops else _NO_SLOWING
