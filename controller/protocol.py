"""The protocol of a controller: its answer, and how it is asked."""

from typing import Literal, NamedTuple, Protocol

from controller._jit import Array
from controller.observation import Observation


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
        """Return whether it asks ``foresight`` about people instead of ``obstacle_positions``."""

    def reset(self) -> None:
        """Forget the past."""

    def control(self, observation: Observation) -> Decision:
        """Decide on the force at t_k."""

    def applied(self, force: float) -> None:
        """Another force [N] than the last one asked for acts: the next is asked for from there."""
