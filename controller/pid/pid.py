"""The PID controller of Yang & Özgüner 2019, section 3.4: the MPC's fallback and its rival."""

from math import inf, isfinite

from controller.defaults import TIME_STEP
from controller.errors import ParameterError
from controller.parameters import PidParameters, require_positive


class Pid:
    """u = -(u_p + u_i + u_d) on the speed error e = v - v_ref, clipped to the force limit.

    The reference speed falls linearly with the gap: v_r clip((gap - d_safe) / d_buffer, 0, 1).
    As printed, the output is not rate-limited and the integrator has no anti-windup; only where
    a limit of 0 wants the car to stand, which the paper does not know, it does not drive.

    Args:
        parameters: gains and distances.
        time_step: dt [s].

    Raises:
        ParameterError: the time step is not positive.
    """

    def __init__(
        self, parameters: PidParameters | None = None, time_step: float = TIME_STEP
    ) -> None:
        require_positive("time_step", time_step, "s")
        self.parameters = parameters or PidParameters()
        self.time_step = time_step
        self.reset()

    def reset(self) -> None:
        """Forget the past: the next error is also the previous one, the integrator is empty."""
        self._integral = 0.0  # u_i(k-1) [N]
        self._error: float | None = None  # e(k-1) [m/s]

    def reference_speed(self, gap: float, limit: float = inf) -> float:
        """v_r^PID [m/s] at ``gap`` [m] to the closest pedestrian in front (figure 3).

        Never more than ``limit`` [m/s] (ours; the paper knows neither lights nor other cars).
        """
        p = self.parameters
        share = min(max((gap - p.safe_distance) / p.buffer_distance, 0.0), 1.0)
        return min(p.reference_speed * share, limit)

    def control(self, speed: float, gap: float, limit: float = inf) -> float:
        """The force u(k) [N].

        Args:
            speed: x_2(k) [m/s].
            gap: x_p(k) - x_1(k) [m]; inf when nobody is in front.
            limit: caps the reference speed [m/s].

        Raises:
            ParameterError: speed or gap is not a number.
        """
        p, dt = self.parameters, self.time_step
        e = speed - self.reference_speed(gap, limit)
        if not isfinite(e):
            raise ParameterError(f"speed = {speed} m/s, gap = {gap} m: expected numbers")
        before = e if self._error is None else self._error
        u_p = p.K_p * e
        u_i = p.K_i * e * dt + self._integral
        if limit <= 0.0:
            # Ours, as the limit is: what has been wound up on the way to a higher speed would
            # creep over the stop line, for minutes (K_p / K_i = 240 s).
            u_i = max(u_i, 0.0)
        u_d = p.K_d * (e - before) / dt
        self._integral, self._error = u_i, e
        return min(max(-(u_p + u_i + u_d), -p.force_limit), p.force_limit)

    def applied(self, force: float) -> None:
        """Another force [N] than was asked for acts; as printed, the PID does not look at it."""

    def track(self, speed: float, gap: float, limit: float = inf) -> None:
        """Empty the integrator and keep e(k-1) at the current error while the MPC acts.

        The PID then takes over without a derivative kick and without an integral of errors that
        another controller caused.
        """
        self._integral = 0.0
        self._error = speed - self.reference_speed(gap, limit)
