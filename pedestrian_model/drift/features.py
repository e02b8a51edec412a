"""The numbers by which ``drift`` corrects constant velocity, in the frame of a person's heading.

They describe what a person and the people around did in the last three seconds. No number depends
on a destination, on a vehicle, or on the place.
"""

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined, kernel
from pedestrian_model._mathematics import exponential

Array = NDArray[np.float64]
Ids = NDArray[np.int64]

# Times [s] to which positions and velocities are compared
LAGS: Final = (0.1, 0.25, 0.5, 1.0, 2.0, 3.0)
STANDS: Final = 0.15  # Speed [m/s] below which a person has no heading and no correction
ALONG: Final = (
    "speed",
    *(f"velocity now - {lag:g} s ago" for lag in LAGS[1:5]),
    "second difference of the velocity over 0.25 s",
    "largest speed of the last 2 s - speed",
    *(f"mean velocity of the last {lag:g} s - velocity" for lag in LAGS),
    "mean velocity of the people within 3 m - velocity",
    "the same, of those who walk in a similar direction",
    "the same, of those who walk ahead in a similar direction",
    "speed of the next person ahead - speed, weighted by the distance",
)
"""Names of the numbers along the heading."""
ACROSS: Final = (ALONG[0], *ALONG[1:4], ALONG[5], *ALONG[7:16])
"""Names of the numbers across the heading; all but the speed change their sign in a mirror."""
FEATURES: Final = len(ALONG) + len(ACROSS)

_TOP = 2.0  # Time [s] over which the largest speed is looked for
_NEIGHBOURS = 3.0  # Distance [m] of people who count as neighbours
_SIMILAR = 0.5  # Cosine between heading and velocity of a neighbour in a similar direction
_AHEAD, _BESIDE, _SAME = 6.0, 1.5, 0.3  # Reach [m], half width [m], cosine of the people ahead
_LEAD = 3.0  # Distance [m] over which the weight of the people ahead falls to 1/e
_FAINT = 0.2  # Weight of nobody ahead, beside which a person far ahead counts little
_FOLLOWS = 1.5  # Distance [m] over which the weight of the next person ahead falls to 1/e
_NEXT, _ASIDE = 4.0, 0.8  # Reach [m] and half width [m] of the next person ahead


def steps_back(time_step: float) -> Ids:
    """Return the numbers of steps that the times of ``LAGS``, and the largest speed, go back."""
    return np.array([max(1, round(lag / time_step)) for lag in (*LAGS, _TOP)], dtype=np.int64)


@kernel
def fill_features(
    tracks: Array,
    newest: int,
    everybody: Ids,
    known: Ids,
    back: Ids,
    time_step: float,
    out: tuple[Ids, Array, Array],
) -> None:
    """Fill headings and numbers of some people.

    Args:
        tracks: Positions and velocities (K, m, 4) [m], [m/s] of people; the state that is k steps
            old is in row ``(newest + k) % K``.
        newest: Row of the present state.
        everybody: Columns (p,) of all people who are seen now.
        known: Number (m,) of earlier states in a row that are known of each person.
        back: Numbers of steps from :func:`steps_back`.
        time_step: Time [s] between two states.
        out: Columns (n,) of the people; their headings (n, 2), which are zero for those who stand;
            their numbers (n, FEATURES).
    """
    rows, heading, numbers = out
    for i in range(rows.shape[0]):
        me, here = rows[i], tracks[newest, rows[i]]
        speed = math.sqrt(here[2] * here[2] + here[3] * here[3])
        numbers[i, :] = 0.0
        if speed < STANDS:
            heading[i, 0] = heading[i, 1] = 0.0
            continue
        c, s = here[2] / speed, here[3] / speed
        heading[i, 0], heading[i, 1] = c, s
        _fill_own(numbers[i], (tracks, newest, me), known[me], back, time_step, (c, s, speed))
        _fill_others(numbers[i], (tracks[newest], me), everybody, (c, s, speed))


@inlined
def _fill_own(
    numbers: Array,
    track: tuple[Array, int, int],
    known: int,
    back: Ids,
    time_step: float,
    frame: tuple[float, float, float],
) -> None:
    """Fill the numbers about the person's own track; see :func:`fill_features`."""
    (tracks, newest, me), (c, s, speed) = track, frame
    K, here = tracks.shape[0], tracks[newest, me]
    numbers[0] = numbers[17] = speed
    for k in range(6):
        steps = min(back[k], known)
        then = tracks[(newest + steps) % K, me]
        if 1 <= k < 5:
            x, y = here[2] - then[2], here[3] - then[3]
            numbers[k] = c * x + s * y
            if k < 4:
                numbers[17 + k] = c * y - s * x
        if steps > 0:
            time = steps * time_step
            x, y = (here[0] - then[0]) / time - here[2], (here[1] - then[1]) / time - here[3]
            numbers[7 + k], numbers[22 + k] = c * x + s * y, c * y - s * x
    between = tracks[(newest + min(back[1], known)) % K, me]
    before = tracks[(newest + min(back[2], known)) % K, me]
    x, y = here[2] - 2.0 * between[2] + before[2], here[3] - 2.0 * between[3] + before[3]
    numbers[5], numbers[21] = c * x + s * y, c * y - s * x
    top = speed * speed
    for k in range(1, min(back[6], known) + 1):
        then = tracks[(newest + k) % K, me]
        top = max(top, then[2] * then[2] + then[3] * then[3])
    numbers[6] = math.sqrt(top) - speed


@inlined
def _fill_others(
    numbers: Array,
    now: tuple[Array, int],
    everybody: Ids,
    frame: tuple[float, float, float],
) -> None:
    """Fill the numbers about the people around; see :func:`fill_features`."""
    (states, me), (c, s, speed) = now, frame
    here = states[me]
    sums = np.zeros((3, 3))  # weights and relative velocities: neighbours, similar ones, ahead
    next_one, following = np.inf, 0.0
    for other in everybody:
        dx, dy = states[other, 0] - here[0], states[other, 1] - here[1]
        if other == me or dx * dx + dy * dy > _AHEAD * _AHEAD + _BESIDE * _BESIDE:
            continue
        forth, aside = c * dx + s * dy, c * dy - s * dx
        v_x, v_y = states[other, 2], states[other, 3]
        along, across = c * v_x + s * v_y, c * v_y - s * v_x
        cosine = along / max(math.sqrt(v_x * v_x + v_y * v_y), 0.1)
        near = dx * dx + dy * dy < _NEIGHBOURS * _NEIGHBOURS
        ahead = 0.0 < forth < _AHEAD and abs(aside) < _BESIDE and cosine > _SAME
        for kind in range(3):
            weight = 0.0
            if (kind == 0 and near) or (kind == 1 and near and cosine > _SIMILAR):
                weight = 1.0
            elif kind == 2 and ahead:
                weight = exponential(-forth / _LEAD)
            sums[kind, 0] += weight
            sums[kind, 1] += weight * (along - speed)
            sums[kind, 2] += weight * across
        if 0.0 < forth < min(_NEXT, next_one) and abs(aside) < _ASIDE:
            next_one, following = forth, (along - speed) * exponential(-forth / _FOLLOWS)
    sums[2, 0] += _FAINT
    for kind in range(3):
        if sums[kind, 0] > 0.0:
            numbers[13 + kind] = sums[kind, 1] / sums[kind, 0]
            numbers[28 + kind] = sums[kind, 2] / sums[kind, 0]
    numbers[16] = following
