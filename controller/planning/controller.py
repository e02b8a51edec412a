"""The planning MPC, and where it has no plan the well-tuned PID."""

from __future__ import annotations

from math import inf
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
        self._planned_at: float | None = None  # speed [m/s] of the last step, if it had a plan
        self._overruled_by: float | None = None  # force [N] that acted instead in that step

    @property
    def horizon(self) -> int:
        """Steps that the plan looks ahead."""
        return self.planner.parameters.horizon

    def reset(self) -> None:
        """Forget the past of both controllers."""
        self._previous_force = 0.0
        self._planned_at = self._overruled_by = None
        self.pid.reset()
        self.planner.reset()

    def control(self, observation: Observation) -> Decision:
        """Decide on the force at t_k."""
        speed, gap, limit = observation.speed, observation.gap, observation.speed_limit
        previous = 0.0 if speed <= STANDSTILL else self._previous_force
        reference = min(self.planner.parameters.reference_speed, limit)
        allowed = observation.obstacle_positions - (
            observation.position + observation.safe_distance
        )
        plan = self.planner.plan(speed, previous, reference, allowed, observation.foresight)
        if plan.found:
            force = plan.force
            if speed <= STANDSTILL and force < 0.0:
                force = 0.0  # the brake holds without work
            self._planned_at = speed
            decision = Decision(
                force, "mpc", plan.manoeuvre, plan.status, plan.iterations, reference, None
            )
        else:
            self._bring_up_to_date()
            force = self.pid.control(speed, gap, limit)
            wanted = self.pid.reference_speed(gap, limit)
            decision = Decision(
                force, "pid", "infeasible", plan.status, plan.iterations, wanted, None
            )
        self._previous_force = decision.force
        self._overruled_by = None
        return decision

    def applied(self, force: float) -> None:
        """Another force [N] than the last one asked for acts: the next is asked for from there."""
        self._previous_force = force
        if self._planned_at is None:
            self.pid.applied(force)
        else:
            self._overruled_by = force

    def _bring_up_to_date(self) -> None:
        """Let the PID go on from the last step, in which the planner acted.

        It remembers nothing of the steps before that, so that it need not be told of each.
        """
        if self._planned_at is not None:
            self.pid.track(self._planned_at, inf)
            if self._overruled_by is not None:
                self.pid.applied(self._overruled_by)
        self._planned_at = None
