"""The errors of predictions in a drive: by M and alpha alone, or by the model of each side."""

import numpy as np
from numpy.typing import NDArray

from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.measurements import STANDSTILL
from fmus.profile.vehicle_profile import FittedModel


def true_speed(speed: NDArray[np.float64], lag: float, step: float) -> NDArray[np.float64]:
    """Return the speeds (n,) [m/s] that a run estimates from outputs that lag behind.

    Args:
        speed: Speed outputs (n,) [m/s], one per step.
        lag: First-order lag [s] of the output.
        step: Length of a step [s].
    """
    if lag <= 0.0:
        return speed
    return np.maximum(speed + lag / step * np.diff(speed, prepend=speed[0]), 0.0)


def unfiltered(speed: NDArray[np.float64], lag: float, step: float) -> NDArray[np.float64]:
    """Return the same with the outputs after each instant, too, which a fit knows but no run."""
    if lag <= 0.0:
        return speed
    return np.maximum(speed + lag * np.gradient(speed, step), 0.0)


def speed_errors(trace: Trace, mass: float, friction: float) -> NDArray[np.float64]:
    """Return the errors (m,) [m/s] of the speed one step ahead, while the vehicle moves."""
    h, v, v_next = trace.step_size, trace.speed[:-1], trace.speed[1:]
    predicted = v + h / mass * (trace.force - friction * v)
    moving = np.minimum(v, v_next) > STANDSTILL
    return np.asarray((predicted - v_next)[moving])


def position_errors(
    trace: Trace, mass: float, friction: float, horizon: int, *, exact: bool = False
) -> NDArray[np.float64]:
    """Return the errors (m,) [m] of the position ``horizon`` steps ahead, from every instant.

    The prediction is forward Euler, like the MPC's (Yang & Özgüner 2019, eqs. (2) and (3)), with
    speeds held at 0. If ``exact``, the position is the trapezoid of the speed instead. The drive is
    cut where the vehicle rolls backwards, because the MPC never wants that.
    """
    backwards = np.flatnonzero(trace.speed < -STANDSTILL)
    end = int(backwards[0]) if backwards.size else trace.force.size
    h, force = trace.step_size, trace.force[:end]
    starts = max(force.size - horizon + 1, 0)
    position, speed = trace.position[:starts].copy(), trace.speed[:starts].copy()
    for k in range(horizon):
        before = speed.copy()
        speed += h / mass * (force[k : k + starts] - friction * speed)
        np.maximum(speed, 0.0, out=speed)
        position += h * (0.5 * (before + speed) if exact else before)
    return np.asarray(np.abs(position - trace.position[horizon : horizon + starts]))


def acting_force(trace: Trace, model: FittedModel) -> NDArray[np.float64]:
    """Return the mean forces (m,) [N] for the mass M that act in each step by both sides' model."""
    h, total = trace.step_size, np.zeros(trace.force.size)
    for side, sign in ((model.drive, 1.0), (model.brake, -1.0)):
        if side is None:
            total += np.where(sign * trace.force > 0.0, trace.force, 0.0)
            continue
        steps = round(side.delay / h)
        lag = max(side.lag + side.delay - steps * h, 0.0)  # with the rest of the dead time
        end = np.exp(-h / lag) if lag > 0.0 else 0.0
        mean = lag / h * (1.0 - end)
        wanted = np.maximum(sign * trace.force, 0.0) / side.mass
        wanted = np.concatenate([np.zeros(steps), wanted[: wanted.size - steps]])
        if side.limit is not None:
            share = (side.power_from or np.inf) / np.maximum(trace.speed[:-1], STANDSTILL)
            wanted = np.minimum(wanted, side.limit * np.minimum(1.0, share))
        passed = acts = 0.0
        most = np.inf if side.rate is None else side.rate * h
        for k, value in enumerate(wanted):
            passed += min(max(value - passed, -most), most)
            total[k] += sign * model.mass * (passed + mean * (acts - passed))
            acts = passed + end * (acts - passed)
    return total


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
