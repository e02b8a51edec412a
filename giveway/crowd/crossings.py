"""The use of crossings by pedestrians, for their priority and for the waiting of drivers.

A place on a crossing is (u, w): u [m] from one kerb along its middle line to the other, w [m] to
the left of it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from pedestrian_model import Crowd, targets

KERB_DISTANCE = 1.5  # distance [m] to the kerb within which people are about to enter; own choice
ASIDE = 0.5  # distance [m] beside a crossing's marking, within which people count as on it
_ONWARD = 0.5  # least cosine (60 degrees) of the angle between walking direction and crossing
_WAITING = 1.5  # distance [m] to the waiting point, within which people wait
_LOOK_AHEAD = 3  # number of next way-points that are searched for one at a kerb
_GREEN = "Gg"
_OUT = "Oo"


class Use(NamedTuple):
    """The use that each of k people makes of a crossing."""

    on: NDArray[np.bool_]  # whether each is between its kerbs
    waiting: NDArray[np.bool_]  # whether each is where people wait for its light
    entering: NDArray[np.bool_]  # whether each is before a kerb and wants to cross
    leaving: NDArray[np.bool_]  # whether each is behind a kerb and walks away from it
    onward: Array  # cosine of the angle between walking direction and crossing, from u = 0 on


def place_on(position: Array, kerb: Array, along: Array) -> tuple[Array, Array]:
    """Return the places u and w (k,) [m] of people on crossings.

    Args:
        position: Positions (k, 2) [m] of the people.
        kerb: Point (2,) or (k, 2) [m] at which u and w are 0.
        along: Unit vectors (2,) or (k, 2) along the crossings.
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
    """Return whether each place (k,) is on a crossing or within ``reach`` [m] of its kerbs."""
    near: NDArray[np.bool_] = (np.abs(w) <= half_width) & (u >= -reach) & (u <= length + reach)
    return near


def use_of(
    crowd: Crowd, rows: NDArray[np.intp], u: Array, along: Array, length: Array | float
) -> Use:
    """Return whether people beside crossings are on one, wait, enter it or leave it.

    Args:
        crowd: All pedestrians.
        rows: Rows (k,) of the people, each of whom is beside a crossing.
        u: Distance (k,) [m] of each person from one kerb along the crossing.
        along: Unit vectors (2,) or (k, 2) along the crossings.
        length: Length of one crossing or of each [m].
    """
    way = targets(crowd, rows) - crowd.position[rows]
    far = np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)
    onward = (way[:, 0] * along[..., 0] + way[:, 1] * along[..., 1]) / far
    on = (u >= 0.0) & (u <= length)
    at = crowd.waypoint_start[rows] + crowd.waypoint_index[rows]
    waiting = (crowd.waypoint_signal[at] >= 0) & (far <= _WAITING)
    inward = np.where(u < 0.0, onward, -onward)
    entering = ~on & ~waiting & (inward >= _ONWARD)  # for people who wait see `turning_in`
    return Use(on, waiting, entering, ~on & (inward <= -_ONWARD), onward)


def turning_in(
    crowd: Crowd, rows: NDArray[np.intp], kerb: Array, along: Array, length: float, reach: Array
) -> Array:
    """Return the direction (k,) in which each person is going to cross.

    It is 1 from u = 0, -1 from the other kerb, and 0 for people who do not cross.

    Args:
        crowd: All pedestrians.
        rows: Rows of the people beside the crossing.
        kerb: Point (2,) [m] at which u is 0.
        along: Unit vector (2,) along the crossing.
        length: Length of the crossing [m].
        reach: Largest distance (k,) [m] of each person to the kerb.
    """
    last = crowd.waypoint_start[rows + 1] - 1
    position = crowd.position[rows]
    turns = np.zeros(len(rows))
    for step in range(_LOOK_AHEAD):
        at = crowd.waypoint_start[rows] + crowd.waypoint_index[rows] + step
        there, onwards = (crowd.waypoints[np.minimum(k, last)] for k in (at, at + 1))
        way = onwards - there
        onward = np.einsum("ij,j", way, along) / np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)
        u, _ = place_on(there, kerb, along)
        near = np.hypot(*(there - position).T) <= reach
        forth = near & (np.abs(u) <= _WAITING) & (onward >= _ONWARD)
        back = near & (np.abs(u - length) <= _WAITING) & (onward <= -_ONWARD)
        turns = np.where(turns == 0.0, forth.astype(np.float64) - back, turns)
    return turns


def have_priority(use: Use, can_enter: NDArray[np.bool_] | bool) -> NDArray[np.bool_]:
    """Return whether each person (k,) has priority: on a crossing, or about to enter an open one.

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
        zebra: Whether people have priority without a light, or while it is off.
    """
    letter = state[link] if 0 <= link < len(state) else "O"
    return letter in _GREEN or (letter in _OUT and zebra)
