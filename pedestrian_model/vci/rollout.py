"""The rollout of a crowd: steps under given vehicle poses, from a state that is not changed."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import borrowed, inlined, kernel
from pedestrian_model.arrays import Arrays
from pedestrian_model.stepping import FINE
from pedestrian_model.vci.buffers import Scratch
from pedestrian_model.vci.step import Scene, State, parts, step_n


class Rollout(NamedTuple):
    """A predicted state, and memory."""

    state: State
    velocity: NDArray[np.float64]  # velocities (n, 2) [m/s] before the latest step


@inlined
def start(arrays: Arrays) -> tuple[Rollout, Scene, Scratch]:
    """Copy the present state into the memory of a rollout, which :func:`rollout_step` changes.

    Args:
        arrays: Arrays of :meth:`Predictor.arrays`.
    """
    state, scene, scratch = parts(arrays[:-4])
    memory = borrowed(arrays[-4:])
    ahead = State(memory[0], memory[1], memory[2])
    for i in range(state.position.shape[0]):
        ahead.position[i, 0], ahead.position[i, 1] = state.position[i, 0], state.position[i, 1]
        ahead.velocity[i, 0], ahead.velocity[i, 1] = state.velocity[i, 0], state.velocity[i, 1]
        ahead.waypoint_index[i] = state.waypoint_index[i]
    return Rollout(ahead, memory[3]), scene, scratch


@inlined
def rollout_step(
    ahead: Rollout,
    scene: Scene,
    vehicles: NDArray[np.float64],
    scratch: Scratch,
    law: tuple[NDArray[Any], float, int, int, float],
) -> int:
    """Step as :func:`step_n` does, possibly by a long step that replaces several of the crowd's.

    The forces of a long step are those at the mean instant of the steps that it replaces. For this,
    people are moved on by ``lead`` [s] at their velocities, and back afterwards. The mass is
    larger, because each of the replaced steps would reduce the gain of speed of the one before by a
    share k_des dt/m (``pack``). This halves the difference between one step of 0.1 s and two of
    0.05 s.

    Args:
        ahead: Predicted state, changed.
        scene: Surroundings and routes of the crowd.
        vehicles: Vehicles (m, 7) at the mean instant.
        scratch: Memory of a step.
        law: ``law`` of :func:`step_n`, and the lead [s].

    Returns:
        ``FINE``, or the first pedestrian whose state is not finite.
    """
    (x, v, at), before = ahead
    constants, dt, substeps, cell_list_from, lead = law
    n = x.shape[0] if lead > 0.0 else 0
    for i in range(n):
        before[i, 0], before[i, 1] = v[i, 0], v[i, 1]
        x[i, 0], x[i, 1] = x[i, 0] + lead * v[i, 0], x[i, 1] + lead * v[i, 1]
    state = State(x, v, at)
    steps = (constants, dt, substeps, cell_list_from)
    insane = step_n(state, scene, vehicles, scratch, steps)
    for i in range(n):
        x[i, 0], x[i, 1] = x[i, 0] - lead * before[i, 0], x[i, 1] - lead * before[i, 1]
    return insane


@kernel
def roll_out(
    arrays: Arrays,
    vehicles: NDArray[np.float64],
    law: tuple[NDArray[Any], float, int, int, float],
    out: NDArray[np.float64],
) -> int:
    """Fill ``out`` (N, n, 2) [m] with the positions of the next N steps.

    Args:
        arrays: Arrays of :meth:`Predictor.arrays`. The state is not changed, unless it is its own
            memory for the rollout.
        vehicles: Vehicles (N, m, 7).
        law: Constants, as for :func:`rollout_step`.
        out: Positions, filled; it may have room for fewer pedestrians than there are.

    Returns:
        ``FINE``, or the first pedestrian whose state is not finite.
    """
    ahead, scene, scratch = start(arrays)
    x = ahead.state.position
    for k in range(out.shape[0]):
        insane = rollout_step(ahead, scene, vehicles[k], scratch, law)
        if insane != FINE:
            return insane
        for i in range(out.shape[1]):
            out[k, i, 0], out[k, i, 1] = x[i, 0], x[i, 1]
    return FINE
