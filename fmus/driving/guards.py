"""Finding motions that no car has: they show that an FMU is at fault, whatever it returns."""

from math import isfinite

from fmus.profile.vehicle_profile import Limits

DRIVEN = 200.0  # [N] a car that does not react to so much is stuck


class Guard:
    """Finds faults in new states, and puts them into words.

    Args:
        limits: Limits of the profile.
        names: what the FMU calls its speed, position and acceleration.
    """

    def __init__(self, limits: Limits, names: dict[str, str]) -> None:
        self._limits = limits
        self._names = names
        self._frozen = 0.0  # [s]
        self._warned: set[str] = set()

    def fault(
        self, position: float, speed: float, acceleration: float, jump: float, at: float
    ) -> str:
        """What is wrong with a new state; empty if nothing is.

        Args:
            position: [m].
            speed: [m/s].
            acceleration: [m/s2].
            jump: Difference between the position and the integrated speed [m].
            at: time [s].
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

    def disagreement(self, moved: float, way: float, duration: float, at: float) -> str:
        """What is wrong with a position that is not the integrated speed.

        Args:
            moved: distance by the position [m].
            way: distance by the integrated speed [m].
            duration: Time over which they were driven [s]; 0: since the start.
            at: time [s].
        """
        position, speed = self._names["position"], self._names["speed"]
        lately = f" in {duration:.4g} s" if duration else ""
        return (
            f"{position} has moved by {moved:.4g} m{lately} at {at:.10g} s, where {speed} accounts "
            f"for {way:.4g} m; check the units of both, or leave out [outputs.position]"
        )

    def watch(self, changed: bool, force: float, speed: float, step: float, at: float) -> str:
        """A warning about a state that stands still though it is driven; empty if there is none.

        Args:
            changed: whether the motion has changed in this step.
            force: held over it [N].
            speed: [m/s].
            step: [s].
            at: time [s].
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
        """The warning the first time; empty afterwards."""
        if kind in self._warned:
            return ""
        self._warned.add(kind)
        return warning
