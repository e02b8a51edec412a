"""The use of crossings by pedestrians, for their priority and for the waiting of drivers.

A place on a crossing is (u, w): u [m] from one kerb along its middle line to the other, w [m] to
the left of it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from pedestrian_model import Crowd, targets

ASIDE = 0.5  # Distance [m] beside its marking within which people count as on it
_ONWARD = 0.5  # Smallest cosine (60 degrees) between heading and crossing of who crosses
_WAITING = 1.5  # Distance [m] from the waiting point within which people wait
_LOOK_AHEAD = 3  # Number of next way-points searched for one at a kerb
_GREEN = "Gg"
_OUT = "Oo"


class Use(NamedTuple):
    """The use that each of k people makes of a crossing."""

    on: NDArray[np.bool_]  # between its kerbs
    waiting: NDArray[np.bool_]  # for its light, if it is closed; some do so a step from the kerb
    entering: NDArray[np.bool_]  # before a kerb, and they want to cross
    leaving: NDArray[np.bool_]  # behind a kerb, and they walk away from it
    onward: Array  # cosine of the angle between where they walk to and the way from u = 0 on


def place_on(position: Array, kerb: Array, along: Array) -> tuple[Array, Array]:
    """Places u and w (k,) [m] of people at ``position`` (k, 2) [m].

    Args:
        position: Positions of the people.
        kerb: (2,) or (k, 2) [m] Point at which u and w are 0.
        along: (2,) or (k, 2) Unit vectors along the crossings.
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
    """Return (k,) whether each is on a crossing or within ``reach`` [m] before or behind it."""
    near: NDArray[np.bool_] = (np.abs(w) <= half_width) & (u >= -reach) & (u <= length + reach)
    return near


def use_of(
    crowd: Crowd, rows: NDArray[np.intp], u: Array, along: Array, length: Array | float
) -> Use:
    """Return how the people ``rows`` (k,) use a crossing each, at ``u`` (k,) [m] along it.

    Args:
        crowd: All pedestrians.
        rows: Rows of the people beside a crossing.
        u: Distance of each from one kerb along the crossing.
        along: (2,) or (k, 2) Unit vectors along the crossings.
        length: Length of one crossing or of each [m].
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
    """Return (k,) who is going to cross: 1 from u = 0, -1 from the other kerb, 0 not at all.

    Args:
        crowd: All pedestrians.
        rows: Rows of the people beside the crossing.
        kerb: (2,) [m] Point at which u is 0.
        along: (2,) Unit vector along the crossing.
        length: Length of the crossing [m].
        reach: (k,) [m] Largest walk of each up to the kerb.
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
    """Return (k,) who may walk on: people on a crossing or about to enter an open one.

    Args:
        use: Use that each makes of a crossing.
        can_enter: Whether the crossing is open to them, by :func:`is_open`.
    """
    finishing = use.on & (can_enter | ~use.waiting)
    return finishing | (use.entering & can_enter)


def is_open(state: str, link: int, *, zebra: bool) -> bool:
    """Return whether people who are about to enter a crossing have priority.

    Args:
        state: State of its traffic light, SUMO's letter per movement; empty without a light.
        link: Index of the crossing's movement in ``state``.
        zebra: Whether people have priority wherever no light says otherwise.
    """
    letter = state[link] if 0 <= link < len(state) else "O"
    return letter in _GREEN or (letter in _OUT and zebra)
