"""The forces between two pedestrians: repulsion, collision and navigation.

Each pair is evaluated once. Distance, direction and the navigational force are the same for both.
Only the anisotropy of the repulsion differs. ``pair`` has no branch, no call and no libm function,
so that the loops around it (``all_pairs.py`` for a small crowd, ``cell_list.py`` for a large one)
can be vectorised with strict IEEE arithmetic.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import fma, inlined
from pedestrian_model._mathematics import angle_polynomial, cosine_sine
from pedestrian_model.vci.buffers import FX, FY, PX, PY, UX, UY, VX, VY

COINCIDENT_2 = 1e-6**2  # squared distance [m^2] below which centres have no direction (ours)
_STANDSTILL_2 = 1e-3**2  # squared relative speed [m^2/s^2] below which f_n is 0 (ours)


class Repulsion(NamedTuple):
    """The repulsion flm(d; d0, M, s) As(phi; l).

    flm(d; d0, M, s) = M/(2 d0) ((d0 - d) + sqrt((d0 - d)^2 + s^2)).
    """

    d: float  # d0 [m]
    s_2: float  # s^2 [m^2]
    a: float  # As(phi; l) M/(2 d0) = a + b cos phi
    b: float


class Navigation(NamedTuple):
    """The navigational force flm(d; d0, M, s) Ae(phi; l)."""

    d: float  # d0 [m]
    s_2: float  # s^2 [m^2]
    decay: tuple[float, float, float, float]  # M/(2 d0) Ae at pi/8, 3 pi/8, 5 pi/8, 7 pi/8
    cos_pi_8: float
    sin_pi_8: float
    g: tuple[float, ...]  # coefficients of the polynomial for Ae around these angles


class PairConstants(NamedTuple):
    """The constants of the pair loops."""

    two_R: float  # noqa: N815
    r_max_2: float
    k_col: float
    repulsion: Repulsion
    navigation: Navigation


@inlined
def pair_constants(c: Any) -> PairConstants:
    """Return the constants of the pair loops from the record of all constants."""
    g = c.g
    # fmt: off
    polynomial = (
        g[0], g[1], g[2], g[3], g[4], g[5], g[6], g[7],
        g[8], g[9], g[10], g[11], g[12], g[13], g[14], g[15],
    )
    # fmt: on
    decay = (c.decay_0, c.decay_1, c.decay_2, c.decay_3)
    return PairConstants(
        c.two_R,
        c.r_max * c.r_max,
        c.k_col,
        Repulsion(c.d_rep, c.s_rep_2, c.a_rep, c.b_rep),
        Navigation(c.d_nav, c.s_nav_2, decay, c.cos_pi_8, c.sin_pi_8, polynomial),
    )


@inlined
def pair(
    offset: tuple[float, float],
    distances: tuple[float, float],
    relative_velocity: tuple[float, float],
    direction_i: tuple[float, float],
    direction_j: tuple[float, float],
    counts: bool,
    c: PairConstants,
) -> tuple[float, float, float, float]:
    """Return the forces [N] of a pair (i, j) on each other: x, y on i, then x, y on j.

    Args:
        offset: Vector [m] from i to j; its direction is n.
        distances: Length of that vector, and distance between the bodies [m].
        relative_velocity: v_i - v_j [m/s].
        direction_i: Direction of v_i; zero if i stands.
        direction_j: Direction of v_j; zero if j stands.
        counts: Whether the pair counts. If not, all forces are zero.
        c: Constants of the pair loops.

    The angle phi of Ae = exp(-l phi) is not computed. With the cross and dot products of w and n,
    phi is folded into [0, pi/4] and turned by pi/8. Then exp(-l atan t) is a polynomial in
    |t| <= tan(pi/8), times a constant that depends on the quarter of phi.
    """
    (dx, dy), (length, d), (wx, wy) = offset, distances, relative_velocity
    (ux_i, uy_i), (ux_j, uy_j) = direction_i, direction_j
    repulsion, navigation = c.repulsion, c.navigation
    q_rep = repulsion.d - d
    f_r = q_rep + math.sqrt(fma(q_rep, q_rep, repulsion.s_2))
    f_c = c.k_col * max(0.0, -d)
    q_nav = navigation.d - d
    f_n = q_nav + math.sqrt(fma(q_nav, q_nav, navigation.s_2))
    moving = fma(wx, wx, wy * wy) >= _STANDSTILL_2
    along = fma(wx, dx, wy * dy)
    across = fma(wx, dy, -(wy * dx))
    steep = abs(across) > abs(along)
    obtuse = along < 0.0
    a = min(abs(across), abs(along))
    b = max(abs(across), abs(along))
    cos_pi_8, sin_pi_8 = navigation.cos_pi_8, navigation.sin_pi_8
    below = fma(a, cos_pi_8, -(b * sin_pi_8))
    above = fma(b, cos_pi_8, a * sin_pi_8)
    above = above if moving else 1.0
    inverse = 1.0 / (length * above)  # used for both quotients
    t = below * (inverse * length)
    t = -t if steep != obtuse else t
    inverse = inverse * above if counts else 0.0
    decay_0, decay_1, decay_2, decay_3 = navigation.decay
    decay_steep = decay_2 if obtuse else decay_1
    decay_flat = decay_3 if obtuse else decay_0
    decay = decay_steep if steep else decay_flat
    decay = -decay if across < 0.0 else decay  # sgn(0) = +1, to keep right
    f_n = f_n * (decay * angle_polynomial(t, navigation.g))
    f_n = f_n if moving & counts else 0.0
    n_x, n_y = dx * inverse, dy * inverse
    even = fma(f_r, repulsion.a, f_c)
    odd = f_r * repulsion.b
    on_i = fma(odd, fma(n_x, ux_i, n_y * uy_i), even)
    on_j = fma(-odd, fma(n_x, ux_j, n_y * uy_j), even)
    aside_x, aside_y = f_n * n_y, -f_n * n_x  # along t = (n_y, -n_x)
    return (
        fma(-on_i, n_x, aside_x),
        fma(-on_i, n_y, aside_y),
        fma(on_j, n_x, -aside_x),
        fma(on_j, n_y, -aside_y),
    )


@inlined
def add_coincident(
    rows: NDArray[np.float64],
    order: NDArray[np.int64],
    i: int,
    stop: int,
    c: PairConstants,
) -> None:
    """Add the forces between row i and later rows with the same centre.

    People with one centre have no direction to each other. It is derived from their indices.
    """
    for j in range(i + 1, stop):
        dx, dy = rows[PX, j] - rows[PX, i], rows[PY, j] - rows[PY, i]
        r_2 = fma(dx, dx, dy * dy)
        if r_2 < COINCIDENT_2:
            low, high = min(order[i], order[j]), max(order[i], order[j])
            n_x, n_y = cosine_sine(float((low * 7919 + high * 104729) % 4096))
            if order[i] > order[j]:
                n_x, n_y = -n_x, -n_y
            f = pair(
                (n_x, n_y),
                (1.0, math.sqrt(r_2) - c.two_R),
                (rows[VX, i] - rows[VX, j], rows[VY, i] - rows[VY, j]),
                (rows[UX, i], rows[UY, i]),
                (rows[UX, j], rows[UY, j]),
                True,
                c,
            )
            rows[FX, i] += f[0]
            rows[FY, i] += f[1]
            rows[FX, j] += f[2]
            rows[FY, j] += f[3]
