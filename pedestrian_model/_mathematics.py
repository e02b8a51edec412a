"""Elementary functions for the kernels, made of basic operations without libm and branches."""

import math
from fractions import Fraction
from functools import lru_cache

from pedestrian_model._jit import bits, fma, from_bits, inlined

_LOG2_E = 1.4426950408889634
_LN2_HIGH, _LN2_LOW = 0.6931471803691238, 1.9082149292705877e-10
_ROUND = 6755399441055744.0  # 1.5 * 2**52: a sum with it has the nearest integer in its low bits
_TWO_OVER_PI = 0.6366197723675814
_HALF_PI_HIGH, _HALF_PI_LOW = 1.5707963267948966, 6.123233995736766e-17

#: cos and sin of pi/8, the centre of the folded range of ``angle_polynomial``.
COS_PI_8, SIN_PI_8 = 0.9238795325112867, 0.3826834323650898
#: Degree of the polynomial of ``angle_polynomial``, which is exact to 1e-12 for a decay of 1.
DEGREE = 15


@inlined
def exponential(x: float) -> float:
    """Return exp(x) to about 1 ulp for -700 <= x <= 700.

    x = k ln 2 + r, with a Taylor series in |r| <= ln(2)/2.
    """
    shifted = fma(x, _LOG2_E, _ROUND)
    k = shifted - _ROUND
    r = fma(-k, _LN2_LOW, fma(-k, _LN2_HIGH, x))
    p = 1.0 / 6227020800.0
    p = fma(p, r, 1.0 / 479001600.0)
    p = fma(p, r, 1.0 / 39916800.0)
    p = fma(p, r, 1.0 / 3628800.0)
    p = fma(p, r, 1.0 / 362880.0)
    p = fma(p, r, 1.0 / 40320.0)
    p = fma(p, r, 1.0 / 5040.0)
    p = fma(p, r, 1.0 / 720.0)
    p = fma(p, r, 1.0 / 120.0)
    p = fma(p, r, 1.0 / 24.0)
    p = fma(p, r, 1.0 / 6.0)
    p = fma(p, r, 0.5)
    p = fma(p, r, 1.0)
    p = fma(p, r, 1.0)
    return p * from_bits((bits(shifted) + 1023) << 52)


@inlined
def cosine_sine(angle: float) -> tuple[float, float]:
    """Return cosine and sine of an angle [rad], to about 1 ulp near 0.

    They are Taylor series in |r| <= pi/4.
    """
    k = fma(angle, _TWO_OVER_PI, _ROUND) - _ROUND
    r = fma(-k, _HALF_PI_LOW, fma(-k, _HALF_PI_HIGH, angle))
    z = r * r
    s = 1.0 / 355687428096000.0
    s = fma(s, z, -1.0 / 1307674368000.0)
    s = fma(s, z, 1.0 / 6227020800.0)
    s = fma(s, z, -1.0 / 39916800.0)
    s = fma(s, z, 1.0 / 362880.0)
    s = fma(s, z, -1.0 / 5040.0)
    s = fma(s, z, 1.0 / 120.0)
    s = fma(s, z, -1.0 / 6.0)
    s = fma(s * z, r, r)
    c = -1.0 / 6402373705728000.0
    c = fma(c, z, 1.0 / 20922789888000.0)
    c = fma(c, z, -1.0 / 87178291200.0)
    c = fma(c, z, 1.0 / 479001600.0)
    c = fma(c, z, -1.0 / 3628800.0)
    c = fma(c, z, 1.0 / 40320.0)
    c = fma(c, z, -1.0 / 720.0)
    c = fma(c, z, 1.0 / 24.0)
    c = fma(c, z, -0.5)
    c = fma(c, z, 1.0)
    quadrant = int(k) & 3
    if quadrant & 1:
        s, c = c, -s
    if quadrant & 2:
        s, c = -s, -c
    return c, s


@inlined
def angle_polynomial(t: float, g: tuple[float, ...]) -> float:
    """Return the polynomial of degree 15 with coefficients ``g`` at ``t``, by Estrin's scheme."""
    t2 = t * t
    t4 = t2 * t2
    low = fma(
        fma(fma(g[7], t, g[6]), t2, fma(g[5], t, g[4])),
        t4,
        fma(fma(g[3], t, g[2]), t2, fma(g[1], t, g[0])),
    )
    high = fma(
        fma(fma(g[15], t, g[14]), t2, fma(g[13], t, g[12])),
        t4,
        fma(fma(g[11], t, g[10]), t2, fma(g[9], t, g[8])),
    )
    return fma(high, t4 * t4, low)


@lru_cache(maxsize=16)
def angle_decay_coefficients(decay: float) -> tuple[float, ...]:
    """Return the coefficients of the polynomial for exp(-decay atan(t)), |t| <= tan(pi/8).

    The Taylor series of y = exp(-l atan t) follows from (1 + t^2) y' = -l y. It is economised in
    Chebyshev polynomials, in rational arithmetic, so that the result is the same on every platform.
    """
    terms = 72
    decay_ = Fraction(decay)
    series = [Fraction(1), -decay_]
    for k in range(1, terms):
        series.append((-decay_ * series[k] - (k - 1) * series[k - 1]) / (k + 1))
    reach = Fraction(27, 65)  # a little more than tan(pi/8)
    scaled = [c * reach**k for k, c in enumerate(series)]
    # u^k = 2^(1-k) sum_j binomial(k, j) T_(k-2j), the last term halved if k is even
    chebyshev = [Fraction(0)] * (DEGREE + 1)
    for k, c in enumerate(scaled):
        for j in range(k // 2 + 1):
            if k - 2 * j <= DEGREE:
                weight = Fraction(math.comb(k, j) * 2, 2**k)
                chebyshev[k - 2 * j] += c * (weight / 2 if k == 2 * j else weight)
    before, now = [Fraction(1)], [Fraction(0), Fraction(1)]
    power = [chebyshev[0], *[Fraction(0)] * DEGREE]
    for c in chebyshev[1:]:
        for k, a in enumerate(now):
            power[k] += c * a
        after = [Fraction(0), *(2 * a for a in now)]
        for k, a in enumerate(before):
            after[k] -= a
        before, now = now, after
    return tuple(float(c / reach**k) for k, c in enumerate(power))
