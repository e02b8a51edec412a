"""An upper bound of the force that acts, for every actuator that is as good as its description.

A description has a dead time, a lag and a rate. An actuator is as good if its dead time and lag
are no longer and its rate is no lower, all of which may vary. Whether driving and braking are two
actuators or one does not matter.

*Theorem.* The force that acts is at most G - H: X bounds the force behind the rate limit, G bounds
the driving force from above, and H bounds the braking force from below.

*Proof.* Let f be the force of one actuator for both signs, f' = (c(t) - f)/tau', with tau' no
longer than the lag that applies and c(t) <= X. Where f = G - H, G has reached its target or falls
with (max(X, 0) - G)/tau, and H likewise, so that f' <= G' - H'. The deviations have the sign that
makes a longer lag the larger bound: f cannot pass G - H. With two actuators, f_d <= G and f_b >= H
in the same way. A rate limit before or behind the lag lets the force fall no slower than X and then
the lag. In a step the bounds are integrated exactly. As the force falls within it, the speed is
above the straight line between its ends by no more than the fall times dt/(8 M), and this is added
to the distance.
"""

from typing import NamedTuple

from controller._jit import Array, inner
from controller.actuator import Actuator, lag_shares


class Lagging(NamedTuple):
    """The shares of a force's deviation that are left after a step, and in its mean."""

    drive_end: float = 0.0  # share of a driving force that is left after a step
    drive_mean: float = 0.0  # this share in the mean of the step
    brake_end: float = 0.0  # share of a lack of braking force that is left after a step
    brake_mean: float = 0.0  # this share in the mean of the step
    fall: float = 0.0  # largest fall of the force [N per step]; 0 without such a limit

    @classmethod
    def of(cls, actuator: Actuator, time_step: float) -> "Lagging":
        """The shares of an actuator, in steps of ``time_step`` [s]."""
        drive, brake = actuator.drive, actuator.brake
        rate = min(drive.rate, brake.rate) * time_step
        return cls(
            *lag_shares(max(drive.lag, brake.lag), time_step),
            *lag_shares(brake.lag, time_step),
            0.0 if rate == float("inf") else rate,
        )


@inner
def bound_step(
    command: float, state: tuple[float, float, float], c: Lagging
) -> tuple[float, float, tuple[float, float], tuple[float, float, float]]:
    """Return bounds of the forces that act in a step, and the state after it.

    Args:
        command: Largest force [N] that has passed the dead time in this step.
        state: Upper bound [N] of the force that has passed the rate limit, upper bound of the
            driving force that acts, and lower bound of the braking force that acts.
        c: Lags and rate of the actuator.

    Returns:
        Largest mean driving force [N]; least mean braking force [N]; largest force [N] at the
        beginning and at the end of the step; the state.
    """
    passed, drives, brakes = state
    target = command
    if c.fall > 0.0:
        target = max(command, passed)
        passed = max(command, passed - c.fall)
    else:
        passed = command
    up, down = max(target, 0.0), max(-target, 0.0)
    drives = max(drives, up) if c.drive_mean > 0.0 else up
    brakes = min(brakes, down) if c.brake_mean > 0.0 else down
    extra, lack = drives - up, down - brakes
    driven, braked = up + extra * c.drive_mean, down - lack * c.brake_mean
    after, brakes_after = up + extra * c.drive_end, down - lack * c.brake_end
    ends = drives - brakes, after - brakes_after
    return driven, braked, ends, (passed, after, brakes_after)


@inner
def advance_bound(command: float, acting: Array, c: Lagging) -> None:
    """Move the state in ``acting`` (3,) on by one step, see :func:`bound_step`."""
    _, _, _, state = bound_step(command, (acting[0], acting[1], acting[2]), c)
    acting[0], acting[1], acting[2] = state
