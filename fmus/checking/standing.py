"""The test whether a vehicle stays where it stopped: creep, roll-back, and brakes that hold."""

from collections.abc import Callable
from dataclasses import dataclass
from math import atan, inf
from pathlib import Path
from typing import Final

from fmus.checking.answers import Answers
from fmus.checking.findings import Finding
from fmus.checking.judgement import Told, roles_of
from fmus.checking.manoeuvres import Opener, Phase, Trace, drive, opener_of
from fmus.isolation import processes_reused
from fmus.profile.vehicle_profile import VehicleProfile

SLOPE: Final = 0.06  # tangent of the steepest usual grade of urban main roads
STANDS: Final = 0.05  # [m/s] speed up to which a vehicle counts as standing
SWAYS: Final = 0.1  # [m/s] the same for one that is braked again and again
LEAVES: Final = 0.02  # [m/s] speed from which it has left its place
SECONDS: Final = 3.0  # [s] duration of each drive
NAME: Final = "stays where it stopped"


@dataclass(frozen=True)
class Standing:
    """The motion of a vehicle that is at rest, and what keeps it there.

    Attributes:
        creep: Speed [m/s] that it reaches on the level without a demand.
        creep_force: Brake force [N] that would balance it when it begins to creep.
        roll: Speed [m/s] that it reaches on a grade without a demand; 0 without an input for it.
        hold: Brake force [N] that keeps it standing; 0 if it needs none, or one that is commanded
            again and again. None if none does.
        slowest: Speed [m/s] at which it still goes under the brakes.
    """

    creep: float = 0.0
    creep_force: float = 0.0
    roll: float = 0.0
    hold: float | None = 0.0
    slowest: float = 0.0

    @property
    def fact(self) -> str:
        """The motion without a demand, as a clause; empty if it stays."""
        facts = []
        if abs(self.creep) > LEAVES:
            facts.append(f"creeps at {self.creep:.2g} m/s without a demand")
        if abs(self.roll) > LEAVES:
            facts.append(f"rolls at {self.roll:.2g} m/s on a grade of {100 * SLOPE:g} %")
        return " and ".join(facts)


@processes_reused()
def standing(
    opener: Opener,
    held: Callable[[float], Opener],
    profile: VehicleProfile | None,
    answers: Answers,
    told: Told,
) -> Standing:
    """Find whether a vehicle stays at rest, and with which brake force if it does not.

    Args:
        opener: Function that opens the vehicle.
        held: Function that :func:`openers_held` returns.
        profile: Profile of the vehicle.
        answers: Measured answers. The force that is tried brakes it as hard as it must be able to.
        told: What is told of the vehicle.

    Raises:
        FmuError: the FMU fails.
    """
    grades = profile is not None and profile.inputs.grade is not None
    slopes = (atan(SLOPE), -atan(SLOPE)) if grades else ()
    strength = min(told.least_braking * answers.brake_mass, answers.brake_force)
    creep, rise = _creeping(opener)
    pull = rise * answers.brake_mass if creep > LEAVES else 0.0
    roll = max((_speed(opener, 0.0, slope) for slope in slopes), key=abs, default=0.0)
    if max(abs(creep), abs(roll)) <= LEAVES:
        return Standing(creep, 0.0, roll)
    slowest = inf
    for tried, force, hold, still in (
        (held(strength), 0.0, strength, STANDS),
        (held(2.0 * strength), 0.0, 2.0 * strength, STANDS),
        (opener, -strength, 0.0, SWAYS),
    ):
        fastest = max((_speed(tried, force, slope) for slope in (0.0, *slopes)), key=abs)
        if abs(fastest) <= still:
            return Standing(creep, pull, roll, hold, fastest)
        slowest = min(slowest, fastest, key=abs)
    return Standing(creep, pull, roll, None, slowest)


def holding(profile: VehicleProfile, force: float) -> VehicleProfile:
    """Return the profile with which a brake ``force`` [N] is held at a standstill."""
    inputs = profile.inputs.model_copy(update={"hold": force})
    return profile.model_copy(update={"inputs": inputs})


def openers_held(
    path: Path, *, step_size: float, profile: VehicleProfile, isolated: bool | None = None
) -> Callable[[float], Opener]:
    """Return a function from a brake force [N], held at a standstill, to an opener of vehicles.

    Args:
        path: Path of the .fmu file.
        step_size: Step size for which a force is held [s].
        profile: Profile of the vehicle.
        isolated: True to run it in a process of its own; None for this unless it is a shipped FMU.
    """
    return lambda force: opener_of(
        path, step_size=step_size, profile=holding(profile, force), isolated=isolated
    )


def stays(found: Standing, profile: VehicleProfile | None) -> Finding:
    """Return the finding about a vehicle at rest.

    Args:
        found: Its motion.
        profile: Profile of the vehicle, for the lines to change in it.
    """
    if not found.fact:
        return Finding(NAME, "pass", "without a demand it stands")
    if found.hold == 0.0:
        return Finding(
            NAME, "warn", f"it {found.fact}; it stands while a controller brakes, and a brake "
            "force that is held drives it backwards",
        )  # fmt: skip
    if found.hold is not None:
        return Finding(NAME, "pass", f"it {found.fact}; {found.hold:.4g} N of brake force hold it")
    role = roles_of(profile)[1]
    return Finding(
        NAME, "fail" if role in ("brake", "brake_force") else "warn",
        f"it {found.fact}, and goes at {found.slowest:.2g} m/s with the brake applied",
        f"see variable, unit and gain in [inputs.{role}], and whether [parameters] have a gear, a "
        "parking brake or a strength of the brakes to be set; `hold` in [inputs] is the brake "
        "force [N] at a standstill",
    )  # fmt: skip


def _creeping(opener: Opener) -> tuple[float, float]:
    """Return the speed [m/s] at the end without a demand, and the acceleration [m/s2] before."""
    trace = drive(opener, [Phase(0.0, SECONDS)])
    window = max(round(0.2 / trace.step_size), 1)
    rises = trace.speed[window:] - trace.speed[:-window]
    return _last(trace), float(rises.max(initial=0.0)) / (window * trace.step_size)


def _speed(opener: Opener, force: float, grade: float) -> float:
    """Return the speed [m/s] at the end of a drive from rest, as a mean over half a second."""
    return _last(drive(opener, [Phase(force, SECONDS, grade=grade)]))


def _last(trace: Trace) -> float:
    return float(trace.speed[-max(round(0.5 / trace.step_size), 1) :].mean())
