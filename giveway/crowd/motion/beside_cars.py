"""People beside a vehicle that passes keep off its sides and its rear, which turn towards them."""

import numpy as np

from giveway.geometry.kernel import Array
from pedestrian_model import Vehicles

_ROOM = 0.4  # distance [m] that a person's body keeps; own choice
_MOVES = 0.5  # speed [m/s] from which on a vehicle moves


def keep_off(
    places: Array, velocities: Array, vehicles: Vehicles, radius: float, most: float
) -> None:
    """Move people off the sides and rears of moving vehicles, in place, and let none walk on there.

    Args:
        places: Places (k, 2) [m] of people.
        velocities: Their velocities (k, 2) [m/s].
        vehicles: All vehicles.
        radius: Radius [m] of a person's body.
        most: Largest distance [m] by which a person is moved.
    """
    bodies = vehicles.array[np.abs(vehicles.array[:, 3]) > _MOVES]
    if not len(bodies):
        return
    x, y, heading, _, front, rear, width = bodies.T
    cos, sin = np.cos(heading), np.sin(heading)
    d_x, d_y = places[:, None, 0] - x, places[:, None, 1] - y
    along, aside = d_x * cos + d_y * sin, d_y * cos - d_x * sin
    behind = np.maximum(-rear - along, 0.0)
    beside = np.maximum(np.abs(aside) - width / 2.0, 0.0)
    short = radius + _ROOM - np.hypot(behind, beside)
    short[(along > front) | (behind + beside == 0.0)] = 0.0
    rows = np.flatnonzero((short > 0.0).any(axis=1))
    near = short[rows].argmax(axis=1)
    back, left = -behind[rows, near], beside[rows, near] * np.sign(aside[rows, near])
    c, s = cos[near], sin[near]
    out = np.column_stack([back * c - left * s, back * s + left * c])
    out /= np.hypot(*out.T)[:, None]
    places[rows] += np.minimum(short[rows, near], most)[:, None] * out
    inwards = np.minimum((velocities[rows] * out).sum(axis=1), 0.0)
    velocities[rows] -= inwards[:, None] * out
