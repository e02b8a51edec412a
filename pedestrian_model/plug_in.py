"""The protocol of pedestrian models of other packages.

A class of an installed package is a pedestrian model if it can be made from a :class:`ModelSetup`
(and its options, if it has any) and has the method ``step``. docs/plugins.md is the guide.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol, TypeAlias, runtime_checkable

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]


class ModelSetup(NamedTuple):
    """The facts of a run that do not change; a model is told once, when it is made."""

    time_step: float  # h [s] from one step to the next
    body_radius: float  # [m] of everybody
    max_acceleration: float  # [m/s^2] nobody has more: what is answered is limited to it
    max_speed: float  # [m/s] nobody is faster: likewise
    seed: int  # of the run


class Walkers(NamedTuple):
    """All who walk, and what they walk among, at t_k; the arrays cannot be written."""

    position: Array  # (n, 2) [m] centres of bodies
    velocity: Array  # (n, 2) [m/s]
    desired_speed: Array  # (n,) [m/s]
    preferred: Array  # (n, 2) [m/s] straight to the goal at the desired speed, slower to stop there
    goal: Array  # (n, 2) [m] the next way-point, or the nearest point of its line
    stops: NDArray[np.bool_]  # (n,) whether the way ends there, or a red light holds it
    ids: NDArray[np.int64]  # (n,) a number for each, the same in every run and in its twin
    vehicles: Array  # (m, 7) x, y, heading, speed, front, rear, width [m, rad, m/s]
    wall_distance: Array  # (n,) [m] of the centre from the nearest wall; inf: none near
    wall_normal: Array  # (n, 2) unit vector from it, into where people may walk
    walls: Array  # (k, 4) [m] x0, y0, x1, y1, the walkable side on the left


class Accelerations(NamedTuple):
    """The acceleration of each, constant over the step."""

    values: Array  # (n, 2) [m/s^2]


class Velocities(NamedTuple):
    """The velocity that each has at the end of the step; on the way it changes evenly."""

    values: Array  # (n, 2) [m/s]


Answer: TypeAlias = Accelerations | Velocities | Array
"""What ``step`` returns; a mere array is accelerations [m/s^2]."""


@runtime_checkable
class ModelPlugIn(Protocol):
    """Somebody else's model, made by ``Class(setup)`` or ``Class(setup, options)``.

    It may have, and has to have neither of:

    * ``Options``, of the class: a dataclass or pydantic model of what users may set;
    * ``reset()``: forget the past.

    It is made before the run, once more for the run's twin and for each ego that believes in it,
    and so starts nothing then. Who keeps something of a person keeps it by ``ids``: people come,
    go, and come back. Where a controller predicts by it, it is reset before each prediction, and
    those who matter to that are numbered from 0.
    """

    def step(self, walkers: Walkers, /) -> Answer:
        """Return how everybody moves from t_k to t_k+1."""
