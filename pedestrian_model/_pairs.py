"""Forces between pedestrians: repulsion, collision and navigation, each pair evaluated once.

Distance, direction and the navigational force are shared by the two of a pair; only the
anisotropy of the repulsion differs. A pedestrian meets the others in *runs* of neighbours that are
contiguous in the rows. The loop over a run has no branch, no call and no reduction, so that it
becomes vector instructions under strict IEEE arithmetic.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from pedestrian_model._jit import fma, inlined
from pedestrian_model._mathematics import angle_polynomial, cosine_sine
from pedestrian_model._rows import (
    BLOCK,
    FX,
    FY,
    LANE_X,
    LANE_Y,
    PAIR_X,
    PAIR_Y,
    PX,
    PY,
    UX,
    UY,
    VX,
    VY,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_COINCIDENT_2 = 1e-6**2  # [m^2] closer centres have no direction of their own (ours)
_STANDSTILL_2 = 1e-3**2  # [m^2/s^2] slower relative motion is not navigated round (ours)


class PairConstants(NamedTuple):
    """The constants of the pair loop, held in registers: loads could alias the loop's stores."""

    two_R: float
    d_rep: float
    s_rep_2: float
    k_rep: float
    a_rep: float
    b_rep: float
    d_nav: float
    s_nav_2: float
    k_nav: float
    k_col: float
    r_max_2: float
    decay_half: float
    decay_full: float
    decay_plus: float
    decay_minus: float
    cos_pi_8: float
    sin_pi_8: float
    g: tuple[float, ...]


@inlined
def pair_constants(c: Any) -> PairConstants:
    """The constants of the pair loop out of the record of all constants."""
    g = c.g
    # fmt: off
    return PairConstants(
        c.two_R, c.d_rep, c.s_rep_2, c.k_rep, c.a_rep, c.b_rep, c.d_nav, c.s_nav_2, c.k_nav,
        c.k_col, c.r_max * c.r_max, c.decay_half, c.decay_full, c.decay_plus, c.decay_minus,
        c.cos_pi_8, c.sin_pi_8,
        (g[0], g[1], g[2], g[3], g[4], g[5], g[6], g[7], g[8], g[9], g[10],
         g[11], g[12], g[13], g[14], g[15], g[16], g[17], g[18], g[19], g[20]),
    )
    # fmt: on


@inlined
def _pair(
    dx: float,
    dy: float,
    length: float,
    d: float,
    wx: float,
    wy: float,
    c: PairConstants,
) -> tuple[float, float, float, float]:
    """What the two of a pair share, for the vector (dx, dy) of ``length`` from i to j.

    Returns:
        The repulsion without its anisotropy [N], the collision force [N], the signed navigational
        force [N] along t = (n_y, -n_x), and 1/length.

    The angle phi of Ae = exp(-l phi) is never formed: with the cross and dot products of w and n,
    phi is folded into [0, pi/4] and turned by pi/8; then exp(-l atan t) is a polynomial in
    |t| <= tan(pi/8), times a constant of the octant.
    """
    q_rep = c.d_rep - d
    f_r = c.k_rep * (q_rep + math.sqrt(fma(q_rep, q_rep, c.s_rep_2)))
    f_c = c.k_col * max(0.0, -d)
    q_nav = c.d_nav - d
    f_n = c.k_nav * (q_nav + math.sqrt(fma(q_nav, q_nav, c.s_nav_2)))
    w_2 = fma(wx, wx, wy * wy)
    moving = w_2 >= _STANDSTILL_2
    along = fma(wx, dx, wy * dy)
    across = fma(wx, dy, -(wy * dx))
    steep = abs(across) > abs(along)
    obtuse = along < 0.0
    a = min(abs(across), abs(along))
    b = max(abs(across), abs(along))
    below = fma(a, c.cos_pi_8, -(b * c.sin_pi_8))
    above = fma(b, c.cos_pi_8, a * c.sin_pi_8)
    above = above if moving else 1.0
    inverse = 1.0 / (length * above)  # one division serves both quotients
    t = below * (inverse * length)
    backwards = steep != obtuse
    t = -t if backwards else t
    decay = c.decay_half if steep else (c.decay_full if obtuse else 1.0)
    decay = decay * (c.decay_plus if backwards else c.decay_minus)
    f_n = f_n * (decay * angle_polynomial(t, c.g))
    f_n = f_n if moving else 0.0
    f_n = -f_n if across < 0.0 else f_n  # sgn(0) = +1: keep right
    return f_r, f_c, f_n, inverse * above


@inlined
def run(
    rows: NDArray[np.float64],
    order: NDArray[np.int64],
    i: int,
    start: int,
    stop: int,
    c: PairConstants,
) -> None:
    """Add the forces between row i and the rows start ... stop - 1 (all after i) to both sides."""
    count = stop - start
    end = start + (count + BLOCK - 1) // BLOCK * BLOCK
    x_i, y_i, vx_i, vy_i = rows[PX, i], rows[PY, i], rows[VX, i], rows[VY, i]
    ux_i, uy_i = rows[UX, i], rows[UY, i]
    x, y = rows[PX, start:end], rows[PY, start:end]
    vx, vy = rows[VX, start:end], rows[VY, start:end]
    ux, uy = rows[UX, start:end], rows[UY, start:end]
    fx, fy = rows[FX, start:end], rows[FY, start:end]
    pair_x, pair_y = rows[PAIR_X], rows[PAIR_Y]
    coincident = 0
    for k in range(x.size):
        dx = x[k] - x_i
        dy = y[k] - y_i
        r_2 = fma(dx, dx, dy * dy)
        r = math.sqrt(r_2)
        f_r, f_c, f_n, inverse = _pair(dx, dy, r, r - c.two_R, vx_i - vx[k], vy_i - vy[k], c)
        too_close = (r_2 < _COINCIDENT_2) & (k < count)
        counts = (r_2 <= c.r_max_2) & (r_2 >= _COINCIDENT_2) & (k < count)
        coincident += too_close
        n_x = dx * inverse if counts else 0.0
        n_y = dy * inverse if counts else 0.0
        f_n = f_n if counts else 0.0
        on_i = fma(f_r, fma(c.b_rep, fma(n_x, ux_i, n_y * uy_i), c.a_rep), f_c)
        on_j = fma(f_r, fma(-c.b_rep, fma(n_x, ux[k], n_y * uy[k]), c.a_rep), f_c)
        pair_x[k] = fma(f_n, n_y, -(on_i * n_x))
        pair_y[k] = -fma(f_n, n_x, on_i * n_y)
        fx[k] += fma(on_j, n_x, -(f_n * n_y))
        fy[k] += fma(on_j, n_y, f_n * n_x)
    _add_lanes(rows, i, (count + BLOCK - 1) // BLOCK)
    if coincident > 0:
        _add_coincident(rows, order, i, start, stop, c)


@inlined
def _add_lanes(rows: NDArray[np.float64], i: int, blocks: int) -> None:
    """Add the scratch of a run to row i's force, in one fixed order: by lanes, then pairwise."""
    pair_x, pair_y, x, y = rows[PAIR_X], rows[PAIR_Y], rows[LANE_X], rows[LANE_Y]
    for lane in range(BLOCK):
        x[lane] = 0.0
        y[lane] = 0.0
    for k in range(blocks):
        for lane in range(BLOCK):
            x[lane] += pair_x[k * BLOCK + lane]
            y[lane] += pair_y[k * BLOCK + lane]
    rows[FX, i] += ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]))
    rows[FY, i] += ((y[0] + y[4]) + (y[2] + y[6])) + ((y[1] + y[5]) + (y[3] + y[7]))


@inlined
def _add_coincident(
    rows: NDArray[np.float64],
    order: NDArray[np.int64],
    i: int,
    start: int,
    stop: int,
    c: PairConstants,
) -> None:
    """The rare pairs whose centres coincide: a fixed direction for each pair of indices."""
    for j in range(start, stop):
        dx, dy = rows[PX, j] - rows[PX, i], rows[PY, j] - rows[PY, i]
        r_2 = fma(dx, dx, dy * dy)
        if r_2 < _COINCIDENT_2:
            low, high = min(order[i], order[j]), max(order[i], order[j])
            n_x, n_y = cosine_sine(float((low * 7919 + high * 104729) % 4096))
            if order[i] > order[j]:
                n_x, n_y = -n_x, -n_y
            wx, wy = rows[VX, i] - rows[VX, j], rows[VY, i] - rows[VY, j]
            f_r, f_c, f_n, _ = _pair(n_x, n_y, 1.0, math.sqrt(r_2) - c.two_R, wx, wy, c)
            cos_i = n_x * rows[UX, i] + n_y * rows[UY, i]
            cos_j = n_x * rows[UX, j] + n_y * rows[UY, j]
            on_i = f_r * (c.a_rep + c.b_rep * cos_i) + f_c
            on_j = f_r * (c.a_rep - c.b_rep * cos_j) + f_c
            rows[FX, i] += f_n * n_y - on_i * n_x
            rows[FY, i] -= f_n * n_x + on_i * n_y
            rows[FX, j] += on_j * n_x - f_n * n_y
            rows[FY, j] += on_j * n_y + f_n * n_x
