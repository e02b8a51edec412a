"""The separation in time of an ego and a person at the same place."""

from math import hypot, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.contact import contact_interval, to_frame
from giveway.geometry.kernel import inner

BLOCK = 8  # number of ego instants that are excluded together


class EgoMotion(NamedTuple):
    """The motion of the ego's body, T instants."""

    time: NDArray[np.float64]  # (T,) [s]
    poses: NDArray[np.float64]  # (T, 4) centre x, y [m], cos and sin of the heading
    blocks: NDArray[np.float64]  # (b, 3) circles of :func:`blocks_of`
    body: tuple[float, float, float]  # half length, half width, radius of a pedestrian [m]


@inner
def blocks_of(
    poses: NDArray[np.float64], half_length: float, half_width: float, radius: float
) -> NDArray[np.float64]:
    """Return circles around all that the ego reaches in BLOCK steps: rows of x, y, radius^2."""
    # Ten per cent more than the rectangle's own circle allow for turns of up to 49 deg in a step.
    reach = 1.1 * (hypot(half_length, half_width) + radius)
    steps = max(poses.shape[0] - 1, 1)
    blocks = np.empty(((steps + BLOCK - 1) // BLOCK, 3))
    for b in range(blocks.shape[0]):
        start = b * BLOCK
        stop = min(start + BLOCK, poses.shape[0] - 1)
        middle = (start + stop) // 2
        x, y = poses[middle, 0], poses[middle, 1]
        farthest = 0.0
        for k in range(start, stop + 1):
            farthest = max(farthest, hypot(poses[k, 0] - x, poses[k, 1] - y))
        blocks[b, 0], blocks[b, 1], blocks[b, 2] = x, y, (farthest + reach) ** 2
    return blocks


@inner
def _touch_in_step(
    k: int,
    x: float,
    y: float,
    time: NDArray[np.float64],
    poses: NDArray[np.float64],
    body: tuple[float, float, float],
) -> tuple[float, float]:
    """Return the first and last time [s] at which the ego touches a circle at (x, y) in step k.

    It is (inf, -inf) if it never does. The circle moves relative to the ego, and this motion is
    taken as straight within a step.
    """
    half_length, half_width, radius = body
    end = min(k + 1, time.size - 1)
    p_x, p_y = to_frame(x - poses[k, 0], y - poses[k, 1], poses[k, 2], poses[k, 3])
    q_x, q_y = to_frame(x - poses[end, 0], y - poses[end, 1], poses[end, 2], poses[end, 3])
    long, wide = half_length + radius, half_width + radius
    if (
        min(p_x, q_x) > long
        or max(p_x, q_x) < -long
        or min(p_y, q_y) > wide
        or max(p_y, q_y) < -wide
    ):
        return inf, -inf
    first, last = contact_interval(p_x, p_y, q_x - p_x, q_y - p_y, half_length, half_width, radius)
    if first > 1.0 or last < 0.0:
        return inf, -inf
    duration = time[end] - time[k]
    return time[k] + max(first, 0.0) * duration, time[k] + min(last, 1.0) * duration


@inner
def _separation_in_step(
    k: int,
    t: float,
    x: float,
    y: float,
    time: NDArray[np.float64],
    poses: NDArray[np.float64],
    body: tuple[float, float, float],
) -> float:
    """Return the time [s] between t and the ego's touch of a circle in step k; inf without one."""
    first, last = _touch_in_step(k, x, y, time, poses, body)
    return max(first - t, t - last, 0.0)


@inner
def _out_of_reach(b: int, x: float, y: float, blocks: NDArray[np.float64]) -> bool:
    """Return whether the ego certainly touches no circle at (x, y) in any step of block b."""
    return bool((x - blocks[b, 0]) ** 2 + (y - blocks[b, 1]) ** 2 > blocks[b, 2])


@inner
def separation(t: float, x: float, y: float, step: int, cutoff: float, ego: EgoMotion) -> float:
    """Return the time [s] between t and the ego's nearest touch of a circle; inf beyond ``cutoff``.

    ``step`` is the ego's step that contains t, and (x, y) the place of the circle. The search runs
    outwards from this step, and ends where no touch closer in time can follow.
    """
    time, poses, blocks, body = ego
    nearest = inf
    steps = max(time.size - 1, 1)
    k = min(step, steps - 1)
    while k < steps and time[k] - t < min(nearest, cutoff):
        b = k // BLOCK
        if _out_of_reach(b, x, y, blocks):
            k = (b + 1) * BLOCK
            continue
        nearest = min(nearest, _separation_in_step(k, t, x, y, time, poses, body))
        k += 1

    k = min(step, steps) - 1
    while k >= 0 and t - time[k + 1] < min(nearest, cutoff):
        b = k // BLOCK
        if _out_of_reach(b, x, y, blocks):
            k = b * BLOCK - 1
            continue
        nearest = min(nearest, _separation_in_step(k, t, x, y, time, poses, body))
        k -= 1
    return nearest


@inner
def ego_comes_later(
    t: float, x: float, y: float, step: int, nearest: float, ego: EgoMotion
) -> bool:
    """Return whether the ego touches a circle at (x, y) within ``nearest`` after t, not before.

    The arguments are those of :func:`separation`.
    """
    time, poses, blocks, body = ego
    steps = max(time.size - 1, 1)
    k = min(step, steps - 1)
    while k < steps and time[k] - t <= nearest:
        b = k // BLOCK
        if _out_of_reach(b, x, y, blocks):
            k = (b + 1) * BLOCK
            continue
        first, _ = _touch_in_step(k, x, y, time, poses, body)
        if t <= first <= t + nearest:
            return True
        k += 1
    return False
