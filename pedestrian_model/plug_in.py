"""The protocol of pedestrian models of other packages.

A class of an installed package is a pedestrian model if it can be made from a :class:`ModelSetup`
(and its options, if it has any) and has the method ``step``. docs/own_pedestrians.md is the guide.
"""

from typing import NamedTuple, Protocol, TypeAlias, runtime_checkable

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]


class ModelSetup(NamedTuple):
    """The constant facts of a run, which a model gets when it is made."""

    time_step: float  # time step h [s]
    body_radius: float  # body radius [m] of all people
    max_acceleration: float  # largest acceleration [m/s^2]; answers are limited to it
    max_speed: float  # largest speed [m/s]; answers are limited to it
    seed: int  # seed of the run


class Goals(NamedTuple):
    """The places to which people walk."""

    position: Array  # next way-points (n, 2) [m], or nearest points of their lines
    stops: NDArray[np.bool_]  # (n,) whether the route ends at the goal, or a red light is there


class WallsAround(NamedTuple):
    """The walls, and the nearest one of each person."""

    distance: Array  # distances (n,) [m] of the centres from the nearest wall, or inf
    normal: Array  # unit vectors (n, 2) from this wall to its walkable side
    segments: Array  # walls (k, 4), x0, y0, x1, y1 [m], with the walkable side on the left


class Walkers(NamedTuple):
    """The pedestrians and their surroundings at t_k. The arrays are read-only."""

    position: Array  # centres of bodies (n, 2) [m]
    velocity: Array  # velocities (n, 2) [m/s]
    desired_speed: Array  # desired speeds (n,) [m/s]
    preferred: Array  # desired velocities (n, 2) [m/s] straight to the goal, slower before a stop
    goals: Goals
    ids: NDArray[np.int64]  # (n,) a number for each, the same in every run and in its twin
    vehicles: Array  # (m, 7) x, y, heading, speed, front, rear, width [m, rad, m/s]
    walls: WallsAround


class Accelerations(NamedTuple):
    """The acceleration of each pedestrian, constant over the step."""

    values: Array  # accelerations (n, 2) [m/s^2]


class Velocities(NamedTuple):
    """The velocity of each pedestrian at the end of the step; it changes linearly until then."""

    values: Array  # velocities (n, 2) [m/s]


Answer: TypeAlias = Accelerations | Velocities | Array
"""The type that ``step`` returns; a plain array is accelerations [m/s^2]."""


@runtime_checkable
class ModelPlugIn(Protocol):
    """A model of another package, made by ``Class(setup)`` or ``Class(setup, options)``.

    It may have these optional members:

    * ``Options`` of the class: a dataclass or pydantic model of the options that users may set;
    * ``reset()``: forget the past.

    It is made before the run, again for the counterfactual run, and for each ego that predicts with
    it. Its constructor must not start anything. A model that remembers something about a person
    must use ``ids``, because people come, go, and come back. If a controller predicts with it, it
    is reset before each prediction, and the predicted people are numbered from 0.
    """

    def step(self, walkers: Walkers, /) -> Answer:
        """Return the motion of all pedestrians from t_k to t_k+1."""
