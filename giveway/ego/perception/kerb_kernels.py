"""The kernels of kerbs: people on a sidewalk, and people who are about to cross."""

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array, inner, kernel

NEAR = 10.0  # distance [m] from the path, within which kerbs matter
LOOK, LOOKS = 0.5, 3  # spacing [s] and number of the instants ahead that are examined
_DEEPEST = NEAR  # largest width [m] of a sidewalk
_BEHIND = 2.0  # distance [m] behind a sidewalk, within which people count as on it; own choice
_MOUTH = 1.5  # distance [m] to a crossing, within which people are about to enter it
_ON_LINE = 0.05  # tolerance [m] of a point on a kerb's line
_STANDS = 0.3  # speed [m/s] up to which a person at a crossing waits for a gap there
_SETS_OUT = 0.6  # acceleration [m/s^2] of a person towards a kerb: a_k of docs/safety.md


@kernel
def fill_kerbs(
    position: Array,
    velocity: Array,
    edges: Array,
    is_kerb: NDArray[np.bool_],
    mouths: Array,
    found: Array,
) -> None:
    """Fill ``found`` as :meth:`giveway.ego.perception.kerbs.Kerbs.of` returns it.

    Args:
        position: Positions (n, 2) [m] of the people.
        velocity: Velocities (n, 2) [m/s] of the people.
        edges: Edges (k, 4) [m] of sidewalks, which are on the left of each edge.
        is_kerb: Whether the road is on the right of each edge, (k,).
        mouths: Crossings (c, 7), as :func:`giveway.ego.perception.kerbs._mouths` returns them.
        found: Kerbs (n, 3), filled.
    """
    for p in range(position.shape[0]):
        x, y = position[p, 0], position[p, 1]
        closest = nearest_kerb = np.inf
        inside, nearest, beside, behind = False, -1, False, False
        to_x = to_y = 0.0
        for i in range(edges.shape[0]):
            x_0, y_0 = edges[i, 0], edges[i, 1]
            e_x, e_y = edges[i, 2] - x_0, edges[i, 3] - y_0
            share = ((x - x_0) * e_x + (y - y_0) * e_y) / (e_x * e_x + e_y * e_y)
            share = min(1.0, max(0.0, share))
            d_x, d_y = x_0 + share * e_x - x, y_0 + share * e_y - y
            distance = np.sqrt(d_x * d_x + d_y * d_y)
            left = e_x * d_y - e_y * d_x < 0.0
            if distance < closest or (distance == closest and not left):
                closest, inside = distance, left
            if is_kerb[i] and distance < nearest_kerb:
                nearest_kerb, to_x, to_y = distance, d_x, d_y
                nearest, beside = i, 0.0 < share < 1.0
                behind = left and beside
        on = inside or (behind and closest <= _BEHIND)
        stands = is_standing(velocity[p])
        if not on or nearest_kerb > _DEEPEST or in_mouth(x, y, mouths, stands):
            continue
        found[p, 0], found[p, 1] = to_x / nearest_kerb, to_y / nearest_kerb
        found[p, 2] = nearest_kerb
        if not beside:
            heed_line(nearest, edges, is_kerb, position[p], velocity[p], found[p])


@inner
def heed_line(
    i: int, edges: Array, is_kerb: NDArray[np.bool_], here: Array, velocity: Array, kerb: Array
) -> None:
    """Replace ``kerb`` (3,) by the line of edge ``i`` if that line counts, see :meth:`Kerbs.of`."""
    e_x, e_y = edges[i, 2] - edges[i, 0], edges[i, 3] - edges[i, 1]
    length = np.sqrt(e_x * e_x + e_y * e_y)
    n_x, n_y = e_y / length, -e_x / length
    depth = n_x * (edges[i, 0] - here[0]) + n_y * (edges[i, 1] - here[1])
    pace = n_x * velocity[0] + n_y * velocity[1]
    its_pace = kerb[0] * velocity[0] + kerb[1] * velocity[1]
    if depth <= _ON_LINE or arrival(depth, pace) <= arrival(kerb[2], its_pace):
        return
    for k in range(edges.shape[0]):
        for end in (0, 2):
            d_x, d_y = edges[k, end] - here[0], edges[k, end + 1] - here[1]
            near = is_kerb[k] and d_x * d_x + d_y * d_y <= NEAR * NEAR
            if near and n_x * d_x + n_y * d_y < depth - _ON_LINE:
                return
    kerb[0], kerb[1], kerb[2] = n_x, n_y, depth


@kernel
def drop_kerbs(
    people: tuple[Array, Array, Array],
    ways: tuple[Array, NDArray[np.int64], NDArray[np.int64]],
    mouths: Array,
    kerbs: Array,
) -> None:
    """Set the row of ``kerbs`` to 0 for people who are on or about to enter a crossing.

    Args:
        people: Positions (n, 2) [m], velocities (n, 2) [m/s] and desired speeds (n,) [m/s].
        ways: Way-points (w, 2) [m] of all people, one after the other; index (n + 1,) of each
            person's first one, and number (n,) of the next one.
        mouths: Crossings (c, 7), as :func:`giveway.ego.perception.kerbs._mouths` returns them.
        kerbs: Kerbs (n, 3), changed.
    """
    (position, velocity, desired_speed), (waypoints, start, index) = people, ways
    for p in range(len(kerbs)):
        if kerbs[p, 2] <= 0.0:
            continue
        x, y = position[p, 0], position[p, 1]
        at, last = start[p] + index[p], start[p + 1] - 1
        stands = is_standing(velocity[p])
        if in_mouth(x, y, mouths, stands):
            kerbs[p] = 0.0
            continue
        for look in range(1, LOOKS + 1):
            left = desired_speed[p] * LOOK
            while left > 0.0:  # along the route, from one way-point to the next
                to_x, to_y = waypoints[at, 0] - x, waypoints[at, 1] - y
                far = np.sqrt(to_x * to_x + to_y * to_y)
                share = 1.0 if far <= left else left / far
                x, y = x + share * to_x, y + share * to_y
                left -= far
                if at == last:
                    break
                if left >= 0.0:
                    at += 1
            t = look * LOOK
            s_x, s_y = position[p, 0] + t * velocity[p, 0], position[p, 1] + t * velocity[p, 1]
            if in_mouth(x, y, mouths, stands) or in_mouth(s_x, s_y, mouths, stands):
                kerbs[p] = 0.0
                break


@inner
def arrival(depth: float, pace: float) -> float:
    """The time [s] after which a person who starts towards a kerb reaches it.

    Args:
        depth: Distance [m] to the kerb.
        pace: Speed [m/s] towards the kerb.
    """
    faster = np.sqrt(max(0.0, pace * pace + 2.0 * _SETS_OUT * depth))
    return float((faster - pace) / _SETS_OUT)


@inner
def is_standing(velocity: Array) -> bool:
    """Return whether a person with this velocity (2,) [m/s] stands."""
    return bool(velocity[0] ** 2 + velocity[1] ** 2 <= _STANDS * _STANDS)


@inner
def in_mouth(x: float, y: float, mouths: Array, stands: bool) -> bool:
    """Return whether the point (x, y) [m] is beside, before or on a crossing.

    People who stand do not count at crossings where they have to wait for a gap.
    """
    for i in range(mouths.shape[0]):
        if stands and mouths[i, 6] > 0.0:
            continue
        d_x, d_y = x - mouths[i, 0], y - mouths[i, 1]
        u = d_x * mouths[i, 2] + d_y * mouths[i, 3]
        w = d_y * mouths[i, 2] - d_x * mouths[i, 3]
        if -_MOUTH <= u <= mouths[i, 4] + _MOUTH and abs(w) <= mouths[i, 5] + _MOUTH:
            return True
    return False
