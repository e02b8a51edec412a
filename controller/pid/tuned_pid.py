"""A well-tuned PID, the fair competitor of the planning MPC (``pid-tuned``)."""

from dataclasses import dataclass, field
from math import inf, isfinite

from controller.defaults import FORCE_LIMIT, FORCE_RATE_LIMIT, STANDSTILL
from controller.errors import ParameterError
from controller.model import LongitudinalModel
from controller.parameters import require_not_negative, require_positive
from controller.pid.speed_reference import ReferenceParameters, SpeedReference

_TRANSIENT = 0.5  # acceleration [m/s^2] of the reference, above which errors are not integrated


@dataclass(frozen=True, slots=True)
class TunedPidParameters:
    """The closed loop's bandwidth and damping, and the actuator's limits.

    The gains place both poles of M v' + alpha v = u by bandwidth and damping, so they scale with
    the vehicle. benchmarks/tuning/tune_pid.py finds the defaults.
    """

    bandwidth: float = 2.5  # omega_0 [rad/s] of the closed loop s^2 + 2 zeta omega_0 s + omega_0^2
    damping: float = 0.85  # zeta [-]
    acceleration_feed_forward: bool = True  # whether M dv_ref/dt is added to alpha v_ref
    force_limit: float = FORCE_LIMIT  # u_max [N]
    force_rate_limit: float = FORCE_RATE_LIMIT  # du_max [N per step]
    reference: ReferenceParameters = field(default_factory=ReferenceParameters)

    def __post_init__(self) -> None:
        require_positive("bandwidth", self.bandwidth, "rad/s")
        require_positive("damping", self.damping, "-")
        require_positive("force_limit", self.force_limit, "N")
        require_positive("force_rate_limit", self.force_rate_limit, "N per step")

    def gains(self, model: LongitudinalModel) -> tuple[float, float]:
        """Return K_p [N s/m] and K_i [N/m] by pole placement for a first-order plant.

        Åström & Hägglund 2006, Advanced PID Control, section 6.4. There is no derivative part: for
        a first-order plant it would only act like additional mass.
        """
        K_p = 2.0 * self.damping * self.bandwidth * model.mass - model.friction
        return max(K_p, 0.0), self.bandwidth**2 * model.mass


class TunedPid:
    """u = alpha v_ref + M dv_ref/dt + K_p e + u_i, e = v_ref - v, within the actuator's limits.

    * The reference is smooth (:class:`SpeedReference`). The feed-forward alone drives the modelled
      vehicle along it, and the feedback corrects the model's errors only.
    * Anti-windup uses back-calculation with the tracking time K_p / K_i. The reference is
      conditioned by the same amount (Hanus, Kinnaert & Henrotte 1987), so that it never runs ahead
      of the actuator.
    * Under a speed limit of 0 the force is not positive, except while the rate limit lowers it.

    Args:
        parameters: Parameters of loop, actuator and reference, or None for the defaults.
        model: Model of the vehicle, with the control step, or None for the defaults.
    """

    def __init__(
        self,
        parameters: TunedPidParameters | None = None,
        model: LongitudinalModel | None = None,
    ) -> None:
        self.parameters = p = parameters or TunedPidParameters()
        self.model = model = model or LongitudinalModel()
        require_not_negative("friction", model.friction, "N s/m")
        self.time_step = dt = model.time_step
        self.K_p, self.K_i = p.gains(model)
        strongest = p.force_limit / model.mass
        sharpest = p.force_rate_limit / (model.mass * dt)
        self.reference = SpeedReference(p.reference, strongest, sharpest, dt)
        self.reset()

    def reset(self) -> None:
        """Forget the past: the reference begins at the next speed, and the integrator at 0."""
        self._integral = 0.0  # integral part u_i(k) [N]
        self._force = 0.0  # force u(k-1) [N]
        self._speed = 0.0  # speed v(k) [m/s]
        self._started = False

    def reference_speed(self, gap: float, limit: float = inf) -> float:
        """The target speed [m/s] at ``gap`` [m], at most ``limit`` [m/s]."""
        return self.reference.target(gap, limit)

    def control(
        self,
        speed: float,
        gap: float,
        limit: float = inf,
        reach: tuple[float, float] = (-inf, inf),
    ) -> float:
        """Return the force u(k) [N].

        Args:
            speed: Speed v(k) [m/s].
            gap: Distance to the closest pedestrian in front [m]; inf without one.
            limit: Upper bound on the reference speed [m/s].
            reach: Least and largest force [N] that can act in this step.

        Raises:
            ParameterError: speed or gap is not a number.
        """
        if not isfinite(speed) or gap != gap or limit != limit:
            raise ParameterError(f"speed = {speed} m/s, gap = {gap} m: expected numbers")
        p = self.parameters
        if not self._started:
            self._begin(speed, self.model.friction * speed)
            self._force = 0.0
        self._speed = speed
        if speed <= STANDSTILL:
            self._stand()
        v_ref, a_ref = self.reference.advance(speed, gap, limit)
        e = v_ref - speed
        wanted = self._feed_forward(v_ref, a_ref) + self.K_p * e + self._integral
        low = max(-p.force_limit, self._force - p.force_rate_limit)
        high = min(p.force_limit, self._force + p.force_rate_limit)
        if limit <= 0.0:
            high = max(low, min(high, 0.0))
        low, high = min(max(low, reach[0]), reach[1]), min(max(high, reach[0]), reach[1])
        force = min(max(wanted, low), high)
        settled = max(0.0, 1.0 - abs(a_ref) / _TRANSIENT)
        self._learn(settled * e, force - wanted)
        self._force = force
        return force

    def track(
        self, speed: float, gap: float, limit: float = inf, force: float | None = None
    ) -> None:
        """Follow another controller that acts with ``force`` [N], for a takeover without a jump."""
        del gap, limit  # the reference starts at the present speed
        self._begin(speed, self.model.friction * speed if force is None else force)

    def applied(self, force: float) -> None:
        """Let the reference continue from a ``force`` [N] other than the last command."""
        model, speed = self.model, self._speed
        after = model.decay * speed + model.speed_per_force * force
        self.reference.start(after, (force - model.friction * speed) / model.mass)
        self._force = force

    def _begin(self, speed: float, force: float) -> None:
        model = self.model
        acceleration = (force - model.friction * speed) / model.mass
        self.reference.start(speed, acceleration)
        self._integral = force - self._feed_forward(speed, acceleration)
        self._force = force
        self._started = True

    def _stand(self) -> None:
        """Reset at standstill, where the brake only holds and does not limit the next force."""
        if self.reference.acceleration <= 0.0:
            self.reference.start(0.0)
            self._integral = 0.0
            self._force = 0.0

    def _feed_forward(self, v_ref: float, a_ref: float) -> float:
        force = self.model.friction * v_ref
        return (
            force + self.model.mass * a_ref if self.parameters.acceleration_feed_forward else force
        )

    def _learn(self, e: float, cut: float) -> None:
        """Integrate the error ``e`` [m/s], with anti-windup for the force ``cut`` off [N].

        Args:
            e: Speed error [m/s].
            cut: Limited minus wanted force [N].
        """
        dt = self.time_step
        reachable = cut / (self.K_p + self.model.friction) if self.K_p > 0.0 else 0.0  # [m/s]
        self._integral += self.K_i * dt * (e + reachable)
        self.reference.speed = max(0.0, self.reference.speed + reachable)
