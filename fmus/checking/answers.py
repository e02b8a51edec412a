"""Measures how a vehicle answers to driving and braking forces, each against coasting.

The forces adapt to the vehicle: from 1 N they are doubled until it drives off, then lowered until
they are not limited. Thus a wrong unit of a factor of 1000 is measured as well as a right one.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fmus.checking.manoeuvres import Opener, Phase, Trace, drive
from fmus.isolation import processes_reused

REFERENCE_SPEED: Final = 8.0  # [m/s] speed from which the brakes are judged
MOVING: Final = 1.0  # [m/s] change of speed with which a vehicle has driven off
FIRST_FORCE, STRONGEST = 1.0, 1e6  # [N] forces of the search
GENTLE: Final = 1.5  # [m/s2] acceleration at which the masses are measured
FIRM: Final = 12.0  # [m/s2] strongest braking that is tried: that of tyres on dry asphalt
STRONGER: Final = 4.0  # factor from a force that is not felt to the next one
LOWER: Final = 0.6  # factor from one force to the next lower one
SAME: Final = 1.15  # ratio of two masses of one vehicle
TRIES: Final = 5  # largest number of forces per side
STILL: Final = 0.3  # [m/s] speed below which brakes may hold
CREEPS: Final = 0.3  # [m/s] speed without a force from which a vehicle creeps
UNKNOWN: Final = 1000.0  # [kg] first guess of the mass of a vehicle that creeps
LINEAR: Final = 0.9  # share of the variation of coasting that a straight line explains
STEEPEST: Final = -0.5  # [1/s] change of coasting with the speed that is drag, and no lag
SEEN: Final = 0.05  # [m/s2] acceleration that differs from coasting


@dataclass(frozen=True)
class Answers:
    """The answers of a vehicle to forces.

    Attributes:
        drive_mass: Drive force over the acceleration beyond coasting [kg]; negative if driving
            slows it down, infinite if it does not answer.
        brake_mass: Brake force over the deceleration beyond coasting [kg], likewise.
        fastest: Speed at which the strong braking began [m/s].
        brake_force: Brake force of that braking [N].
        braking: Largest deceleration beyond coasting under it [m/s2], as a mean over half a second.
        traces: Traces of the last drives.
    """

    drive_mass: float
    brake_mass: float = np.inf
    fastest: float = 0.0
    brake_force: float = 0.0
    braking: float = 0.0
    traces: tuple[Trace, ...] = ()


@processes_reused()
def measure(opener: Opener, *, brake_force: float, gentle: float = GENTLE) -> Answers:
    """Drive a vehicle off, let it coast, and brake it gently and as strongly as a run may.

    Args:
        opener: Function that opens the vehicle.
        brake_force: Largest brake force of the run [N].
        gentle: Deceleration [m/s2] at which the mass that brakes is measured.

    Raises:
        FmuError: the FMU fails.
    """
    seeming = _driving_off(opener)
    if not 0.0 < seeming < np.inf:
        return Answers(seeming)
    trace, force, mass = _drives(opener, seeming, gentle)
    if not 0.0 < mass < np.inf:
        return Answers(mass, traces=(trace,))
    brake_mass = _mass(trace, -1.0)
    strength = gentle * mass
    for _ in range(TRIES):
        if not 0.0 < brake_mass < mass / SAME:
            break
        strength = gentle * brake_mass  # stronger than expected: with less force, nothing saturates
        trace = _drive(opener, force, strength)
        found = _mass(trace, -1.0)
        if SAME > found / brake_mass > 1.0 / SAME:
            break
        brake_mass = found
    heavier = max(mass, brake_mass) if 0.0 < brake_mass < np.inf else mass
    strongest = min(brake_force, FIRM * heavier)
    hard = drive(
        opener,
        [
            Phase(0.0, 0.5),
            Phase(force, 15.0, below=REFERENCE_SPEED),
            Phase(0.0, 1.0, above=STILL),
            Phase(-strongest, 5.0, above=STILL),
        ],
    )
    fastest, braking = _hardest(hard)
    return Answers(mass, brake_mass, fastest, strongest, braking, (trace, hard))


def _driving_off(opener: Opener) -> float:
    """Return the force over the acceleration [kg] of a vehicle that drives off, with its sign."""
    forces = FIRST_FORCE * 2.0 ** np.arange(round(np.log2(STRONGEST / FIRST_FORCE)) + 1)
    trace = drive(
        opener,
        [Phase(0.0, 1.0), *(Phase(float(f), 1.0, -MOVING, MOVING) for f in forces)],
    )
    gained = float(trace.speed[-1] - trace.speed[0])
    if abs(gained) < 0.5 * MOVING:
        return np.inf
    if trace.speed[np.argmax(trace.force > 0.0)] > CREEPS or not trace.force.any():
        return UNKNOWN
    return float(trace.force.sum()) * trace.step_size / gained


def _drives(opener: Opener, mass: float, gentle: float) -> tuple[Trace, float, float]:
    """Return a drive whose force is not limited, the force [N], and the mass that drives [kg]."""
    force = gentle * mass
    trace = _drive(opener, force, force)
    best = trace, force, _mass(trace, 1.0)
    for _ in range(TRIES):
        if best[2] < 0.0:
            break
        felt = best[2] < np.inf  # else it is too weak to be told from coasting
        force = min(LOWER * force, gentle * best[2]) if felt else STRONGER * force
        trace = _drive(opener, force, force)
        found = _mass(trace, 1.0)
        if felt and not 0.0 < found < best[2] / SAME:
            break
        best = trace, force, found
    return best


def _drive(opener: Opener, force: float, brake: float) -> Trace:
    return drive(
        opener,
        [
            Phase(0.0, 0.5),
            Phase(force, 8.0, below=REFERENCE_SPEED),
            Phase(0.0, 3.0, above=0.5 * REFERENCE_SPEED),
            Phase(-brake, 1.2, above=STILL),
        ],
    )


def _mass(trace: Trace, sign: float) -> float:
    """Return the force of one sign over what it adds to coasting [kg]."""
    force, change = trace.force, np.diff(trace.speed) / trace.step_size
    acting = np.flatnonzero(np.sign(force) == sign)
    pushes = np.flatnonzero(force > 0.0)
    after = np.flatnonzero((force == 0.0) & (np.arange(force.size) > pushes[-1]))
    if not acting.size or not after.size:
        return np.inf
    ending = _ending(acting, 1.0 if sign > 0.0 else 0.5, trace.step_size)
    coasting = _coasting(trace.speed[after], change[after], trace.step_size)
    answer = sign * float((change[ending] - coasting(trace.speed[ending])).mean())
    strength = abs(float(force[acting[-1]]))
    return np.inf if abs(answer) < SEEN else strength / answer


def _coasting(
    speed: NDArray[np.float64], change: NDArray[np.float64], step: float
) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """Return the acceleration [m/s2] of coasting as a function of the speed [m/s].

    It is a straight line where drag makes it one, else the mean of the last half second.
    """
    last = _ending(np.arange(speed.size), 0.5, step)
    mean = float(change[last].mean())
    settled = _ending(np.arange(speed.size), 1.0, step)
    v, a = speed[settled] - speed[last].mean(), change[settled] - mean
    power, spread = float(v @ v), float(a @ a)
    slope = float(v @ a) / power if power > 0.0 else 0.0
    explained = slope**2 * power / spread if spread > 0.0 else 0.0
    if not STEEPEST <= slope <= 0.0 or explained < LINEAR:
        slope = 0.0
    middle = float(speed[last].mean())
    return lambda at: mean + slope * (at - middle)


def _ending(indices: NDArray[np.int_], seconds: float, step: float) -> NDArray[np.int_]:
    """Return the indices of the last ``seconds``, or of the second half if it is shorter."""
    number = min(round(seconds / step), (indices.size + 1) // 2)
    return indices[-max(number, 1) :]


def _hardest(trace: Trace) -> tuple[float, float]:
    """Return the speed before the strong braking [m/s], and its deceleration [m/s2]."""
    braked = np.flatnonzero(trace.force < 0.0)
    if not braked.size:
        return float(trace.speed[-1]), 0.0
    first, h = int(braked[0]), trace.step_size
    before = trace.speed[: first + 1]
    coasted = min(round(0.5 / h), first)
    coasting = float(before[-1] - before[-1 - coasted]) / (coasted * h)
    speed = trace.speed[first:]
    window = min(max(round(0.5 / h), 1), max(speed.size - 2, 1))
    changes = (speed[window:] - speed[:-window]) / (window * h)
    return float(speed[0]), coasting - float(changes.min())
