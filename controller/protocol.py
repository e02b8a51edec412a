"""The protocol of a controller: its answer, and how it is asked."""

from typing import Literal, NamedTuple, Protocol

from controller._jit import Array
from controller.observation import Observation


class Decision(NamedTuple):
    """The force for [t_k, t_k+1], and how it was found."""

    force: float  # force u(k) [N]
    acting: Literal["mpc", "pid", "plug-in", "safety"]
    reason: str  # "optimal", "infeasible", "solver: ...", "selected", or the plug-in's reason
    status: str  # outcome of the QP; empty without a QP
    iterations: int  # iterations of the QP solver
    reference_speed: float  # reference speed [m/s] of the controller that acted
    plan: Array | None  # planned forces (N,) [N] of the paper's MPC


class Controller(Protocol):
    """A controller, which decides on the ego's force in each step."""

    @property
    def horizon(self) -> int:
        """The prediction horizon N [steps]; 0 if the controller does not look ahead."""

    @property
    def foresees(self) -> bool:
        """Return whether the controller uses ``foresight`` instead of ``obstacle_positions``."""

    def reset(self) -> None:
        """Forget the past."""

    def control(self, observation: Observation) -> Decision:
        """Decide on the force [N] at t_k."""

    def applied(self, force: float) -> None:
        """Take note that the safety layer applied ``force`` [N] instead of the last command.

        Rate limits and integrators continue from this force.
        """
