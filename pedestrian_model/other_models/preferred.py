"""Computes desired velocities and goals of a crowd, for models that plug in."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import kernel
from pedestrian_model.routes import heading_for
from pedestrian_model.stepping import first_insane

_ARRIVES = 0.3  # distance [m] over which people slow down to stop at a way-point

first_insane_of = kernel(first_insane)
"""The first pedestrian whose state is not finite, compiled for Python."""


@kernel
def preferred_velocities(
    state: tuple[Any, ...],
    desired_speed: NDArray[np.float64],
    routes: tuple[Any, ...],
    closed: NDArray[np.bool_],
    radii: tuple[float, float],
    out: tuple[Any, ...],
) -> None:
    """Pass the way-points reached, and fill the desired velocities, goals and stops.

    Args:
        state: Positions, velocities and way-point indices of a crowd; the indices are changed.
        desired_speed: Desired speeds (n,) [m/s].
        routes: Arrays of the routes.
        closed: Marks (signals,) of closed signals.
        radii: Radius [m] of a way-point and of a body.
        out: Desired velocities (n, 2) [m/s], goals (n, 2) [m] and stops (n,), filled.
    """
    position, _, waypoint_index = state
    preferred, goal, stops = out
    start = routes[3]
    for i in range(position.shape[0]):
        x, y = position[i, 0], position[i, 1]
        at, halts, to_x, to_y = heading_for(
            x,
            y,
            start[i] + waypoint_index[i],
            (start[i], start[i + 1] - 1),
            routes,
            closed,
            radii,
        )
        waypoint_index[i] = at - start[i]
        goal[i, 0], goal[i, 1], stops[i] = to_x, to_y, halts
        e_x, e_y = to_x - x, to_y - y
        left = np.sqrt(e_x * e_x + e_y * e_y)
        slowed = np.sqrt(left * left + _ARRIVES * _ARRIVES) if halts else max(left, 1e-9)
        share = desired_speed[i] / slowed
        preferred[i, 0], preferred[i, 1] = share * e_x, share * e_y
