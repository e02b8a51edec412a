"""The target of each pedestrian: the next way-point, or the nearest point of its line."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined
from pedestrian_model.routes import Routes, heading_for
from pedestrian_model.vci.buffers import PX, PY, SOFT, TX, TY, V0

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
