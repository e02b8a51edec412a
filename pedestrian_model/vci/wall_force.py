"""The force of the nearest wall on each pedestrian, and the largest force that moves anybody."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined
from pedestrian_model._mathematics import exponential
from pedestrian_model.parameters import HELD
from pedestrian_model.routes import OFF_WALKWAYS, Routes
from pedestrian_model.vci.buffers import MOST, PX, PY, WS, WX, WY
from pedestrian_model.walls import DEPTH, REACH, find_walls

_LEAST_EXPONENT = -700.0  # least exponent without underflow


@inlined
def add_walls(
    rows: NDArray[np.float64],
    n: int,
    row_x: int,
    row_y: int,
    walls: tuple[NDArray[np.float64], NDArray[np.int64]],
    ways: tuple[NDArray[np.int64], NDArray[np.int64], Routes],
    c: Any,
) -> None:
    """Add the force f_w of the nearest wall to ``row_x`` and ``row_y`` of the first n pedestrians.

    The largest total force is m a_max. A wall raises it to its own force, up to 5 m/s^2: nobody
    walks through a wall because of hardly accelerating of oneself.

    f_w = (A_w exp(-b_w (s - R)) + k_col max(0, R - s)) n, as by Helbing, Farkas & Vicsek (Nature
    2000), without friction. The exponent is capped as that of f_v. Behind the wall, down to
    ``DEPTH``, only the second term acts. It is 0 for people on their way off the walkways.

    Args:
        rows: Rows of the crowd.
        n: Number of people.
        row_x: Row of the force along x [N].
        row_y: Row of the force along y [N].
        walls: Lines and cells of ``Walls``.
        ways: Person of each column, next way-point of each person, and routes.
        c: Constants.
    """
    (lines, cells), (who, index, routes) = walls, ways
    most, top = rows[MOST], c.m * c.a_max
    for k in range(n):
        most[k] = top
    if lines.shape[0] == 1:
        return
    distance, n_x, n_y = rows[WS], rows[WX], rows[WY]
    find_walls(rows[PX], rows[PY], n, lines, cells, (distance, n_x, n_y))
    R, A_w, b_w, k_col, cap = c.R, c.A_w, c.b_w, c.k_col, c.cap
    f_x, f_y = rows[row_x], rows[row_y]
    for k in range(n):
        s = distance[k]
        near = A_w * exponential(max(min(-b_w * (s - R), cap), _LEAST_EXPONENT))
        f = (near if s >= 0.0 else 0.0) + k_col * max(0.0, R - s)
        on = routes.signal[routes.start[who[k]] + index[who[k]]] != OFF_WALKWAYS
        f = f if on and -DEPTH <= s <= REACH else 0.0
        most[k] = max(top, min(f, c.m * HELD))
        f_x[k] += f * n_x[k]
        f_y[k] += f * n_y[k]
