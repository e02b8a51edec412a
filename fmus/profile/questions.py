"""The questions of a draft: the open points about a variable, and the lines that answer them."""

import re
from collections.abc import Mapping, Sequence
from typing import Final

from fmus.description import units
from fmus.description.model import Channel, Dimension, Model, Variable
from fmus.profile.draft import Line
from fmus.profile.matching import FORCES, OTHER_PARTS, ROLES, Guess, words_of
from fmus.profile.wheels import radius_line, variables_line, wheel_group
from fmus.text import printable

# Force [N] of a fully pressed pedal of a car of 1000 kg
PEDAL_FORCE: Final = {"throttle": 4000.0, "brake": 8000.0}
DRIVES_ONLY: Final = frozenset(["drive", "driving", "propulsion", "propulsive", "accelerating"])
MISSING: Final = {  # further inputs that an FMU needs
    "drive_force": "brake_force", "brake_force": "drive_force",
    "throttle": "brake", "brake": "throttle",
}  # fmt: skip
LEAD: Final = 0.5  # Assumed time constant [s] of a speed controller
# Words for parts that may drive the vehicle
POWERED: Final = frozenset(["wheel", "wheels", "engine", "motor", "rear", "front"])


def unit_question(variable: Variable, wanted: Dimension, *, pedal: bool) -> tuple[Line, str]:
    """Return the question about a variable without a unit, or with an unknown one."""
    common = units.COMMON[wanted]
    name = printable(variable.name, 60)
    told = _unit_in(variable.name, wanted) or _unit_described(variable.description, wanted)
    guess = told or common.split(",")[0]
    if pedal and (variable.maximum or 0.0) > 1.0:
        told = guess = "%"
    if variable.unit:
        unit = printable(variable.unit, 40)
        line = Line("unit", "?", f"{common}: the FMU's unit '{unit}' is unknown", sure=False)
        return line, f"'{name}' is in '{unit}', an unknown unit; add unit = \"{guess}\" or its like"
    line = Line("unit", told or "?", f"{common}: the FMU does not say", sure=False)
    return line, f"'{name}' has no unit; add unit = \"{guess}\", or what it is ({common})"


def _unit_in(name: str, wanted: Dimension) -> str:
    """Return the unit at the end of a name, as it is usually written: km/h for ``speed_kmh``."""
    last = re.split(r"[_.\s]", name)[-1]
    unit = units.named(last)
    if not last or last == name or unit.dimension != wanted:
        return ""
    usual = units.COMMON[wanted].split(", ")
    return next((u for u in usual if units.named(u).factor == unit.factor), last)


def _unit_described(description: str, wanted: Dimension) -> str:
    """Return the unit in a description: km/h for ``speed [km/h]`` or ``speed in km/h``."""
    found = re.findall(r"\[([^\]]+)\]|\(([^)]+)\)|\bin ([^\s,;]+)", description)
    words = (word.strip().rstrip(".") for match in found for word in match if word.strip())
    return next((word for word in words if units.named(word).dimension == wanted), "")


def axis_question(model: Model, inputs: Sequence[Variable]) -> tuple[tuple[Line, ...], str] | None:
    """Return the question about the only torque or percentage input, which can be a force.

    A group of torques that differ only by the wheel's place counts as one.

    Returns:
        Lines and question, or None unless there is exactly one such input.
    """
    able = [v for v in inputs if not (OTHER_PARTS - POWERED) & set(words_of(v.name))]
    torques = wheel_group(model, able, units.FORCE, named=False)
    if torques and len(torques) == sum(_is(model, v, units.TORQUE) for v in able):
        named, (radius, _) = variables_line(torques), radius_line(model, torques[0].name)
        what = (
            f"radius = {radius.value} or that of the wheels [m] (and of a motor's torque gain = "
            "ratio of the gears)"
        )
        lines = (open_line(named), open_line(radius))
        return lines, _as_force(torques[0], units.TORQUE, what)
    shares = [v for v in able if v.scalar and v.is_real and _is(model, v, units.NONE)]
    if len(shares) != 1:
        return None
    what = "gain = the force at 1, which is 100 % [N]"
    lines = (
        Line("variable", shares[0].name, sure=False),
        Line("gain", "?", "N at 100 %", sure=False),
    )
    return lines, _as_force(shares[0], units.NONE, what)


def _is(model: Model, variable: Variable, dimension: Dimension) -> bool:
    unit = model.unit_of(variable)
    return unit is not None and units.to_si(unit).dimension == dimension


def _as_force(variable: Variable, dimension: Dimension, what: str) -> str:
    name, unit = printable(variable.name, 60), printable(variable.unit, 40)
    kind = f"'{name}' is in {unit}, {units.quantity(dimension)}"
    return f"no input is a force; {kind}: if it drives and brakes, add {what}"


def open_line(line: Line) -> Line:
    """Return a line as a question."""
    return Line(line.key, line.value, line.comment, sure=False)


def contradiction(model: Model, guess: Guess, variable: Variable, role: str) -> tuple[Line, str]:
    """Return the question about a variable whose unit contradicts its name."""
    unit, name = printable(variable.unit, 40), printable(variable.name, 60)
    what = f"'{name}' is in {unit}, {units.quantity(guess.found)}"
    wanted = ROLES[role].dimension if role in ROLES else units.NONE
    if role in FORCES and guess.found == units.TORQUE:
        line, question = radius_line(model, variable.name)
        return line, question and f"{what}; add radius = {line.value} or that of the wheels [m]"
    if role in FORCES and guess.found == units.MASS:
        line = Line("unit", "?", f"{unit} is a mass, not a force; kgf?", sure=False)
        return line, f'{what}, not a force; add the true unit: unit = "N" (or "kgf")'
    usual = units.COMMON.get(wanted, "1").split(",")[0]
    line = Line("unit", "?", f"{unit} is {units.quantity(guess.found)}", sure=False)
    return line, f'{what}, not {units.quantity(wanted)}; add the true unit: unit = "{usual}"'


# ---- the effect of braking inputs ----


def braking_question(role: str, variable: Variable) -> tuple[list[Line], str]:
    """Return profile lines and the open question about how strongly an input brakes.

    Returns:
        Lines and question; both empty if nothing is open.
    """
    name = printable(variable.name, 60)
    if role in PEDAL_FORCE:
        strength = PEDAL_FORCE[role]
        comment = "N at the wheels, fully pressed; giveway fmu identify measures it"
        line = Line("full_force", strength, comment, sure=False)
        force = f"full_force = {strength:g} or what it is [N]"
        question = f"the FMU does not say how strong it is; write {force}"
        backwards, sign = _brakes_by_negative(role, variable)
        return [line, *backwards], "; ".join(filter(None, (question, sign)))
    if role == "speed_setpoint":
        line = Line("lead", LEAD, "s, the time constant of its own speed controller", sure=False)
        question = (
            f"the FMU does not say how fast it follows '{name}', and so how hard it brakes; write "
            f"lead = {LEAD:g} or what it is [s]"
        )
        return [line], question
    least = variable.minimum
    if role in {"force", "acceleration"} and least is not None and least >= 0.0:
        return [], (
            f"'{name}' is never negative (min = {least:g}): what brakes? Name that input; see "
            "'driven by' in docs/vehicles.md"
        )
    if role == "force" and DRIVES_ONLY & set(words_of(variable.name)):
        return [], f"'{name}' is named after a drive: does it brake, too, when it is negative?"
    return _brakes_by_negative(role, variable)


def _brakes_by_negative(role: str, variable: Variable) -> tuple[list[Line], str]:
    if role not in {"brake", "brake_force"} or variable.maximum is None or variable.maximum > 0.0:
        return [], ""
    name, line = printable(variable.name, 60), Line("gain", -1.0, "it counts negative", sure=False)
    return [line], f"'{name}' is never positive (max = {variable.maximum:g}): add gain = -1.0"


def idle_brake(ranked: Mapping[str, Sequence[Guess]], way: Sequence[str]) -> str:
    """Return the question about a brake that the way to drive does not use, or an empty text."""
    used = [ranked[role][0].channel.variable.name for role in way]
    if len(way) > 1:
        return ""
    for role in ("brake_force", "brake"):
        for guess in ranked[role]:
            brake = guess.channel.variable.name
            if brake not in used and guess.fits is not False:
                return (
                    f"'{printable(brake, 60)}' is an input, too: does '{printable(used[0], 60)}' "
                    "alone brake? Then take the lines; else name what drives and what brakes"
                )
    return ""


def signed_question(
    ranked: Mapping[str, Sequence[Guess]], inputs: Sequence[Variable]
) -> tuple[tuple[Line, ...], str] | None:
    """Ask whether the only input, named after a drive or a brake, is both, depending on its sign.

    Returns:
        Lines of [inputs.force] and question, or None if the only input is neither.
    """
    if len(numbers(inputs)) != 1:
        return None
    for role, sign in (("brake_force", -1), ("brake", -1), ("drive_force", 1), ("throttle", 1)):
        if not ranked[role] or (role != "brake_force" and ranked[role][0].fits is False):
            continue
        channel = ranked[role][0].channel
        name, other = printable(channel.name, 60), MISSING[role]
        ask = f"'{name}' is a {role}, but no input is a {other}: is it both, by its sign?"
        variable = Line("variable", channel_name(channel), channel.variable.unit, sure=False)
        if role in FORCES:
            gain = Line("gain", float(sign), "positive forwards", sure=False)
            return (variable, gain), f"{ask} Then write gain = {sign:.1f}"
        gain = Line("gain", "?", f"{'-' * (sign < 0)}N at 1", sure=False)
        force = f"{'minus ' * (sign < 0)}the force at 1, which is 100 % [N]"
        return (variable, gain), f"{ask} Then write gain = {force}"
    return None


def channel_name(channel: Channel) -> str:
    """Return the name as a profile may write it; an array of one element needs no number."""
    return channel.name if channel.variable.size > 1 else channel.variable.name


def numbers(variables: Sequence[Variable]) -> list[str]:
    """Return the names of all numeric variables, and of the first elements of arrays."""
    return [
        printable(channel_name(Channel(variable, element)), 40)
        for variable in variables
        if variable.is_real or variable.is_integer
        for element in range(min(variable.size, 8))
    ]
