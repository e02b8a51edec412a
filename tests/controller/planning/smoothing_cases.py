"""Problems that the tests of the smoothing QP and of the planner share."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from controller import LongitudinalModel, PlannerParameters
from controller.planning.smoothing import SmoothingProblem, nodes_of

N = PlannerParameters().horizon
FREE = np.full(N, np.inf)
MODEL = LongitudinalModel()
FOLLOWING = PlannerParameters()
D_SAFE = FOLLOWING.safe_distance

speeds = st.one_of(st.sampled_from([0.0, 4.0, 20.0]), st.floats(0.0, 20.0))
forces = st.one_of(st.sampled_from([-8000.0, 0.0, 8000.0]), st.floats(-8000.0, 8000.0))
rooms = st.tuples(
    st.integers(0, N - 1),
    st.integers(1, N),
    st.floats(-20.0, 40.0),
    st.floats(-3.0, 5.0),
)


def room_of(first: int, length: int, room: float, pace: float) -> np.ndarray:
    """Free, but for some steps in which somebody who moves along takes the room [m]."""
    corridor = FREE.copy()
    steps = np.arange(first, min(first + length, N))
    corridor[steps] = room + pace * 0.05 * (steps - first)
    return corridor


def drawn(plain_problem, seed, *, parameters=FOLLOWING):
    """A random problem with somebody in the way."""
    g = np.random.default_rng(seed)
    speed = float(g.choice([0.0, 4.0, g.uniform(0.0, 12.0)]))
    cruise = MODEL.friction * speed
    force = float(g.choice([cruise, g.uniform(-8000.0, 8000.0)])) if speed > 0.0 else 0.0
    room = room_of(g.integers(N), g.integers(1, N), g.uniform(-2.0, 1.2 * speed * 3), 0.0)
    before = (force - cruise) / MODEL.mass if speed > 0.0 else 0.0
    wanted = np.full(len(nodes_of(N)), 4.0)
    return plain_problem(speed, force, before, wanted, 4.0, room, MODEL, parameters)


def bounded(plain):
    """The room's own problem for a plain one."""
    problem = SmoothingProblem(plain.model, plain.parameters)
    problem.aim_at(plain.wanted, plain.speed, plain.acceleration)
    problem.bound(plain.speed, plain.previous_force, plain.fastest, plain.room, FREE)
    return problem
