"""The planning MPC, and where it has no plan the well-tuned PID."""

from __future__ import annotations

from typing import TYPE_CHECKING

from controller.defaults import STANDSTILL
from controller.protocol import Decision

if TYPE_CHECKING:
    from controller.planning.planner import Planner
    from controller.protocol import Observation
    from controller.tuned_pid import TunedPid


class PlanningController:
    """The planner with a PID as its fallback.

    With a soft corridor there always is a plan; only a hard one (``soft`` off) needs the fallback.

    Args:
        planner: plans.
        pid: the fallback.
    """

    foresees = True

    def __init__(self, planner: Planner, pid: TunedPid) -> None:
        self.planner = planner
        self.pid = pid
        self._previous_force = 0.0

    @property
    def horizon(self) -> int:
        """Steps that the plan looks ahead."""
        return self.planner.parameters.horizon

    def reset(self) -> None:
        """Forget the past of both controllers."""
        self._previous_force = 0.0
        self.pid.reset()
        self.planner.reset()

    def control(self, observation: Observation) -> Decision:
        """Decide on the force at t_k."""
        speed, gap, limit = observation.speed, observation.gap, observation.speed_limit
        previous = 0.0 if speed <= STANDSTILL else self._previous_force
        reference = min(self.planner.parameters.reference_speed, limit)
        plan = self.planner.plan(
            speed, previous, reference, observation.allowed, observation.foresight
        )
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
