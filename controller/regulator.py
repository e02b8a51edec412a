"""Who drives: the MPC where it has a plan, else the PID (Yang & Özgüner 2019, algorithm 1)."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Literal, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from controller.mpc import Mpc
    from controller.pid import Pid
    from controller.tuned_pid import TunedPid

STANDSTILL = 1e-9  # [m/s] below it the car stands and the brake's force does no work


class Observation(NamedTuple):
    """What the regulator sees at t_k."""

    position: float  # x_1(k) [m]
    speed: float  # x_2(k) [m/s]
    gap: float  # [m] to the closest pedestrian in front now; inf: nobody
    obstacle_positions: NDArray[np.float64]  # (N,) [m] x_p(k+1) ... x_p(k+N); inf: nobody
    speed_limit: float = inf  # [m/s] caps both reference speeds: a stop line, a vehicle ahead


class Decision(NamedTuple):
    """The force for [t_k, t_k+1], and how it came about."""

    force: float  # u(k) [N]
    acting: Literal["mpc", "pid", "safety"]
    reason: str  # "optimal", "infeasible", "solver: ...", "selected", or the safety layer's
    status: str  # of the QP; empty where none was posed
    iterations: int  # of the QP solver
    reference_speed: float  # [m/s] of the controller that acted
    plan: NDArray[np.float64] | None  # (N,) [N] of the MPC


class Regulator:
    """The MPC with the PID as its fallback, or the PID alone.

    Args:
        mpc: None to let the PID drive alone.
        pid: the fallback.
    """

    def __init__(self, mpc: Mpc | None, pid: Pid | TunedPid) -> None:
        self.mpc = mpc
        self.pid = pid
        self._previous_force = 0.0

    def reset(self) -> None:
        """Forget the past of both controllers."""
        self._previous_force = 0.0
        self.pid.reset()
        if self.mpc is not None:
            self.mpc.reset()

    def control(self, observation: Observation) -> Decision:
        """Decide on the force at t_k."""
        position, speed, gap, obstacle_positions, limit = observation
        if self.mpc is None:
            decision = self._by_pid(speed, gap, limit, "selected", "", 0)
        else:
            # At a standstill the force is a brake that holds: a plan may start from none, while
            # c2 would tie it to the braking before and c5 would then have no solution.
            previous = 0.0 if speed <= STANDSTILL else self._previous_force
            reference = min(self.mpc.parameters.reference_speed, limit)
            solution = self.mpc.solve(position, speed, previous, obstacle_positions, reference)
            if solution.found:
                self.pid.track(speed, gap, limit)
                decision = Decision(
                    solution.force,
                    "mpc",
                    "optimal",
                    solution.status,
                    solution.iterations,
                    reference,
                    solution.forces,
                )
            else:
                infeasible = solution.status.startswith("infeasible")
                reason = "infeasible" if infeasible else f"solver: {solution.status}"
                decision = self._by_pid(
                    speed, gap, limit, reason, solution.status, solution.iterations
                )
        self._previous_force = decision.force
        return decision

    def applied(self, force: float) -> None:
        """Another force [N] than the last one asked for acts: the next is asked for from there."""
        self._previous_force = force
        self.pid.applied(force)

    def _by_pid(
        self, speed: float, gap: float, limit: float, reason: str, status: str, iterations: int
    ) -> Decision:
        force = self.pid.control(speed, gap, limit)
        reference = self.pid.reference_speed(gap, limit)
        return Decision(force, "pid", reason, status, iterations, reference, None)
