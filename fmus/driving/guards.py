"""Detection of motions that no car has: they show that an FMU is at fault."""

from math import isfinite

from fmus.profile.vehicle_profile import Limits

DRIVEN = 200.0  # [N] force to which every car reacts
# Share of [limits] acceleration from which a warning is given. Tyres on dry asphalt brake a car
# with up to 12 m/s2 (friction coefficient 1.2): 0.3 * 50 m/s2 = 15 m/s2 is more than theirs. The
# limit itself, 50 m/s2 = 5 g, is the braking of a Formula 1 car with its downforce.
UNUSUAL = 0.3
JERKY = 0.5  # [m/s] change of speed in a step that quantised or noisy outputs may have
STOPPING = 2.0  # [m/s] speed from which brakes with dry friction may stop a vehicle within a step
STILL = 0.05  # [m/s] speed of a vehicle that stands


class Guard:
    """Finds faults in new states, and describes them.

    Args:
        limits: Limits of the profile.
        names: Names in the FMU of its speed, position and acceleration.
    """

    def __init__(self, limits: Limits, names: dict[str, str]) -> None:
        self._limits = limits
        self._names = names
        self._frozen = 0.0  # [s]
        self._warned: set[str] = set()

    def fault(
        self, position: float, speed: float, acceleration: float, jump: float, at: float
    ) -> str:
        """Return the fault of a new state as a message, or an empty text.

        Args:
            position: Position [m].
            speed: Speed [m/s].
            acceleration: Acceleration [m/s2].
            jump: Difference between the position and the integrated speed [m].
            at: Time [s].
        """
        for role, value in (
            ("position", position),
            ("speed", speed),
            ("acceleration", acceleration),
        ):
            if not isfinite(value):
                return (
                    f"{self._names[role]} = {value} at {at:.10g} s; expected a finite number; "
                    "check the FMU's parameters and the step size"
                )
        limit = self._limits.speed
        if abs(speed) > limit:
            return (
                f"{self._names['speed']} = {speed:.6g} m/s at {at:.10g} s; expected within "
                f"+-{limit:g} m/s; check its unit and the step, or raise speed in [limits]"
            )
        return (
            f"{self._names['position']} = {position:.6g} m at {at:.10g} s, {jump:+.6g} m from "
            f"where the speed leads; expected within {self._limits.position_jump:g} m; check the "
            "units of position and speed, or raise position_jump in [limits]"
        )

    def sudden(
        self, before: float, speed: float, force: float, step: float, at: float
    ) -> tuple[str, str]:
        """Return a fault and a warning about a change of speed that no car has; both may be empty.

        A vehicle that is braked may come to a standstill within a step.

        Args:
            before: Speed at the begin of the step [m/s].
            speed: Speed at its end [m/s].
            force: Force held over the step [N].
            step: Duration of the step [s].
            at: Time at its end [s].
        """
        rate, limit = abs(speed - before) / step, self._limits.acceleration
        stops = force < 0.0 and abs(speed) <= STILL and abs(before) <= STOPPING
        if rate <= UNUSUAL * limit or abs(speed - before) <= JERKY or stops:
            return "", ""
        text = (
            f"{self._names['speed']} = {speed:.6g} m/s at {at:.10g} s, {before:.6g} m/s {step:g} s "
            f"before: {rate:.4g} m/s2"
        )
        if rate <= limit:
            return "", self.once("sudden", f"{text}: more than any road vehicle's tyres can")
        return (
            f"{text}; expected at most {limit:g} m/s2; check its unit and the FMU's parameters, or "
            "raise acceleration in [limits]",
            "",
        )

    def disagreement(self, moved: float, way: float, duration: float, at: float) -> str:
        """Return the message that the position is not the integrated speed.

        Args:
            moved: Distance by the position [m].
            way: Distance by the integrated speed [m].
            duration: Time [s] over which they were driven; 0 means since the start.
            at: Time [s].
        """
        position, speed = self._names["position"], self._names["speed"]
        lately = f" in {duration:.4g} s" if duration else ""
        return (
            f"{position} has moved by {moved:.4g} m{lately} at {at:.10g} s, where {speed} accounts "
            f"for {way:.4g} m; check the units of both, or leave out [outputs.position]"
        )

    def watch(self, changed: bool, force: float, speed: float, step: float, at: float) -> str:
        """Return a warning if the state does not change although it is driven, or an empty text.

        Args:
            changed: True if the motion has changed in this step.
            force: Force held over the step [N].
            speed: Speed [m/s].
            step: Step [s].
            at: Time [s].
        """
        if changed or (speed == 0.0 and force < DRIVEN) or abs(force) < DRIVEN:
            self._frozen = 0.0
            return ""
        self._frozen += step
        if self._frozen < self._limits.frozen_time:
            return ""
        return self.once(
            "frozen",
            f"{self._names['speed']} has not changed for {self._limits.frozen_time:g} s until "
            f"{at:.10g} s under forces like {force:.0f} N; is the input connected?",
        )

    def once(self, kind: str, warning: str) -> str:
        """Return the warning when it is given for the first time, and an empty text afterwards."""
        if kind in self._warned:
            return ""
        self._warned.add(kind)
        return warning
