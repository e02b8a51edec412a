"""The errors of the MPC's prediction in a drive; the MPC knows M and alpha only."""

import numpy as np
from numpy.typing import NDArray

from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.measurements import STANDSTILL


def speed_errors(trace: Trace, mass: float, friction: float) -> NDArray[np.float64]:
    """Return the errors (m,) [m/s] of the speed one step ahead, while the vehicle moves."""
    h, v, v_next = trace.step_size, trace.speed[:-1], trace.speed[1:]
    predicted = v + h / mass * (trace.force - friction * v)
    moving = np.minimum(v, v_next) > STANDSTILL
    return np.asarray((predicted - v_next)[moving])


def position_errors(
    trace: Trace, mass: float, friction: float, horizon: int
) -> NDArray[np.float64]:
    """Return the errors (m,) [m] of the position ``horizon`` steps ahead, from every instant.

    The prediction is forward Euler, like the MPC's (Yang & Özgüner 2019, eqs. (2) and (3)), with
    speeds held at 0. The drive is cut where the vehicle rolls backwards, because the MPC never
    wants that.
    """
    backwards = np.flatnonzero(trace.speed < -STANDSTILL)
    end = int(backwards[0]) if backwards.size else trace.force.size
    h, force = trace.step_size, trace.force[:end]
    starts = max(force.size - horizon + 1, 0)
    position, speed = trace.position[:starts].copy(), trace.speed[:starts].copy()
    for k in range(horizon):
        position += h * speed
        speed += h / mass * (force[k : k + starts] - friction * speed)
        np.maximum(speed, 0.0, out=speed)
    return np.asarray(np.abs(position - trace.position[horizon : horizon + starts]))


def simulate(
    force: NDArray[np.float64], step: float, mass: float, friction: float, speed: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return position [m] and speed [m/s] (n + 1,) of the MPC's model from ``speed`` on."""
    position, velocity = np.zeros(force.size + 1), np.empty(force.size + 1)
    velocity[0] = speed
    for k, u in enumerate(force):
        position[k + 1] = position[k] + step * velocity[k]
        velocity[k + 1] = max(0.0, velocity[k] + step / mass * (u - friction * velocity[k]))
    return position, velocity
