"""The PID controller of Yang & Özgüner 2019, section 3.4: the MPC's fallback and competitor."""

from math import inf, isfinite

from controller.defaults import TIME_STEP
from controller.errors import ParameterError
from controller.parameters import PidParameters, require_positive


class Pid:
    """u = -(u_p + u_i + u_d) on the speed error e = v - v_ref, clipped to the force limit.

    The reference speed falls linearly with the gap: v_r clip((gap - d_safe) / d_buffer, 0, 1).
    As in the paper, the output has no rate limit and the integrator has no anti-windup. One thing
    is added: under a speed limit of 0, which the paper does not have, the integrator never drives.

    Args:
        parameters: Gains and distances, or None for the defaults.
        time_step: Control step dt [s].

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
        """Forget the past: the next error is also the previous one, and the integrator is 0."""
        self._integral = 0.0  # integral part u_i(k-1) [N]
        self._error: float | None = None  # speed error e(k-1) [m/s]

    def reference_speed(self, gap: float, limit: float = inf) -> float:
        """The reference speed v_r^PID [m/s] (figure 3).

        Args:
            gap: Distance [m] to the closest pedestrian in front.
            limit: Upper bound [m/s] of the result, for lights and other vehicles. It is not in the
                paper.
        """
        p = self.parameters
        share = min(max((gap - p.safe_distance) / p.buffer_distance, 0.0), 1.0)
        return min(p.reference_speed * share, limit)

    def control(self, speed: float, gap: float, limit: float = inf) -> float:
        """Return the force u(k) [N].

        Args:
            speed: Speed x_2(k) [m/s].
            gap: Distance x_p(k) - x_1(k) [m] to the closest pedestrian in front; inf without one.
            limit: Upper bound [m/s] of the reference speed.

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
            # Added to the paper, as the limit is: an integral from driving at a higher speed would
            # move the car over the stop line for minutes (K_p / K_i = 240 s).
            u_i = max(u_i, 0.0)
        u_d = p.K_d * (e - before) / dt
        self._integral, self._error = u_i, e
        return min(max(-(u_p + u_i + u_d), -p.force_limit), p.force_limit)

    def applied(self, force: float) -> None:
        """Do nothing: as in the paper, the PID does not depend on the ``force`` [N] that acts."""

    def track(self, speed: float, gap: float, limit: float = inf) -> None:
        """Reset the integrator and set e(k-1) to the present error, while the MPC acts.

        The PID then takes over without a derivative kick and without an integral of errors that
        another controller caused. Arguments are as for :meth:`control`.
        """
        self._integral = 0.0
        self._error = speed - self.reference_speed(gap, limit)
