"""Who on foot uses a crossing, or is about to: shared by people's priority and drivers' waiting.

A place on a crossing is (u, w): u [m] from one kerb along its middle line to the other, w [m] to
the left of it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from pedestrian_model import Crowd, targets

ASIDE = 0.5  # [m] beside its marking people are on a crossing as well
_ONWARD = 0.5  # cosine: who wants to cross looks less than 60 degrees away from it
_WAITING = 1.5  # [m] from where they are to wait: who is farther from it crosses
_LOOK_AHEAD = 3  # way-points, one of which may be at a kerb
_GREEN = "Gg"
_OUT = "Oo"


class Use(NamedTuple):
    """How people k use a crossing each."""

    on: NDArray[np.bool_]  # between its kerbs
    waiting: NDArray[np.bool_]  # for its light, if it is closed; some do so a step from the kerb
    entering: NDArray[np.bool_]  # before a kerb, and they want to cross
    leaving: NDArray[np.bool_]  # behind a kerb, and they walk away from it
    onward: Array  # cosine of the angle between where they walk to and the way from u = 0 on


def place_on(position: Array, kerb: Array, along: Array) -> tuple[Array, Array]:
    """Places u and w (k,) [m] of people at ``position`` (k, 2) [m].

    Args:
        position: of each.
        kerb: (2,) or (k, 2) [m] where u and w are 0.
        along: (2,) or (k, 2) unit vectors along the crossings.
    """
    x, y = position[:, 0] - kerb[..., 0], position[:, 1] - kerb[..., 1]
    along_x, along_y = along[..., 0], along[..., 1]
    return x * along_x + y * along_y, y * along_x - x * along_y


def is_near(
    u: Array,
    w: Array,
    length: Array | float,
    half_width: Array | float,
    reach: Array | float,
) -> NDArray[np.bool_]:
    """(k,) who is on a crossing, or within ``reach`` [m] of a kerb right before or behind it."""
    near: NDArray[np.bool_] = (np.abs(w) <= half_width) & (u >= -reach) & (u <= length + reach)
    return near


def use_of(
    crowd: Crowd, rows: NDArray[np.intp], u: Array, along: Array, length: Array | float
) -> Use:
    """How the people ``rows`` (k,) of a crowd use a crossing each, at ``u`` (k,) [m] along it.

    Args:
        crowd: all.
        rows: those beside a crossing.
        u: where, from one kerb along it.
        along: (2,) or (k, 2) unit vectors along the crossings.
        length: of one or each [m].
    """
    way = targets(crowd, rows) - crowd.position[rows]
    far = np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)
    onward = (way[:, 0] * along[..., 0] + way[:, 1] * along[..., 1]) / far
    on = (u >= 0.0) & (u <= length)
    at = crowd.waypoint_start[rows] + crowd.waypoint_index[rows]
    waiting = (crowd.waypoint_signal[at] >= 0) & (far <= _WAITING)
    inward = np.where(u < 0.0, onward, -onward)
    entering = ~on & ~waiting & (inward >= _ONWARD)  # who waits looks anywhere: see turning_in
    return Use(on, waiting, entering, ~on & (inward <= -_ONWARD), onward)


def turning_in(
    crowd: Crowd, rows: NDArray[np.intp], kerb: Array, along: Array, length: float, reach: Array
) -> Array:
    """(k,) who walks up to a kerb and then over the crossing: 1 from u = 0 on, -1 back, 0 nobody.

    Args:
        crowd: all.
        rows: those beside the crossing.
        kerb: (2,) [m] where u is 0.
        along: (2,) unit vector along the crossing.
        length: of it [m].
        reach: (k,) [m] that each walks at most up to the kerb.
    """
    last = crowd.waypoint_start[rows + 1] - 1
    position = crowd.position[rows]
    turns = np.zeros(len(rows))
    for step in range(_LOOK_AHEAD):
        at = crowd.waypoint_start[rows] + crowd.waypoint_index[rows] + step
        there, onwards = (crowd.waypoints[np.minimum(k, last)] for k in (at, at + 1))
        way = onwards - there
        onward = (way @ along) / np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)
        u, _ = place_on(there, kerb, along)
        near = np.hypot(*(there - position).T) <= reach
        forth = near & (np.abs(u) <= _WAITING) & (onward >= _ONWARD)
        back = near & (np.abs(u - length) <= _WAITING) & (onward <= -_ONWARD)
        turns = np.where(turns == 0.0, forth.astype(np.float64) - back, turns)
    return turns


def have_priority(use: Use, can_enter: NDArray[np.bool_] | bool) -> NDArray[np.bool_]:
    """(k,) who may walk on: people on a crossing, and those about to enter one that is open.

    Args:
        use: of a crossing each.
        can_enter: whether it is open to them, by :func:`is_open`.
    """
    finishing = use.on & (can_enter | ~use.waiting)
    return finishing | (use.entering & can_enter)


def is_open(state: str, link: int, *, zebra: bool) -> bool:
    """Whether people who are about to enter a crossing have priority.

    Args:
        state: of the light that governs it, one letter per movement (SUMO's); empty: none does.
        link: index of its movement.
        zebra: people have priority wherever no light says otherwise.
    """
    letter = state[link] if 0 <= link < len(state) else "O"
    return letter in _GREEN or (letter in _OUT and zebra)
