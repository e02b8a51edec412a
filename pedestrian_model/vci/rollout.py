"""The crowd on and on: steps under given vehicle poses, from a state that stays as it is."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import borrowed, inlined, kernel
from pedestrian_model.arrays import Arrays
from pedestrian_model.stepping import FINE
from pedestrian_model.vci.buffers import Scratch
from pedestrian_model.vci.step import Scene, State, parts, step_n


class Rollout(NamedTuple):
    """A state that is predicted, and memory."""

    state: State
    velocity: NDArray[np.float64]  # (n, 2) [m/s] before the latest step


@inlined
def start(arrays: Arrays) -> tuple[Rollout, Scene, Scratch]:
    """Copy the present state into the memory of a rollout, for :func:`rollout_step` to change.

    Inlined, for compiled functions that predict step by step: handing so many arrays from one to
    the next costs as much as the forces of ten people.

    Args:
        arrays: those of :meth:`Predictor.arrays`.
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
    """Step as :func:`step_n` does, also by steps that stand for several of the crowd's own.

    The forces are then those at the mean of the instants at which the own steps would have them:
    people are moved on by ``lead`` [s] at their velocities, and back. And the mass is a greater
    one, because each of the own steps would take back a part k_des dt/m of the speed that the one
    before has gained (``pack``). So two steps of 0.05 s and one of 0.1 s differ less by half.

    Args:
        ahead: changed.
        scene: what the crowd walks among.
        vehicles: (m, 7) at that mean instant.
        scratch: memory.
        law: ``law`` of :func:`step_n`, and the lead [s].

    Returns:
        ``FINE`` or the first bad index.
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
    """Fill ``out`` (N, n, 2) with the positions of the next N steps.

    As :func:`rollout_step`, with ``vehicles`` (N, m, 7). The state stays as
    it is, unless it is its own memory for the rollout. ``out`` may have room for fewer pedestrians
    than there are, or for none.
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
