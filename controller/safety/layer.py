"""The safety layer: whatever a controller asks for, a stop before every pedestrian stays possible.

Of the forces up to the one asked for it lets through the largest after which full braking still
stops the ego before its front could move into anybody, however people walk within their limits of
acceleration and speed. Where that holds it holds again one step later, by braking fully: the
fallback of the last step is still there (docs/safety.md has the proof). The idea is that of
set-based online verification with a fail-safe manoeuvre (Althoff & Dolan, IEEE T-RO 2014; Pek &
Althoff, ITSC 2018) and of the safe distances of RSS (Shalev-Shwartz et al., arXiv 1708.06374).
"""

from dataclasses import dataclass
from math import ceil, exp, expm1, inf, log
from typing import Final, NamedTuple

import numpy as np

from controller._jit import Array, kernel
from controller.defaults import FORCE_LIMIT, STANDSTILL
from controller.model import LongitudinalModel
from controller.parameters import require, require_not_negative, require_positive
from controller.safety.stopping import Limits, is_safe
from controller.safety.worst_motion import RECORDED, WorstMotion

LONGEST_STOP = 20.0  # [s] what has not stopped by then does not count as stopping
LETS_THROUGH, ACTS, UNAVOIDABLE = 0, 1, 2
_MOST_DECAY = 50.0  # e-foldings by friction in that time: from any speed
_RESOLUTION = 4.0  # [N] to which the largest safe force is found
_SLACK = 1e-9  # [m] that a new plan keeps and the fallback need not: above rounding, below a hair
_WHOLE_STEPS = 1e-6  # of a step: a reaction time of so little more is no step more
_PEOPLE = RECORDED["recorded-99.9"]
_NO_KERBS = np.zeros((0, 3))


@dataclass(frozen=True, slots=True)
class SafetyParameters:
    """The limits of people and of the ego's body and brake.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    walking_acceleration: float = _PEOPLE.acceleration  # a_max [m/s^2]
    walking_speed: float = _PEOPLE.speed  # v_max [m/s]
    setting_out: float = _PEOPLE.setting_out  # a_k [m/s^2] towards the road, while on a sidewalk
    body_radius: float = 0.27  # R [m] of the VCI model (TSAS 2020)
    width: float = 2.0  # of the ego [m] (Yang & Özgüner 2019)
    margin: float = 0.05  # [m] kept between the front and a body (ours)
    position_error: float = 0.0  # [m] that a perceived position is off at most
    force_limit: float = FORCE_LIMIT  # u_max [N] (Yang & Özgüner 2019, table 1)
    force_rate_limit: float = inf  # [N per step] of the layer's own braking (ours: none)
    reaction_time: float = 0.0  # [s] within which the vehicle does what it is told

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
        require_not_negative("reaction_time", self.reaction_time, "s")
        short = self.reaction_time < LONGEST_STOP
        require(short, "reaction_time", self.reaction_time, f"less than {LONGEST_STOP:g} s")

    @property
    def worst(self) -> WorstMotion:
        """The worst motion that people are assumed to make."""
        return WorstMotion(self.walking_acceleration, self.walking_speed, self.setting_out)


class SafeForce(NamedTuple):
    """The force that the layer lets through."""

    force: float  # [N], never more than was asked for
    acted: bool  # the layer decides, not the controller
    reason: str  # "safety layer", "unavoidable" (no braking is surely enough); empty if not acted


class SafetyLayer:
    """The last word on the ego's force.

    Args:
        model: Model of the ego's motion. The layer holds for its forward Euler and for its exact
            solution, whichever of them the plant is.
        parameters: the limits.

    Attributes:
        memory: the last arguments of :func:`largest_safe_force`, for kernels that call it.
        REASONS: Reasons, by verdict.
    """

    REASONS: Final = ("", "safety layer", "unavoidable")

    def __init__(self, model: LongitudinalModel, parameters: SafetyParameters) -> None:
        self.model = model
        self.parameters = p = parameters
        dt = model.time_step
        z = model.friction * dt / model.mass
        self._limits = Limits(
            time_step=dt,
            slowest_decay=exp(-z),
            fastest_decay=max(0.0, model.decay),
            gain=model.speed_per_force,
            braking_gain=model.speed_per_force * ((1.0 - exp(-z)) / z if z > 0.0 else 1.0),
            force_limit=p.force_limit,
            force_rate_limit=p.force_rate_limit,
            walking_acceleration=p.walking_acceleration,
            walking_speed=p.walking_speed,
            setting_out=min(p.setting_out, p.walking_acceleration),
            half_width=p.width / 2.0,
            body_radius=p.body_radius,
            margin=p.margin,
        )
        self._errors = np.full(0, p.position_error)
        self._boxes = np.zeros((ceil(LONGEST_STOP / dt) + 1, 9))
        delay = ceil(p.reaction_time / dt - _WHOLE_STEPS)
        self._commands = np.zeros(1 + max(delay, 0))
        self.memory = (tuple(self._limits), self._commands, self._boxes)
        # How many steps full braking takes at most to set in.
        self._not_yet = len(self._commands) + 2.0 * p.force_limit / p.force_rate_limit

    def reach(self, speed: float) -> float:
        """Return the longest way [m] of the front until it stops, whatever is asked for now.

        Args:
            speed: now [m/s].
        """
        c, not_yet = self._limits, self._not_yet
        v = max(speed, 0.0) + not_yet * c.gain * c.force_limit
        return v * c.time_step * (not_yet + 1.0 + v / (2.0 * c.braking_gain * c.force_limit))

    @property
    def fastest(self) -> float:
        """The speed [m/s] from which it stops in time, whatever is asked for now."""
        c, not_yet = self._limits, self._not_yet
        steps = len(self._boxes) - 1 - not_yet
        if steps <= 0:
            return 0.0
        # Backwards from a standstill: v = (v_after + g u) / e, a geometric sum.
        growth = min(-log(c.slowest_decay), _MOST_DECAY / steps)
        share = steps if growth == 0.0 else expm1(growth * steps) / -expm1(-growth)
        return max(0.0, c.force_limit * (c.braking_gain * share - c.gain * not_yet))

    def reset(self) -> None:
        """Forget the forces of the past."""
        self._commands[:] = 0.0

    def filter(
        self,
        force: float,
        speed: float,
        way: Array,
        spacing: float,
        position: Array,
        velocity: Array,
        errors: Array | None = None,
        kerbs: Array = _NO_KERBS,
    ) -> SafeForce:
        """Let a force through, or the largest safe one below it.

        Args:
            force: asked for, for the step from now on [N].
            speed: Speed of the ego [m/s].
            way: (k, 4) x, y [m] of the front's middle and cos, sin of the body's heading, after
                0, 1, ... times ``spacing`` of travel; straight on beyond the last.
            spacing: [m] of travel between the rows of ``way``.
            position: (n, 2) [m] people's centres, in the frame of ``way``.
            velocity: (n, 2) [m/s] theirs.
            errors: (n,) [m] that ``position`` is off at most; None: the parameters' for everybody.
            kerbs: (n, 3) of those on a sidewalk the unit vector to its kerb, and how far that is
                [m]; 0 for the others. Without rows nobody is.
        """
        errors = self.errors(len(position)) if errors is None else errors
        people = position, velocity, errors, kerbs
        safe, verdict = largest_safe_force(force, speed, (way, spacing), people, self.memory)
        return SafeForce(safe, verdict != LETS_THROUGH, self.REASONS[verdict])

    def errors(self, people: int) -> Array:
        """Return the largest errors of positions, (n or more,) [m], where nothing else is known."""
        if len(self._errors) < people:
            self._errors = np.full(2 * people, self.parameters.position_error)
        return self._errors


@kernel
def largest_safe_force(
    force: float,
    speed: float,
    front: tuple[Array, float],
    people: tuple[Array, Array, Array, Array],
    memory: tuple[tuple[float, ...], Array, Array],
) -> tuple[float, int]:
    """The largest safe force up to ``force`` [N], and what the layer does; notes the force.

    The layer lets it through (0), acts (1), or acts where no braking is surely enough (2).

    Args:
        force: Force [N] that the controller asks for.
        speed: Speed of the ego [m/s].
        front: Poses (k, 4) of the front ahead, and the distance [m] between them.
        people: Positions (n, 2) [m], velocities (n, 2) [m/s], largest errors of the positions
            (n,) [m] or more, and kerbs (n, 3) or none; see :meth:`SafetyLayer.filter`.
        memory: Numbers of :class:`Limits` (a plain tuple, which numba unpacks 2 us faster); forces
            [N] of the past, (delay + 1,), the latest last, changed; scratch (longest stop + 1, 9).
    """
    limits, commands, boxes = memory
    c, v = Limits(*limits), speed if speed > STANDSTILL else 0.0
    verdict, safe, scratch = LETS_THROUGH, force, (commands, boxes)
    if people[0].shape[0] > 0 and not is_safe(force, v, front, people, c, scratch, _SLACK):
        verdict = ACTS
        safe = max(-c.force_limit, commands[-1] - c.force_rate_limit)
        safe = min(safe, force)
        unsafe = force
        if not is_safe(safe, v, front, people, c, scratch, 0.0):
            verdict, unsafe = UNAVOIDABLE, safe
        while unsafe - safe > _RESOLUTION:
            middle = 0.5 * (safe + unsafe)
            if is_safe(middle, v, front, people, c, scratch, _SLACK):
                safe = middle
            else:
                unsafe = middle
        if safe == force and verdict == ACTS:
            verdict = LETS_THROUGH  # full braking was asked for, and is just enough
    for i in range(commands.shape[0] - 1):
        commands[i] = commands[i + 1]
    commands[-1] = safe
    return safe, verdict
