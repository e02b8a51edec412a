"""The force of the nearest wall on each pedestrian, and the largest force that moves anybody."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined
from pedestrian_model._mathematics import exponential
from pedestrian_model.parameters import HELD
from pedestrian_model.vci.buffers import MOST, PX, PY, WS, WX, WY
from pedestrian_model.walls import DEPTH, REACH, find_walls

_LEAST_EXPONENT = -700.0  # least exponent without underflow


@inlined
def add_walls(
    rows: NDArray[np.float64],
    n: int,
    row_x: int,
    row_y: int,
    walls: NDArray[np.float64],
    cells: NDArray[np.int64],
    c: Any,
) -> None:
    """Add the force f_w of the nearest wall to ``row_x`` and ``row_y`` of the first n pedestrians.

    The largest total force is m a_max. A wall raises it to its own force, up to 5 m/s^2: nobody
    walks through a wall because of hardly accelerating of oneself.

    f_w = (A_w exp(-b_w (s - R)) + k_col max(0, R - s)) n, as by Helbing, Farkas & Vicsek (Nature
    2000), without friction. The exponent is capped as that of f_v. Behind the wall, down to
    ``DEPTH``, only the second term acts.
    """
    most, top = rows[MOST], c.m * c.a_max
    for k in range(n):
        most[k] = top
    if walls.shape[0] == 1:
        return
    distance, n_x, n_y = rows[WS], rows[WX], rows[WY]
    find_walls(rows[PX], rows[PY], n, walls, cells, (distance, n_x, n_y))
    R, A_w, b_w, k_col, cap = c.R, c.A_w, c.b_w, c.k_col, c.cap
    f_x, f_y = rows[row_x], rows[row_y]
    for k in range(n):
        s = distance[k]
        near = A_w * exponential(max(min(-b_w * (s - R), cap), _LEAST_EXPONENT))
        f = (near if s >= 0.0 else 0.0) + k_col * max(0.0, R - s)
        f = f if -DEPTH <= s <= REACH else 0.0
        most[k] = max(top, min(f, c.m * HELD))
        f_x[k] += f * n_x[k]
        f_y[k] += f * n_y[k]
