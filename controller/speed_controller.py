"""The paper's MPC with a PID as fallback (Yang & Özgüner 2019, algorithm 1), or a PID alone."""

from controller.actuator import Actuator, Anticipation
from controller.defaults import STANDSTILL
from controller.observation import Observation
from controller.paper_mpc.mpc import Mpc
from controller.pid.pid import Pid
from controller.pid.tuned_pid import TunedPid
from controller.protocol import Decision


class SpeedController:
    """The MPC with the PID as its fallback, or the PID alone.

    Args:
        mpc: MPC, or None to let the PID drive alone.
        pid: PID, which acts if the MPC has no plan.
        actuator: Actuator of the vehicle, known to the tuned PID only; None if each force acts at
            once.
    """

    foresees = False

    def __init__(
        self, mpc: Mpc | None, pid: Pid | TunedPid, actuator: Actuator | None = None
    ) -> None:
        self.mpc = mpc
        self.pid = pid
        self._anticipation: Anticipation | None = None
        if actuator is not None and not actuator.ideal and isinstance(pid, TunedPid):
            self._anticipation = Anticipation(pid.model, actuator)
        self._previous_force = 0.0

    @property
    def horizon(self) -> int:
        """The prediction horizon [steps] of the MPC; 0 for the PID alone."""
        return 0 if self.mpc is None else self.mpc.parameters.horizon

    def reset(self) -> None:
        """Forget the past of both controllers."""
        self._previous_force = 0.0
        self.pid.reset()
        if self._anticipation is not None:
            self._anticipation.reset()
        if self.mpc is not None:
            self.mpc.reset()

    def control(self, observation: Observation) -> Decision:
        """Decide on the force at t_k."""
        ego, ahead, limit = observation.ego, observation.ahead, observation.limits.speed_limit
        speed, gap = ego.speed, ahead.gap
        if self.mpc is None:
            decision = self._by_pid(speed, gap, limit, "selected", "", 0)
        else:
            # At standstill the brake only holds, so a plan may start from a force of 0. With the
            # braking force of before, the rate limit c2 would leave no solution that keeps c5.
            previous = 0.0 if speed <= STANDSTILL else self._previous_force
            reference = min(self.mpc.parameters.reference_speed, limit)
            solution = self.mpc.solve(
                ego.position, speed, previous, ahead.obstacle_positions, reference
            )
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
        """Continue from the ``force`` [N] that the safety layer applied instead of the last one."""
        self._previous_force = force
        if self._anticipation is not None:
            force = self._anticipation.applied(force)
        self.pid.applied(force)

    def _by_pid(
        self, speed: float, gap: float, limit: float, reason: str, status: str, iterations: int
    ) -> Decision:
        if isinstance(self.pid, TunedPid) and self._anticipation is not None:
            ahead = self._anticipation.look(speed)
            gap -= ahead.travel
            force = self.pid.control(ahead.speed, gap, limit, (ahead.least, ahead.most))
            force = self._anticipation.command([force])
        else:
            force = self.pid.control(speed, gap, limit)
        reference = self.pid.reference_speed(gap, limit)
        return Decision(force, "pid", reason, status, iterations, reference, None)
