"""The judgement of how a vehicle answers: does it drive, does it stop, and is it the one told.

A run and ``giveway fmu check`` use the same. What fails cannot be driven safely. A question is a
factor between measured and told mass that a wrong unit or another load explains.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from fmus.checking.answers import Answers
from fmus.checking.findings import Finding
from fmus.checking.scale import CLASS_MASSES, DOUBTFUL, GROSS, KnownMass, named
from fmus.profile.advice import gain_line
from fmus.profile.tables import Axis
from fmus.profile.vehicle_profile import VehicleProfile

# [m/s2] deceleration that each vehicle must reach; with cold brakes, approved cars reach 6.43 m/s2
# (UN Regulation 13-H), approved buses and trucks 5 m/s2 (UN Regulation 13)
LEAST_BRAKING: Final = 3.0
NEARLY: Final = (
    0.9  # share of a promised deceleration that is enough, for drag and time to build up
)
BOTH: Final = 1.25  # ratio of two factors from which they are not the same one
ROAD: Final = KnownMass(CLASS_MASSES["passenger"][0], 44000.0, "cars to lorries of 44 t")


@dataclass(frozen=True)
class Told:
    """The facts that are told of a vehicle.

    Attributes:
        drive: Mass that drives, or None if nothing is told.
        brake: Mass that brakes, or None if nothing is told.
        least_braking: Deceleration that it must reach [m/s2].
        flag: Flag that tells the mass.
        limit_flag: Flag that tells the largest force.
    """

    drive: KnownMass | None
    brake: KnownMass | None
    least_braking: float
    flag: str
    limit_flag: str


def told_of(
    profile: VehicleProfile | None,
    mass: float | None,
    vehicle_class: str | None = None,
    *,
    flag: str = "--vehicle-mass",
    limit_flag: str = "--vehicle-force-limit",
) -> Told:
    """Return what a profile and flags tell of a vehicle; a flag comes before [model].

    Args:
        profile: Profile of the vehicle.
        mass: Mass that a flag tells [kg].
        vehicle_class: SUMO's vehicle class, if a flag tells it.
        flag: Flag that tells the mass.
        limit_flag: Flag that tells the largest force.
    """
    least, model = least_braking(profile), profile.model if profile else None
    if profile is not None and (profile.inputs.acceleration or profile.inputs.speed_setpoint):
        if model is None:
            seeming = profile.inverse_map.mass
            known = KnownMass(seeming, seeming, "[inverse_map] of the profile")
            return Told(known, known, least, flag, limit_flag)
    elif mass is not None:
        known = KnownMass(mass, mass, flag)
        return Told(known, known, least, flag, limit_flag)
    if model is not None:
        sides = (model.drive or model, model.brake or model)
        drive, brake = (KnownMass(s.mass, s.mass, "[model] of the profile") for s in sides)
        return Told(drive, brake, least, flag, limit_flag)
    if vehicle_class is not None:
        known = KnownMass(*CLASS_MASSES[vehicle_class], f"--ego-class {vehicle_class}")
        return Told(known, known, least, flag, limit_flag)
    return Told(None, None, least, flag, limit_flag)


def least_braking(profile: VehicleProfile | None) -> float:
    """Return the deceleration [m/s2] that a vehicle must reach: 3, or what its profile promises."""
    brake = profile.model.brake if profile and profile.model else None
    if brake is None or brake.limit is None:
        return LEAST_BRAKING
    return min(LEAST_BRAKING, NEARLY * brake.limit)


def too_weak(profile: VehicleProfile | None, mass: float, force_limit: float) -> str:
    """Return why a force limit [N] cannot brake a mass [kg] as a vehicle must; empty if it can."""
    least, most = least_braking(profile), force_limit / mass
    if most >= least:
        return ""
    return (
        f"{force_limit:g} N brake {mass:g} kg with {most:.2g} m/s2 at most; expected {least:.2g} "
        f"m/s2 or more: write --vehicle-force-limit {_rounded(8.0 * mass)}, or, for a vehicle that "
        "brakes less, `limit` [m/s2] in [model.brake] of its profile"
    )


def judge(answers: Answers, told: Told, profile: VehicleProfile | None) -> list[Finding]:
    """Return the findings about driving, braking and the mass, up to the first that fails.

    Args:
        answers: Measured answers.
        told: What is told of the vehicle.
        profile: Profile of the vehicle, for the lines to change in it.
    """
    role, braking_role = roles_of(profile)
    found = [_driving(answers, role, profile)]
    if found[-1].verdict == "pass":
        found.append(_braking(answers, told, braking_role, profile))
        if found[-1].verdict == "pass":
            found.append(_weighing(answers, told, role, braking_role))
    return found


def roles_of(profile: VehicleProfile | None) -> tuple[str, str]:
    """Return the input that drives and the one that brakes."""
    inputs = profile.inputs if profile else None
    role = next((name for name, axis in inputs or () if isinstance(axis, Axis)), "force")
    return role, {"drive_force": "brake_force", "throttle": "brake"}.get(role, role)


def _driving(answers: Answers, role: str, profile: VehicleProfile | None) -> Finding:
    name, mass = "drives against coasting", answers.drive_mass
    if 0.0 < mass < np.inf:
        return Finding(name, "pass", f"it drives like {_size(mass)} kg")
    if mass < 0.0:
        return Finding(
            name, "fail", "a force forwards slows it down, against coasting",
            f"turn the sign: write {gain_line(profile, 'inputs', role, -1.0, '')}, or in "
            "[outputs.speed]",
        )  # fmt: skip
    return Finding(
        name, "fail", "no force moves it",
        f"is [inputs.{role}] the right variable? A gear, ignition or hand brake may have to be set "
        "under [parameters]",
    )  # fmt: skip


def _braking(answers: Answers, told: Told, role: str, profile: VehicleProfile | None) -> Finding:
    name, least = "brakes against coasting", told.least_braking
    text = (
        f"from {answers.fastest:.2g} m/s, {answers.brake_force:.4g} N brake it with "
        f"{answers.braking:.2g} m/s2 beyond coasting"
    )
    if answers.braking >= NEARLY * least:
        return Finding(name, "pass", text)
    text += f"; expected {least:.2g} m/s2 or more"
    if answers.brake_mass < 0.0:
        return Finding(
            name, "fail", f"{text}: braking makes it faster",
            f"turn the sign: write {gain_line(profile, 'inputs', role, -1.0, '')}",
        )  # fmt: skip
    if answers.brake_mass == np.inf and answers.braking < 0.1 * least:
        return Finding(
            name, "fail", f"{text}: nothing brakes it",
            f"is [inputs.{role}] the right variable, and its unit and gain?",
        )  # fmt: skip
    mass = min(answers.drive_mass, answers.brake_mass)
    advice = f"see unit and gain in [inputs.{role}]"
    if answers.brake_force < 1.1 * least * mass and mass <= ROAD.high:
        advice = (
            f"if it weighs {_size(mass)} kg, run it with {told.flag} {_size(mass)} "
            f"{told.limit_flag} {_rounded(8.0 * mass)}; else {advice}"
        )
    promise = "for a vehicle that brakes less, write `limit` [m/s2] in [model.brake]"
    return Finding(name, "fail", text, f"{advice}; {promise}")


def _weighing(answers: Answers, told: Told, role: str, braking_role: str) -> Finding:
    """Compare the masses of both sides with what is told, and with each other."""
    name = "weighs what is told"
    worst, finding = 1.0 / BOTH, Finding(name, "pass", "as far as anything is told of it")
    for what, mass, known, axis in (
        ("drives", answers.drive_mass, told.drive, role),
        ("brakes", answers.brake_mass, told.brake, braking_role),
    ):
        against = known or ROAD
        factor = against.excess(mass)
        if max(factor, 1.0 / factor) > worst * BOTH:
            worst = max(factor, 1.0 / factor)
            finding = _factor(f"it {what} like {_size(mass)} kg", factor, against, axis, told, mass)
    ratio = answers.brake_mass / answers.drive_mass
    if told.drive is None and max(ratio, 1.0 / ratio) >= max(GROSS, worst):
        return Finding(
            name, "fail",
            f"it drives like {_size(answers.drive_mass)} kg and brakes like "
            f"{_size(answers.brake_mass)} kg: {named(ratio)}",
            f"see unit, gain and full_force in [inputs.{role}] and [inputs.{braking_role}]",
        )  # fmt: skip
    return finding


def _factor(
    text: str, factor: float, known: KnownMass, role: str, told: Told, mass: float
) -> Finding:
    name, size = "weighs what is told", max(factor, 1.0 / factor)
    if size < DOUBTFUL:
        return Finding(name, "pass", f"{text}; told: {known}")
    text = f"{text}, and not {known}: {named(factor)}"
    unit = f"unit or gain in [inputs.{role}] or [outputs.speed]"
    right = f"{told.flag} {_size(mass)}"
    if 8000.0 / mass < LEAST_BRAKING:
        right += f" {told.limit_flag} {_rounded(8.0 * mass)}"
    if known.origin.startswith("[inverse_map]"):
        right = f"`mass = {_size(mass)}` in [inverse_map]"
    if size >= GROSS:
        return Finding(name, "fail", text, f"see {unit}; if it does weigh that, write {right}")
    return Finding(
        name, "ask", f"{text}; does it weigh that?", f"if so, write {right}; else correct {unit}"
    )


def _size(mass: float) -> str:
    return f"{mass:.4g}" if mass < 1e4 else f"{mass:.0f}"


def _rounded(value: float) -> str:
    return f"{float(f'{value:.2g}'):g}" if value < 1e6 else f"{value:.2g}"
