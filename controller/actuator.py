"""The actuator of the vehicle: how the forces that act follow the forces that are commanded.

Each side, driving and braking, has a dead time, a limit, a largest rate and a first-order lag.
Forces that act are in newtons for the mass M of the controllers' model. The mass of a side may be
another one, so that the same acceleration needs a force that is ``scale`` times as large.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import exp, inf, isfinite
from typing import NamedTuple

from controller.defaults import STANDSTILL
from controller.model import LongitudinalModel
from controller.parameters import require, require_not_negative, require_positive

_LEAD = 0.5  # time, as a share of the lag, within which a command reaches a planned force
_LONGEST = 5.0  # longest lag or dead time [s] of a vehicle that can be driven


@dataclass(frozen=True, slots=True)
class ActuatorSide:
    """The answer of a vehicle to the forces of one sign.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    scale: float = 1.0  # commanded force over the force that acts in the end [-]
    lag: float = 0.0  # first-order time constant [s]
    delay: float = 0.0  # dead time [s]
    limit: float = inf  # largest force [N] that acts
    power_from: float = inf  # speed [m/s] above which the largest force falls as 1 / v
    rate: float = inf  # largest change [N/s] of the force that acts

    def __post_init__(self) -> None:
        require_positive("scale", self.scale, "-")
        for name in ("lag", "delay"):
            value = getattr(self, name)
            require_not_negative(name, value, "s")
            require(value <= _LONGEST, name, value, f"at most {_LONGEST:g} s")
        for name in ("limit", "power_from", "rate"):
            require(getattr(self, name) > 0.0, name, getattr(self, name), "a number > 0")

    def largest(self, speed: float) -> float:
        """Return the largest force [N] at ``speed`` [m/s]."""
        return self.limit * self.power_from / speed if speed > self.power_from else self.limit


@dataclass(frozen=True, slots=True)
class Actuator:
    """Both sides of the actuator of a vehicle."""

    drive: ActuatorSide = field(default_factory=ActuatorSide)
    brake: ActuatorSide = field(default_factory=ActuatorSide)

    @property
    def ideal(self) -> bool:
        """True if each commanded force acts at once, as it is."""
        usual = ActuatorSide()
        return self.drive == usual and self.brake == usual

    @property
    def dead_time(self) -> float:
        """The longest time [s] until either side begins to follow a command."""
        return max(self.drive.delay, self.brake.delay)

    @property
    def reaction_time(self) -> float:
        """The dead time plus the lag [s] of the brake, after which braking mostly acts."""
        return self.brake.delay + self.brake.lag

    def acting(self, command: float) -> float:
        """Return the force [N] that acts in the end after a commanded one."""
        return command / (self.drive if command > 0.0 else self.brake).scale

    def command(self, acting: float) -> float:
        """Return the force [N] to be commanded so that ``acting`` [N] acts in the end."""
        return acting * (self.drive if acting > 0.0 else self.brake).scale


def lag_shares(lag: float, time_step: float) -> tuple[float, float]:
    """The shares of a deviation that are left after a step, and in the mean of the step.

    Args:
        lag: First-order time constant [s].
        time_step: Length of the step [s].
    """
    if lag <= 0.0:
        return 0.0, 0.0
    end = exp(-time_step / lag)
    return end, lag / time_step * (1.0 - end)


class _Channel:
    """One side in steps: its dead time [steps], and the force that acts."""

    def __init__(self, side: ActuatorSide, time_step: float) -> None:
        self.side = side
        self.steps = round(side.delay / time_step)
        # The part of the dead time that is not a whole number of steps acts like a lag.
        lag = max(side.lag + side.delay - self.steps * time_step, 0.0)
        self.end, self.mean = lag_shares(lag, time_step)
        self.most_change = side.rate * time_step  # [N per step]
        # Steps within which a command reaches a planned force: fewer would need larger commands
        self.lead = max(1, round(_LEAD * lag / time_step))

    def step(self, wanted: float, at: tuple[float, float]) -> tuple[float, tuple[float, float]]:
        """Return the mean force [N] of a step, and the state after it, for a wanted force [N].

        Args:
            wanted: Force [N], 0 or more.
            at: Force [N] behind limit and rate, and the one that acts behind the lag.
        """
        target, acting = at
        change = wanted - target
        if isfinite(self.most_change):
            change = min(max(change, -self.most_change), self.most_change)
            target += change
        else:
            target = wanted
        rest = acting - target
        return target + rest * self.mean, (target, target + rest * self.end)

    def reach(self, speed: float, at: tuple[float, float]) -> tuple[float, float]:
        """Return the least and the largest mean force [N] of the next step."""
        least, _ = self.step(0.0, at)
        most, _ = self.step(self.side.largest(speed), at)
        return least, max(least, most)

    def left(self, at: tuple[float, float], steps: int) -> float:
        """Return the mean force [N] of the last one of ``steps`` steps without any wanted force."""
        return at[1] * self.mean * self.end ** (steps - 1)

    def inverse(self, mean: float, at: tuple[float, float], steps: int) -> float:
        """Return the wanted force [N] that has this mean [N] after ``steps`` equal steps."""
        left = self.mean * self.end ** (steps - 1)
        return max((mean - self.left(at, steps)) / (1.0 - left), 0.0)


class Ahead(NamedTuple):
    """The state of the ego where a force that is commanded now begins to act."""

    steps: int  # number of steps until then
    speeds: tuple[float, ...]  # speeds [m/s] at steps 0 ... steps
    travels: tuple[float, ...]  # distances [m] driven at steps 0 ... steps
    force: float  # force [N] that acts then; its means over a step may lie from
    least: float  # this one [N]
    most: float  # to this one [N]

    @property
    def speed(self) -> float:
        """The speed [m/s] then."""
        return self.speeds[-1]

    @property
    def travel(self) -> float:
        """The distance [m] driven until then."""
        return self.travels[-1]


class Anticipation:
    """The forces on their way through the actuator, and where they lead.

    A controller decides on the force that acts after the dead time, from the state in which the
    vehicle will be then. The side with the shorter dead time waits for the other one.

    Args:
        model: Longitudinal model of the vehicle.
        actuator: Actuator of the vehicle.

    Attributes:
        steps: Number of steps until a force that is commanded now begins to act.
        lead: Number of steps after that whose planned forces matter to a command.
    """

    def __init__(self, model: LongitudinalModel, actuator: Actuator) -> None:
        self.actuator = actuator
        self._decay, self._gain = model.decay, model.speed_per_force
        self._time_step = model.time_step
        self._drive = _Channel(actuator.drive, model.time_step)
        self._brake = _Channel(actuator.brake, model.time_step)
        self.steps = max(self._drive.steps, self._brake.steps)
        self.lead = max(self._drive.lead, self._brake.lead)
        self.reset()

    def reset(self) -> None:
        """Forget all forces."""
        # Forces [N] that begin to act in step 0, 1, ...; the first one begins now
        self._queue = [0.0] * self.steps
        self._at = ((0.0, 0.0), (0.0, 0.0))  # states of driving and braking now
        self._then = self._at  # states where a force that is commanded now begins to act
        self._ahead: Ahead | None = None

    def look(self, speed: float) -> Ahead:
        """Return the state after the dead time; to be called once in each control step.

        Args:
            speed: Speed [m/s] now.
        """
        if self._ahead is not None:  # the step that began with the last look is over
            _, self._at = self._step(self._queue.pop(0), self._ahead.speeds[0], self._at)
        if speed <= STANDSTILL:  # the brake holds without work
            self._at = self._at[0], (0.0, 0.0)
        at, v, travel = self._at, speed, 0.0
        speeds, travels = [v], [travel]
        for force in self._queue:
            mean, at = self._step(force, v, at)
            travel += self._time_step * v
            v = max(0.0, self._decay * v + self._gain * mean)
            speeds.append(v)
            travels.append(travel)
        if self.steps and v <= STANDSTILL:
            at = at[0], (0.0, 0.0)
        self._then = at
        drives, brakes = self._drive.reach(v, at[0]), self._brake.reach(v, at[1])
        self._ahead = Ahead(
            self.steps,
            tuple(speeds),
            tuple(travels),
            at[0][1] - at[1][1],
            drives[0] - brakes[1],
            drives[1] - brakes[0],
        )
        return self._ahead

    def command(self, forces: Sequence[float]) -> float:
        """Return the force [N] to be commanded so that these forces act after the dead time.

        Args:
            forces: Mean forces [N] of the first steps after the dead time, one or more.
        """
        ahead, (drive, brake) = self._ahead, self._then
        assert ahead is not None, "look() comes first"
        wanted = 0.0
        for channel, own, sign in ((self._brake, brake, -1.0), (self._drive, drive, 1.0)):
            steps = min(channel.lead, len(forces))
            other = self._drive.left(drive, steps) - self._brake.left(brake, steps)
            lack = sign * (
                forces[steps - 1] - other
            )  # with neither driving nor braking from now on
            if lack > 0.0:
                most = channel.side.largest(ahead.speed)
                wanted = sign * min(
                    channel.inverse(lack + channel.left(own, steps), own, steps), most
                )
                break
        self._queue.append(wanted)
        return self._sent()

    def applied(self, command: float) -> float:
        """Continue from a ``command`` [N] that another part has sent instead of the last one.

        Returns:
            Mean force [N] of the first step after the dead time.
        """
        force, drives, brakes = self.actuator.acting(command), self._drive.steps, self._brake.steps
        queue = self._queue
        for i in range(drives, len(queue)):
            queue[i] = min(queue[i], 0.0)
        if force < 0.0:
            for i in range(brakes, len(queue)):
                queue[i] = force if i == brakes else min(queue[i], 0.0)
        else:
            for i in range(brakes, len(queue)):
                queue[i] = 0.0
            queue[drives] = force
        ahead = self._ahead
        assert ahead is not None, "look() comes first"
        return self._step(queue[-1], ahead.speed, self._then)[0]

    def _sent(self) -> float:
        """Return the command [N] of this step, which begins to act as the queue demands."""
        queue, drives, brakes = self._queue, self._drive.steps, self._brake.steps
        force = queue[brakes]
        if force < 0.0:
            queue[drives] = min(queue[drives], 0.0)
        else:
            force = max(queue[drives], 0.0)
        return self.actuator.command(force)

    def _step(
        self, force: float, speed: float, at: tuple[tuple[float, float], tuple[float, float]]
    ) -> tuple[float, tuple[tuple[float, float], tuple[float, float]]]:
        """Return the mean force [N] of a step, and the states of both sides after it."""
        wanted = min(max(force, 0.0), self._drive.side.largest(speed))
        driven, drive = self._drive.step(wanted, at[0])
        braked, brake = self._brake.step(min(max(-force, 0.0), self._brake.side.limit), at[1])
        return driven - braked, (drive, brake)
