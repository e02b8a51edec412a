"""The longitudinal safety layer for vehicles: it keeps a safe distance to the vehicle ahead.

The safe distance is that of *Responsibility-Sensitive Safety* (RSS; Shalev-Shwartz, Shammah &
Shashua, arXiv 1708.06374, 2017, definition 1): if the vehicle ahead brakes as hard as it can from
now on, the ego that responds by braking still stops behind it. Here the vehicle ahead moves in
steps of SUMO, and what is known of it is up to one step old. The distance is therefore computed
step by step instead of by the formula, and holds for each of them (docs/safety.md has the theorem).
"""

from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np

from controller._jit import Array, inner, kernel
from controller.actuator import Actuator
from controller.defaults import FORCE_LIMIT
from controller.driving_constants import EMERGENCY_BRAKING, RESPONSE, RESTORING
from controller.model import LongitudinalModel
from controller.parameters import require_not_negative, require_positive
from controller.safety.actuator_bound import Lagging, advance_bound, bound_step
from controller.safety.layer import (
    LONGEST_STOP,
    RESOLUTION,
    SLACK,
    WHOLE_STEPS,
    past_commands,
)

_BRAKES = 0.5  # deceleration [m/s^2] from which on the vehicle ahead counts as braking
_URGENCY = 1.2  # factor on the deceleration that just keeps the margin, for a gap that closes
_LEAST_ROOM = 0.1  # least room [m] in front, against a division by zero


class VehicleAhead(NamedTuple):
    """The vehicle ahead, as far as it is known."""

    gap: float  # distance [m] from the front bumper to its rear, if it drove on since the last news
    speed: float  # speed [m/s] along the path at the last news
    braking: float = EMERGENCY_BRAKING  # largest deceleration [m/s^2] that it is capable of
    decelerates: float = 0.0  # deceleration [m/s^2] at the last news
    age: float = 0.0  # time [s] since the last news
    new: bool = False  # whether another vehicle, or none, was ahead a step before
    step: float = 0.0  # time [s] between news


@dataclass(frozen=True, slots=True)
class VehicleLimits:
    """The limits of the ego's response to a vehicle ahead.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    response: float = RESPONSE  # deceleration [m/s^2] of the response
    margin: float = 1.0  # least gap [m] (giveway's own)
    force_limit: float = FORCE_LIMIT  # u_max [N] (Yang & Özgüner 2019, table 1)
    actuator: Actuator = field(default_factory=Actuator)  # the worst one that the ego may have

    def __post_init__(self) -> None:
        require_positive("response", self.response, "m/s^2")
        require_not_negative("margin", self.margin, "m")
        require_positive("force_limit", self.force_limit, "N")


class VehicleLayer:
    """The safety layer for vehicles, a filter between controller and vehicle.

    Args:
        model: Model of the ego's motion.
        limits: Limits of the ego's response.

    Attributes:
        restores: Whether the safe distance is too small, and restored gently.
    """

    REASON: Final = "vehicle ahead"

    def __init__(self, model: LongitudinalModel, limits: VehicleLimits) -> None:
        dt, self._actuator = model.time_step, limits.actuator
        hardest = min(limits.force_limit, limits.actuator.brake.limit) / model.mass
        response = min(limits.response, hardest)
        vehicle = [dt, model.mass, model.friction, response, hardest, limits.margin]
        self._numbers = np.array([*vehicle, *Lagging.of(limits.actuator, dt)])
        self._memory = past_commands(limits.actuator.dead_time, dt), np.zeros(3)
        self.restores = False

    def reset(self) -> None:
        """Forget the past."""
        for array in self._memory:
            array[:] = 0.0
        self.restores = False

    def filter(self, force: float, speed: float, ahead: VehicleAhead | None) -> float:
        """Return the force [N] if it keeps a safe distance, or the largest one below it that does.

        A vehicle that cuts in leaves less than the safe distance. It is restored gently.

        Args:
            force: Force [N] that the controller asks for, for the step from now on.
            speed: Speed of the ego [m/s].
            ahead: Vehicle ahead, or None without one.
        """
        if ahead is None:
            self.restores = False
            return force
        restores = self.restores or ahead.new
        asked = self._actuator.acting(force)
        safe, self.restores = safe_following_force(
            asked, speed, ahead, restores, self._numbers, self._memory
        )
        return force if safe == asked else self._actuator.command(float(safe))

    def applied(self, force: float) -> None:
        """Remember the force [N] that acts in the step from now on.

        Args:
            force: Force [N]; at most the one that :meth:`filter` has returned.
        """
        remember(self._actuator.acting(force), self._numbers, self._memory)


@kernel
def remember(force: float, numbers: Array, memory: tuple[Array, Array]) -> None:
    """Remember a force [N] that is to act; arguments as for :func:`safe_following_force`."""
    commands, acting = memory
    for i in range(commands.shape[0] - 1):
        commands[i] = commands[i + 1]
    commands[-1] = force
    hardest = numbers[1] * numbers[4]
    c = Lagging(numbers[6], numbers[7], numbers[8], numbers[9], numbers[10])
    advance_bound(max(commands.max(), -hardest), acting, c)


@kernel
def safe_following_force(
    force: float,
    speed: float,
    ahead: VehicleAhead,
    restores: bool,
    numbers: Array,
    memory: tuple[Array, Array],
) -> tuple[float, bool]:
    """Find the largest force up to ``force`` [N] that keeps the safe distance, or restores it.

    Args:
        force: Force [N] that the controller asks for.
        speed: Speed of the ego [m/s].
        ahead: Vehicle ahead.
        restores: Whether the safe distance was too small before, or the vehicle ahead is new.
        numbers: Time step [s], mass [kg], friction [N.s/m], deceleration of the response and
            largest one of the ego [m/s^2], margin [m], and fields of :class:`Lagging`.
        memory: Past forces (delay + 1,) [N], the latest last; bounds (3,) [N] of the forces that
            act, see :func:`bound_step`.

    Returns:
        The force, and whether the safe distance is still too small.
    """
    mass, alpha, response, hardest, margin = numbers[1:6]
    friction = helping_friction(alpha, memory[0], numbers)
    if keeps_behind(force, speed, ahead, numbers, memory):
        return force, False
    braking = max(friction * speed - mass * response, -mass * hardest)
    safe = keeps_behind(braking, speed, ahead, numbers, memory)
    if safe and not restores:
        return _largest(braking, force, speed, ahead, numbers, memory), False
    gentle = max(RESTORING, _URGENCY * needed_behind(speed, ahead, margin))
    restoring = min(force, max(friction * speed - mass * gentle, -mass * hardest))
    if keeps_behind(restoring, speed, ahead, numbers, memory):
        return _largest(restoring, force, speed, ahead, numbers, memory), False
    return restoring, True


@inner
def _largest(
    safe: float,
    unsafe: float,
    speed: float,
    ahead: VehicleAhead,
    numbers: Array,
    memory: tuple[Array, Array],
) -> float:
    """The largest force [N] between a safe and an unsafe one, see :func:`keeps_behind`."""
    while unsafe - safe > RESOLUTION:
        middle = 0.5 * (safe + unsafe)
        if keeps_behind(middle, speed, ahead, numbers, memory):
            safe = middle
        else:
            unsafe = middle
    return safe


@kernel
def keeps_behind(
    force: float,
    speed: float,
    ahead: VehicleAhead,
    numbers: Array,
    memory: tuple[Array, Array],
) -> bool:
    """Return whether the ego stays behind a vehicle that brakes as hard as it can.

    Args:
        force: Force [N] whose acceleration is held until the next news. Then the ego responds.
        speed: Speed of the ego [m/s].
        ahead: Vehicle ahead.
        numbers: Numbers of the ego, as for :func:`safe_following_force`.
        memory: Past forces [N] and bounds of those that act, as there.
    """
    dt, mass, friction, response, hardest, margin = numbers[:6]
    c = Lagging(numbers[6], numbers[7], numbers[8], numbers[9], numbers[10])
    lags = c.drive_mean > 0.0 or c.brake_mean > 0.0 or c.fall > 0.0
    commands, acting = memory
    state = acting[0], acting[1], acting[2]
    delay, v, travel = commands.shape[0] - 1, speed, 0.0
    held = delay + max(1, int(np.ceil((ahead.step - ahead.age) / dt - WHOLE_STEPS)))
    force = max(force, -mass * hardest)
    acceleration = (force - helping_friction(friction, commands, numbers) * speed) / mass
    rear = ahead.gap - ahead.speed * ahead.age  # its place [m] at the last news
    for i in range(int(LONGEST_STOP / dt)):
        strongest = -response
        if i < held:
            # Within the reaction time any of the commands since then may act.
            strongest = acceleration
            for k in range(i + 1, delay + 1):
                strongest = max(strongest, commands[k] / mass)
        driven, braked, ends, state = bound_step(mass * strongest, state, c)
        if lags:
            strongest = (driven - braked) / mass
        after = max(v + strongest * dt, 0.0)
        travel += max(v, after) * dt
        if lags:
            travel += 0.125 * dt * dt * (ends[0] - ends[1]) / mass
        v = after
        worst = rear + braking_travel(ahead, ahead.age + (i + 1) * dt, dt)
        if travel > worst - margin - SLACK:
            return False
        if v <= 0.0 and i >= held - 1 and (not lags or (i >= held and ends[1] <= 0.0)):
            return True
    return False


@inner
def helping_friction(friction: float, commands: Array, numbers: Array) -> float:
    """The friction [N.s/m] that helps to brake; 0 if a force acts late, at another speed."""
    late = commands.shape[0] > 1 or numbers[7] > 0.0 or numbers[9] > 0.0 or numbers[10] > 0.0
    return 0.0 if late else friction


@inner
def braking_travel(ahead: VehicleAhead, time: float, dt: float) -> float:
    """The least distance [m] of the vehicle ahead in a ``time`` [s] since the last news.

    From the news on it brakes as hard as it can, in steps: its speed falls at once at the
    beginning of each (semi-implicit Euler, as in SUMO), and it can stop within a step.

    Args:
        ahead: Vehicle ahead.
        time: Time [s].
        dt: Length of a step [s] if news come in each control step.
    """
    step = max(ahead.step, dt)
    v, left, travel = ahead.speed, time, 0.0
    while left > 0.0 and v > 0.0:
        v = max(v - ahead.braking * step, 0.0)
        travel += v * min(step, left)
        left -= step
    return travel


@kernel
def needed_behind(speed: float, ahead: VehicleAhead, margin: float) -> float:
    """The deceleration [m/s^2] that keeps the margin if the vehicle ahead goes on as at the news.

    It is 0 if the vehicle ahead does not brake and the gap does not close.

    Args:
        speed: Speed of the ego [m/s].
        ahead: Vehicle ahead.
        margin: Least gap [m].
    """
    slower = min(ahead.decelerates * ahead.age, ahead.speed)  # [m/s] than at the news
    late = slower * ahead.step  # distance [m] that it is nearer than it seems
    room = max(ahead.gap - late - margin, _LEAST_ROOM)
    closing = max(0.0, speed - ahead.speed)
    needed = closing * closing / (2.0 * room)
    if ahead.decelerates > _BRAKES:
        stops = 0.5 * ahead.speed * (ahead.speed / ahead.decelerates - ahead.step)
        needed = max(needed, speed * speed / (2.0 * (room + max(stops + late, 0.0))))
    return needed


@kernel
def safe_speed_behind(ahead: VehicleAhead, response: float, margin: float, delay: float) -> float:
    """The speed [m/s] up to which the safe distance is kept until the next news.

    Args:
        ahead: Vehicle ahead.
        response: Deceleration [m/s^2] of the response.
        margin: Gap [m] that remains.
        delay: Time [s] that passes in any case before the ego brakes.
    """
    wait = delay + max(0.0, ahead.step - ahead.age)
    room = ahead.gap - ahead.speed * ahead.age - margin
    room += braking_travel(ahead, LONGEST_STOP, max(ahead.step, 1e-3))
    lag = response * wait
    speed: float = np.sqrt(lag * lag + 2.0 * response * max(room, 0.0)) - lag
    return speed
