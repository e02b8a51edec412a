"""The driver of a brake test: holds one speed, and takes the foot off once the safety layer brakes.

Euro NCAP's tests are driven so: the car has the test's speed until its emergency brake acts, and
nobody steers or brakes. The driver is an example of the plug-in protocol,
:mod:`controller.plug_in`.
"""

from controller.observation import Observation
from controller.plug_in import Acceleration, Defaults, Force, Setup

_GAIN = 1.0  # gain [1/s] of the speed's error
_INTEGRAL_GAIN = 0.25  # gain [1/s^2] of its integral: critically damped
_MOST = 3.0  # largest acceleration [m/s^2] either way


class SpeedHolder:
    """Holds the reference speed and ignores everybody.

    Args:
        setup: Setup of the drive.
    """

    defaults = Defaults(heeds_priority=False, tracker=False)

    def __init__(self, setup: Setup) -> None:
        self._setup = setup
        self.reset()

    def reset(self) -> None:
        """Forget the past."""
        self._integral = 0.0  # [m]
        self._released = False

    def control(self, seen: Observation) -> Acceleration | Force:
        """Return the acceleration to the reference speed, or no force once it was overruled."""
        if self._released:
            return Force(0.0, "released")
        error = self._setup.reference_speed - seen.speed
        wanted = _GAIN * error + _INTEGRAL_GAIN * self._integral
        if abs(wanted) < _MOST:
            self._integral += error * self._setup.time_step
        return Acceleration(min(max(wanted, -_MOST), _MOST), "holds speed")

    def applied(self, _: float) -> None:
        """Take the foot off: the safety layer has overruled the driver."""
        self._released = True
