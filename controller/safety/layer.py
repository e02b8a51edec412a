"""The safety layer: it limits a controller's force so that a stop before people stays possible.

The layer applies the largest force, up to the controller's, after which full braking still stops
the ego before its front could hit a person, for all motions within the assumed limits of
acceleration and speed. If such a force exists in one step, it exists in the next one as well,
because full braking remains possible (docs/safety.md has the proof). The method is set-based online
verification with a fail-safe manoeuvre (Althoff & Dolan, IEEE T-RO 2014; Pek & Althoff, ITSC 2018),
with safe distances as in RSS (Shalev-Shwartz et al., arXiv 1708.06374).
"""

from dataclasses import dataclass, field
from math import ceil, exp, expm1, inf, log
from typing import Final, NamedTuple

import numpy as np

from controller._jit import Array, kernel
from controller.actuator import Actuator
from controller.defaults import FORCE_LIMIT, STANDSTILL
from controller.model import LongitudinalModel
from controller.parameters import require, require_not_negative, require_positive
from controller.safety.actuator_bound import Lagging, advance_bound
from controller.safety.stopping import EgoMotion, Limits, Walking, is_safe, packed, unpacked
from controller.safety.worst_motion import RECORDED, WorstMotion

LONGEST_STOP = 20.0  # longest duration [s] of a stop; a longer braking is not a stop
LETS_THROUGH, ACTS, UNAVOIDABLE = 0, 1, 2
_MOST_DECAY = 50.0  # largest exponent of the speed's decay by friction in that time
RESOLUTION = 4.0  # resolution [N] of the largest safe force
SLACK = 1e-9  # distance [m] that a new force keeps in addition to full braking, above rounding
WHOLE_STEPS = 1e-6  # tolerance [steps] when a time is rounded up to whole steps
_PEOPLE = RECORDED["recorded-99.9"]
_NO_KERBS = np.zeros((0, 3))
_EXACT = np.zeros(0)  # errors of velocities that are exact


def past_commands(dead_time: float, time_step: float) -> Array:
    """Return a memory (delay + 1,) [N] of the forces that may act within a dead time.

    Args:
        dead_time: Longest time [s] until the vehicle begins to follow a command.
        time_step: Control step [s].
    """
    return np.zeros(1 + max(ceil(dead_time / time_step - WHOLE_STEPS), 0))


def motion_of(model: LongitudinalModel, force_limit: float, rate: float = inf) -> EgoMotion:
    """The limits of a vehicle that integrates its model by forward Euler or exactly.

    Args:
        model: Model of the motion.
        force_limit: Largest force [N].
        rate: Largest change of force [N per step].
    """
    z = model.friction * model.time_step / model.mass
    return EgoMotion(
        slowest_decay=exp(-z),
        fastest_decay=max(0.0, model.decay),
        gain=model.speed_per_force,
        braking_gain=model.speed_per_force * ((1.0 - exp(-z)) / z if z > 0.0 else 1.0),
        force_limit=force_limit,
        force_rate_limit=rate,
    )


@dataclass(frozen=True, slots=True)
class SafetyParameters:
    """The limits of people and of the ego's body and brake.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    walking_acceleration: float = _PEOPLE.acceleration  # a_max [m/s^2]
    walking_speed: float = _PEOPLE.speed  # v_max [m/s]
    setting_out: float = _PEOPLE.setting_out  # a_k [m/s^2] from a sidewalk towards the road
    body_radius: float = 0.27  # radius R [m] of a body in the VCI model (TSAS 2020)
    width: float = 2.0  # width of the ego [m] (Yang & Özgüner 2019)
    margin: float = 0.05  # least distance [m] of the front to a body (giveway's own)
    position_error: float = 0.0  # largest error [m] of a perceived position
    force_limit: float = FORCE_LIMIT  # u_max [N] (Yang & Özgüner 2019, table 1)
    force_rate_limit: float = inf  # largest change of the layer's braking force [N per step]
    actuator: Actuator = field(default_factory=Actuator)  # the worst one that the ego may have

    def __post_init__(self) -> None:
        require_positive("walking_acceleration", self.walking_acceleration, "m/s^2")
        require_positive("walking_speed", self.walking_speed, "m/s")
        require(self.setting_out > 0.0, "setting_out", self.setting_out, "a number > 0 [m/s^2]")
        require_not_negative("body_radius", self.body_radius, "m")
        require_positive("width", self.width, "m")
        require_not_negative("margin", self.margin, "m")
        require_not_negative("position_error", self.position_error, "m")
        require_positive("force_limit", self.force_limit, "N")
        rate = self.force_rate_limit
        require(rate > 0.0, "force_rate_limit", rate, "a number > 0 [N per step]")

    @property
    def brake_force(self) -> float:
        """The largest braking force [N] that acts in the end."""
        return min(self.force_limit, self.actuator.brake.limit)

    @property
    def worst(self) -> WorstMotion:
        """The worst motion that people are assumed to make."""
        return WorstMotion(self.walking_acceleration, self.walking_speed, self.setting_out)


class SafeForce(NamedTuple):
    """The force that the safety layer applies."""

    force: float  # force [N], at most the one that was asked for
    acted: bool  # whether the layer replaced the controller's force
    reason: str  # "safety layer", "unavoidable" (no braking is certain to be enough), or empty


class SafetyLayer:
    """The safety layer, a filter between controller and vehicle.

    Args:
        model: Model of the ego's motion. The guarantee holds for a plant that integrates it by
            forward Euler or exactly.
        parameters: Limits of people, of the ego's body and of its brake.

    Attributes:
        memory: Last argument of :func:`largest_safe_force`, for kernels that call it.
        REASONS: Reasons by the layer's result.
    """

    REASONS: Final = ("", "safety layer", "unavoidable")

    def __init__(self, model: LongitudinalModel, parameters: SafetyParameters) -> None:
        self.model = model
        self.parameters = p = parameters
        dt = model.time_step
        self._limits = Limits(
            time_step=dt,
            ego=motion_of(model, p.brake_force, p.force_rate_limit),
            people=Walking(
                acceleration=p.walking_acceleration,
                speed=p.walking_speed,
                setting_out=min(p.setting_out, p.walking_acceleration),
            ),
            half_width=p.width / 2.0,
            body_radius=p.body_radius,
            margin=p.margin,
            lagging=Lagging.of(p.actuator, dt),
        )
        self._errors = np.full(0, p.position_error)
        self._boxes = np.zeros((ceil(LONGEST_STOP / dt) + 1, 9))
        self._commands, self._acting = past_commands(p.actuator.dead_time, dt), np.zeros(4)
        self.memory = (packed(self._limits), self._commands, self._boxes, self._acting)
        # Largest number of steps until full braking acts; a lag lacks no more than this delay
        drive, brake = p.actuator.drive, p.actuator.brake
        lags = (max(drive.lag, brake.lag) + brake.lag) / dt
        rate = min(p.force_rate_limit, dt * min(drive.rate, brake.rate))
        self._not_yet = len(self._commands) + 2.0 * p.brake_force / rate + lags

    def reach(self, speed: float) -> float:
        """Return the longest distance [m] until the front stops, after any force now.

        Args:
            speed: Speed now [m/s].
        """
        c, not_yet = self._limits.ego, self._not_yet
        v, dt = max(speed, 0.0) + not_yet * c.gain * c.force_limit, self._limits.time_step
        return v * dt * (not_yet + 1.0 + v / (2.0 * c.braking_gain * c.force_limit))

    @property
    def fastest(self) -> float:
        """The highest speed [m/s] from which the ego stops in `LONGEST_STOP` after any force."""
        c, not_yet = self._limits.ego, self._not_yet
        steps = len(self._boxes) - 1 - not_yet
        if steps <= 0:
            return 0.0
        # Backwards from a standstill: v = (v_after + g u) / e, a geometric sum.
        growth = min(-log(c.slowest_decay), _MOST_DECAY / steps)
        share = steps if growth == 0.0 else expm1(growth * steps) / -expm1(-growth)
        return max(0.0, c.force_limit * (c.braking_gain * share - c.gain * not_yet))

    def reset(self) -> None:
        """Forget the forces of the past."""
        self._commands[:] = self._acting[:] = 0.0

    def may_be_slower(self, by: float) -> None:
        """Let the next speed be the largest one that the ego may have.

        Args:
            by: Speed [m/s] by which it may be slower, until another one is told.
        """
        self._acting[3] = by

    def filter(
        self,
        force: float,
        speed: float,
        front: tuple[Array, float],
        position: Array,
        velocity: Array,
        errors: Array | None = None,
        kerbs: Array = _NO_KERBS,
        velocity_errors: Array = _EXACT,
    ) -> SafeForce:
        """Return the force if it is safe, or the largest safe one below it.

        Args:
            force: Force [N] that the controller asks for, for the step from now on.
            speed: Speed of the ego [m/s].
            front: Poses (k, 4) of the front ahead: x, y [m] of its middle and cos, sin of the
                body's heading; and the travel [m] between them. It goes straight on beyond.
            position: Centres (n, 2) [m] of people, in the frame of the poses.
            velocity: Velocities (n, 2) [m/s] of people.
            errors: Largest errors (n,) [m] of ``position``, or None for the parameters' error.
            kerbs: Kerbs (n, 3) of people on a sidewalk: unit vector to the kerb and distance [m];
                0 for the others. An array (0, 3) if nobody is on a sidewalk.
            velocity_errors: Largest errors (n,) [m/s] of ``velocity``, or (0,) if it is exact.
        """
        errors = self.errors(len(position)) if errors is None else errors
        people = position, velocity, errors, kerbs, velocity_errors
        safe, verdict = largest_safe_force(force, speed, front, people, self.memory)
        return SafeForce(safe, verdict != LETS_THROUGH, self.REASONS[verdict])

    def errors(self, people: int) -> Array:
        """Return the parameters' position error (n or more,) [m] for each of n ``people``."""
        if len(self._errors) < people:
            self._errors = np.full(2 * people, self.parameters.position_error)
        return self._errors


@kernel
def largest_safe_force(
    force: float,
    speed: float,
    front: tuple[Array, float],
    people: tuple[Array, Array, Array, Array, Array],
    memory: tuple[Array, Array, Array, Array],
) -> tuple[float, int]:
    """Find the largest safe force up to ``force`` [N], and remember it as the last command.

    Args:
        force: Force [N] that the controller asks for.
        speed: Speed of the ego [m/s].
        front: Poses (k, 4) of the front ahead, and the distance [m] between them.
        people: Positions (n, 2) [m], velocities (n, 2) [m/s], largest errors of the positions
            (n,) [m] or more, kerbs (n, 3) or none, and largest errors of the velocities (n,)
            [m/s] or none; see :meth:`SafetyLayer.filter`.
        memory: Packed :class:`Limits`; past forces (delay + 1,) [N], the latest last, changed;
            scratch (longest stop + 1, 9); bounds (3,) [N] of the forces that act, changed, and the
            speed [m/s] by which the ego may be slower.

    Returns:
        Force [N]; 0 if it is the controller's, 1 if the layer acts, 2 if the layer acts although no
        braking is certain to be enough.
    """
    numbers, commands, boxes, acting = memory
    c, v = unpacked(numbers), speed if speed > STANDSTILL else 0.0
    advance_bound(max(commands.max(), -c.ego.force_limit), acting, c.lagging)
    verdict, safe, scratch = LETS_THROUGH, force, (commands, boxes, acting)
    if people[0].shape[0] > 0 and not is_safe(force, v, front, people, c, scratch, SLACK):
        verdict = ACTS
        safe = max(-c.ego.force_limit, commands[-1] - c.ego.force_rate_limit)
        safe = min(safe, force)
        unsafe = force
        if not is_safe(safe, v, front, people, c, scratch, 0.0):
            verdict, unsafe = UNAVOIDABLE, safe
        while unsafe - safe > RESOLUTION:
            middle = 0.5 * (safe + unsafe)
            if is_safe(middle, v, front, people, c, scratch, SLACK):
                safe = middle
            else:
                unsafe = middle
        if safe == force and verdict == ACTS:
            verdict = LETS_THROUGH  # the controller asked for full braking, which is just enough
    for i in range(commands.shape[0] - 1):
        commands[i] = commands[i + 1]
    commands[-1] = safe
    return safe, verdict
