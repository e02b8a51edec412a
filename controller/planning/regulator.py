"""Who drives: the planning MPC, and where it has no plan the well-tuned PID."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from controller.regulator import STANDSTILL, Decision

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from controller.planning.planner import Planner
    from controller.planning.search import Foresight
    from controller.tuned_pid import TunedPid

    Array = NDArray[np.float64]


class Situation(NamedTuple):
    """What the planning regulator sees at t_k."""

    speed: float  # x_2(k) [m/s]
    gap: float  # [m] to whatever is closest in front now; inf: nothing
    speed_limit: float  # [m/s] caps the reference speed: a stop line, a vehicle ahead
    allowed: Array | None  # (N,) [m] that may be driven until 1 ... N: vehicles, lights; None: all
    foresight: Foresight | None  # None: nobody can get in the way within the horizon


class PlanningRegulator:
    """The planner with a PID as its fallback.

    With a soft corridor there always is a plan; only a hard one (``soft`` off) needs the fallback.

    Args:
        planner: plans.
        pid: the fallback.
    """

    def __init__(self, planner: Planner, pid: TunedPid) -> None:
        self.planner = planner
        self.pid = pid
        self._previous_force = 0.0

    def reset(self) -> None:
        """Forget the past of both controllers."""
        self._previous_force = 0.0
        self.pid.reset()
        self.planner.reset()

    def control(self, situation: Situation) -> Decision:
        """Decide on the force at t_k."""
        speed, gap, limit, allowed, foresight = situation
        previous = 0.0 if speed <= STANDSTILL else self._previous_force
        reference = min(self.planner.parameters.reference_speed, limit)
        plan = self.planner.plan(speed, previous, reference, allowed, foresight)
        if plan.found:
            force = plan.force
            if speed <= STANDSTILL and force < 0.0:
                force = 0.0  # the brake holds without work
            self.pid.track(speed, gap, limit)
            decision = Decision(
                force, "mpc", plan.manoeuvre, plan.status, plan.iterations, reference, None
            )
        else:
            force = self.pid.control(speed, gap, limit)
            wanted = self.pid.reference_speed(gap, limit)
            decision = Decision(
                force, "pid", "infeasible", plan.status, plan.iterations, wanted, None
            )
        self._previous_force = decision.force
        return decision

    def applied(self, force: float) -> None:
        """Another force [N] than the last one asked for acts: the next is asked for from there."""
        self._previous_force = force
        self.pid.applied(force)
