"""An FMU's outputs as a motion in SI units, checked for plausibility."""

from __future__ import annotations

from math import isfinite, isnan, nan

from fmus.driving.agreement import Agreement
from fmus.driving.guards import DRIVEN, UNUSUAL, Guard
from fmus.errors import FmuOutputError
from fmus.profile.preparation import Prepared
from fmus.profile.wiring import Wiring

_STILL = 1e-9  # [m/s] or [m] change in a step that is mere rounding
_REVERSING = -0.05  # [m/s] speed beyond the overshoot of a stop within a step


class Motion:
    """Position, speed and acceleration along the path, as the FMU gives them or as derived.

    Args:
        prepared: Prepared vehicle.

    Attributes:
        position: Position [m].
        speed: Speed [m/s].
        acceleration: Acceleration [m/s2].
        warnings: Warnings for the user.
    """

    def __init__(self, prepared: Prepared) -> None:
        wiring = prepared.wiring
        self.position = self.speed = self.acceleration = 0.0
        self.warnings = [f"{prepared.path.name}: {note}" for note in prepared.notes]
        self.names = names_of(wiring)
        self._path = prepared.path
        self._wires = wiring.outputs
        self._position_output = wiring.output("position")
        self._acceleration_output = wiring.output("acceleration")
        self._inputs = wiring.inputs
        self._bounds = prepared.bounds
        limits = prepared.profile.limits
        self._limit, self._jump = limits.speed, limits.position_jump
        self._sudden = UNUSUAL * limits.acceleration
        self._guard = Guard(limits, self.names)
        model = prepared.profile.model
        self._sensor_lag = 0.0 if model is None else model.sensor_lag  # [s] of the speed output
        self._trusted = prepared.ours
        self._last_effective = 0.0  # [N] force under which the speed last changed
        self._origin = 0.0  # [m] run's position at which the FMU's own is 0
        self._agreement = Agreement(limits.position_jump)

    @property
    def state(self) -> tuple[float, float, float]:
        """Position, speed and acceleration."""
        return self.position, self.speed, self.acceleration

    def begin(self, outputs: memoryview[float]) -> None:
        """Take over the first state.

        Raises:
            FmuOutputError: no car can have this state.
        """
        wires = self._wires
        self.speed = wires[0].to_si(outputs[0])
        if self._acceleration_output is not None:
            self.acceleration = wires[self._acceleration_output].to_si(
                outputs[self._acceleration_output]
            )
        if self._position_output is not None:
            self.position = wires[self._position_output].to_si(outputs[self._position_output])
        self._last_effective = nan if self.speed else 0.0  # a moving vehicle: the force is unknown
        self._judge(0.0, 0.0, 0.0)

    def count_from(self, position: float) -> None:
        """Let the present position count as ``position`` [m]."""
        self._origin += self.position - position
        self.position = position

    def follow(
        self, outputs: memoryview[float], force: float, duration: float, time: float
    ) -> None:
        """Take over the state after a step.

        Args:
            outputs: Outputs of the FMU.
            force: Force [N] held over the step.
            duration: Duration of the step [s].
            time: Time at its end [s].

        Raises:
            FmuOutputError: no car can have this state.
        """
        wires, before, here = self._wires, self.speed, self.position
        place, rate = self._position_output, self._acceleration_output
        wire = wires[0]
        self.speed = speed = wire.scale * outputs[0] + wire.shift
        if place is not None:
            wire = wires[place]
            self.position = wire.scale * outputs[place] + wire.shift - self._origin
        else:
            self.position = here + self._way(before, duration)
        if rate is not None:
            wire = wires[rate]
            self.acceleration = wire.scale * outputs[rate] + wire.shift
        else:
            self.acceleration = (speed - before) / duration
        if not self._trusted:
            self._watch(before, here, force, duration, time)
        elif not isfinite(self.position + speed + self.acceleration):
            self._judge(0.0, 0.0, time)

    def _way(self, before: float, duration: float) -> float:
        """Return the distance [m] of a step by the speed, whose output may lag behind."""
        speed = self.speed
        return 0.5 * duration * (before + speed) + self._sensor_lag * (speed - before)

    def _watch(
        self, before: float, here: float, force: float, duration: float, time: float
    ) -> None:
        """Check a step that led from the speed ``before`` [m/s] and the position ``here`` [m].

        Raises:
            FmuOutputError: no car can move like this.
        """
        speed, position = self.speed, self.position
        way, slack = self._way(before, duration), 0.5 * duration * abs(speed - before)
        self._judge(position - (here + way), slack, time)
        if abs(speed - before) > self._sudden * duration:
            fault, warning = self._guard.sudden(before, speed, force, duration, time)
            if fault:
                raise FmuOutputError(f"{self._path}: {fault}")
            self._note(warning)
        faster = abs(speed - before) > _STILL
        if faster or isnan(self._last_effective):
            self._last_effective = force
        if self._position_output is None:  # until the force changes, a car may keep its speed
            changed = faster or abs(force - self._last_effective) < DRIVEN
        else:
            changed = faster or abs(position - here) > _STILL
            lost = self._agreement.lost(position - here, way, slack, duration)
            if lost is not None:
                raise FmuOutputError(f"{self._path}: {self._guard.disagreement(*lost, time)}")
        self._note(self._guard.watch(changed, force, speed, duration, time))
        if speed < _REVERSING:
            backwards = f"{self.names['speed']} = {speed:.3g} m/s at {time:.10g} s: it reverses"
            self._note(self._guard.once("reverse", backwards))

    def _judge(self, jump: float, slack: float, time: float) -> None:
        """Refuse a state that no car can have, allowing ``slack`` [m] of its ``jump`` [m]."""
        good = (
            -self._limit <= self.speed <= self._limit
            and abs(jump) <= self._jump + slack
            and isfinite(self.position)
            and isfinite(self.acceleration)
        )
        if not good:
            problem = self._guard.fault(*self.state, jump, time)
            raise FmuOutputError(f"{self._path}: {problem}")

    def keep_bounds(self, inputs: memoryview[float]) -> None:
        """Limit the inputs to the ranges that the FMU declares."""
        for bound in self._bounds:
            value = inputs[bound.index]
            if not bound.low <= value <= bound.high:
                inputs[bound.index] = min(max(value, bound.low), bound.high)
                wired = self._inputs[bound.index]
                allowed = f"{bound.low:g} to {bound.high:g} {wired.unit}".rstrip()
                limited = f"{wired.channel.name} was limited to the FMU's {allowed}"
                self._note(self._guard.once(wired.role, limited))

    def _note(self, warning: str) -> None:
        if warning:
            self.warnings.append(f"{self._path.name}: {warning}")


def names_of(wiring: Wiring) -> dict[str, str]:
    """Return the FMU's names of the quantities of the motion."""
    given = {wire.role: wire.channel.name for wire in wiring.outputs}
    roles = ("speed", "position", "acceleration")
    return {role: given.get(role, f"{role} (derived)") for role in roles}
