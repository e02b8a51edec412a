"""What every controller sees, what it answers, and how it is asked."""

from math import inf
from typing import Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from controller._jit import Array
from controller.defaults import SAFE_DISTANCE
from controller.foresight import Foresight


class PathAhead(Protocol):
    """The ego's path from its front bumper on; a number is computed only when it is asked for."""

    def remaining(self) -> float:
        """How much of the path is left [m]."""

    def poses(self, distances: Array) -> Array:
        """(k, 3) x, y [m] and heading [rad] of the path at ``distances`` (k,) [m] ahead."""

    def curvature(self, distances: Array) -> Array:
        """(k,) [1/m] of the path at ``distances`` (k,) [m] ahead; positive to the left."""


class People(Protocol):
    """The pedestrians as the ego sees them."""

    @property
    def position(self) -> Array:
        """(n, 2) [m] centres, in the network's frame."""

    @property
    def velocity(self) -> Array:
        """(n, 2) [m/s]."""


class Observation(NamedTuple):
    """What a controller sees at t_k; what its world does not tell it has a default.

    Arrays are references to the co-simulation's own: they are valid until the force is returned,
    and not to be changed. Whoever wants to keep one copies it.
    """

    position: float  # x_1(k) [m] station of the point that keeps the safe distance
    speed: float  # x_2(k) [m/s]
    gap: float  # [m] from ``position`` to whatever is closest in front now; inf: nothing
    obstacle_positions: Array  # (N,) [m] x_p(k+1) ... x_p(k+N), stations; inf: nothing in front
    speed_limit: float = inf  # [m/s] for a stop line, a vehicle ahead or the lane; inf: none
    safe_distance: float = SAFE_DISTANCE  # [m] to be kept to obstacles
    foresight: Foresight | None = None  # None: nobody can get in the way within the horizon
    time: float = 0.0  # t_k [s] on SUMO's clock
    acceleration: float = 0.0  # [m/s^2] of the ego
    force: float = 0.0  # u(k-1) [N] that acted in the step before
    stop_gap: float = inf  # [m] from the front bumper to where it has to stop; inf: nowhere
    path: PathAhead | None = None  # None: a straight line without end
    people: People | None = None  # None: nobody
    vehicles: Array | None = None  # (N, m, 7) all, now and predicted: x, y, heading, speed, front,
    row: int = 0  # rear, width; the ego's own stand in this row (None: there is no other vehicle)
    lane_speeds: Array | None = None  # (N,) [m/s] not exceeded at k+1 ... k+N; None: any may be
    person_gap: float = inf  # [m] from ``position`` to the closest person in front; inf: nobody
    leader_gap: float = inf  # [m] from ``position`` to the vehicle in front; inf: none
    leader_speed: float = 0.0  # [m/s] of that vehicle
    person_ids: NDArray[np.int64] | None = None  # (n,) of ``people``; a person keeps its number
    to_clear: float = 0.0  # [m] to be driven on to leave the crossings and junctions it is on


class Decision(NamedTuple):
    """The force for [t_k, t_k+1], and how it came about."""

    force: float  # u(k) [N]
    acting: Literal["mpc", "pid", "plug-in", "safety"]
    reason: str  # "optimal", "infeasible", "solver: ...", "selected", or the plug-in's own
    status: str  # of the QP; empty where none was posed
    iterations: int  # of the QP solver
    reference_speed: float  # [m/s] of the controller that acted
    plan: Array | None  # (N,) [N] of the MPC


class Controller(Protocol):
    """Decides on the ego's force in each step."""

    @property
    def horizon(self) -> int:
        """N, the steps that it looks ahead; 0: it looks at the present only."""

    @property
    def foresees(self) -> bool:
        """Whether it asks ``Observation.foresight`` about people, not ``obstacle_positions``."""

    def reset(self) -> None:
        """Forget the past."""

    def control(self, observation: Observation) -> Decision:
        """Decide on the force at t_k."""

    def applied(self, force: float) -> None:
        """Another force [N] than the last one asked for acts: the next is asked for from there."""
