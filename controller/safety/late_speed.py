"""The speed of a vehicle whose speed output lags behind its motion.

The output follows the speed with a first-order lag that is no longer than a known one. What the
last two outputs and the forces that may have acted allow is an interval of speeds
(docs/safety.md has its ends).

*Proof.* Let the output change from y to y' in a step. If its lag is the known one, the speed had
the mean w in this step, with weights that favour its end. If the lag is shorter, the mean lies
between y' and w. This bounds the speed at the end for every output that is as late, or less. The
interval of the step before, moved on by the largest force and by full braking, is the motion that
was tested then, so that the state at k + 1 is never worse than the one tested at k.
"""

from math import expm1

from controller.actuator import Actuator
from controller.model import LongitudinalModel
from controller.safety.actuator_bound import Lagging, bound_step
from controller.safety.layer import motion_of, past_commands


class LateSpeed:
    """An estimate of the speed, and an interval that contains it.

    Args:
        model: Model of the vehicle's motion.
        lag: Longest lag [s] of the speed output.
        actuator: Worst actuator that the vehicle may have.
        force_limit: Largest force [N].

    Attributes:
        least: Least speed [m/s] that the vehicle may have.
        most: Largest speed [m/s] that it may have.
    """

    def __init__(
        self, model: LongitudinalModel, lag: float, actuator: Actuator, force_limit: float
    ) -> None:
        dt = model.time_step
        self._ahead = lag / dt  # steps by which the output is behind
        self._share = 1.0 / expm1(dt / lag)
        self._actuator, self._lagging = actuator, Lagging.of(actuator, dt)
        limit = min(force_limit, actuator.brake.limit)
        self._motion, self._mass, self._half = motion_of(model, limit), model.mass, 0.5 * dt
        self._commands, self._state = past_commands(actuator.dead_time, dt), (0.0, 0.0, 0.0)
        self._output: float | None = None
        self._rise = 0.0  # largest acceleration [m/s^2] in the last step
        self.least = self.most = 0.0

    def look(self, output: float) -> float:
        """Return an estimate of the speed [m/s], and find its bounds; once in each control step.

        Args:
            output: Speed output [m/s].
        """
        if self._output is None:  # before, the vehicle is taken to have kept its speed
            self._output = self.least = self.most = output
        change, self._output = output - self._output, output
        mean = output + self._share * change  # of the last step, if the lag is the longest one
        motion, friction = self._motion, 1.0 - self._motion.fastest_decay
        fall = motion.gain * motion.force_limit + friction * self.most
        high = max(output, mean) + self._half * self._rise
        low = min(output, mean) - 0.5 * fall
        # If the model is wrong, as on a slope, the output is right.
        most = high if low > self.most else min(high, self.most)
        least = low if high < self.least else max(low, self.least)
        self.most, self.least = max(most, 0.0), max(least, 0.0)
        return max(output + self._ahead * change, 0.0)

    def applied(self, force: float) -> None:
        """Move the bounds on by the step from now on, in which a ``force`` [N] is commanded."""
        commands, c = self._commands, self._motion
        commands[:-1] = commands[1:]
        commands[-1] = self._actuator.acting(force)
        strongest = max(float(commands.max()), -c.force_limit)
        driven, braked, ends, self._state = bound_step(strongest, self._state, self._lagging)
        self._rise = max(*ends, 0.0) / self._mass
        gained = driven * c.gain - braked * c.braking_gain
        self.most = max(0.0, c.slowest_decay * self.most + gained)
        self.least = max(0.0, c.fastest_decay * self.least - c.gain * c.force_limit)
