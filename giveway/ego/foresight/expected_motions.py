"""The motions that people are predicted with if the ego's estimate of their intent says so.

They replace the model's motion after each prediction step, in the compiled search of the planner.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from giveway.ego.foresight.workspace import Arrays
from giveway.geometry.kernel import Array, inlined

STANDS = 0.25
"""Speed [m/s] below which a person is predicted to go on standing."""

WALKS, YIELDS, KEEPS_ON, STOPS = 0, 1, 2, 3
"""The motions of a person's prediction: by the model, yielding, at the same velocity, at rest."""

Yielding = tuple[NDArray[np.int8], float, float, float]
"""The yielding state: marks (n,) of motions, share of a desired change of velocity in one step,
s_des [m], and the prediction step [s]."""


@inlined
def step_yielding(
    yielding: tuple[Any, ...], at: int, state: Array, scene: Any, position: Array, velocity: Array
) -> None:
    """Move people who yield by one prediction step, under their destination force alone; in place.

    Forces of the ego and of other people are left out: they would push a person who stands at the
    corridor's edge aside, which would free room that does not exist.

    Args:
        yielding: Yielding state, see :data:`Yielding`.
        at: Index in ``state`` at which the step before begins.
        state: State of each person: x, y [m], v_x, v_y [m/s].
        scene: Scene of the prediction.
        position: Positions (n, 2) [m] of all people after the step; changed.
        velocity: Velocities (n, 2) [m/s] of all people after the step; changed.
    """
    yields, taken_up, smoothing, dt = yielding
    waypoints, _, _, begin = scene.routes
    for p in range(position.shape[0]):
        if yields[p] != YIELDS:
            continue
        base, last = at + 4 * p, begin[p + 1] - 1
        to_x, to_y = waypoints[last, 0] - state[base], waypoints[last, 1] - state[base + 1]
        gain = scene.desired_speed[p] / np.sqrt(to_x * to_x + to_y * to_y + smoothing * smoothing)
        v_x, v_y = state[base + 2], state[base + 3]
        v_x, v_y = v_x + taken_up * (gain * to_x - v_x), v_y + taken_up * (gain * to_y - v_y)
        velocity[p, 0], velocity[p, 1] = v_x, v_y
        position[p, 0], position[p, 1] = state[base] + dt * v_x, state[base + 1] + dt * v_y


@inlined
def keep_on(
    yielding: tuple[Any, ...],
    step: int,
    people: Arrays,
    creeping: tuple[bool, NDArray[np.bool_]],
    position: Array,
    velocity: Array,
) -> None:
    """Move people who keep their velocity, or stop, by a prediction step; in place.

    Before an ego that creeps, those who walk and see it make way.

    Args:
        yielding: Yielding state, see :data:`Yielding`.
        step: Index of the prediction step.
        people: Positions (n, 2) [m] and velocities (n, 2) [m/s] of all people now, and more.
        creeping: Whether the ego creeps, and marks (n,) of people who may not see it.
        position: Positions (n, 2) [m] of all people after the step; changed.
        velocity: Velocities (n, 2) [m/s] of all people after the step; changed.
    """
    (yields, _, _, dt), (creeps, unaware) = yielding, creeping
    for p in range(position.shape[0]):
        v_x, v_y = people[1][p, 0], people[1][p, 1]
        walks = v_x * v_x + v_y * v_y >= STANDS * STANDS
        if yields[p] >= KEEPS_ON and not (creeps and walks and not unaware[p]):
            for axis in range(2):
                velocity[p, axis] = people[1][p, axis] if yields[p] == KEEPS_ON else 0.0
                position[p, axis] = people[0][p, axis] + (step + 1) * dt * velocity[p, axis]
