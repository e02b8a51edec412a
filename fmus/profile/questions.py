"""The questions of a draft: what is open about a variable, and the line that answers it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from fmus.description import units
from fmus.description.model import Channel
from fmus.profile.draft import Line
from fmus.profile.matching import FORCES, OTHER_PARTS, ROLES, words_of
from fmus.text import printable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fmus.description.model import Dimension, Model, Variable
    from fmus.profile.matching import Guess


POWERED: Final = frozenset(["wheel", "wheels", "engine", "motor", "rear", "front"])  # they drive


def unit_question(variable: Variable, wanted: Dimension, *, pedal: bool) -> tuple[Line, str]:
    """The question about a variable without a unit, or with an unknown one."""
    common = units.COMMON[wanted]
    name = printable(variable.name, 60)
    told = _unit_in(variable.name, wanted)
    guess = told or common.split(",")[0]
    if pedal and (variable.maximum or 0.0) > 1.0:
        told = guess = "%"
    if variable.unit:
        unit = printable(variable.unit, 40)
        line = Line("unit", "?", f"{common}: nobody knows the FMU's '{unit}'", sure=False)
        return line, f"'{name}' is in '{unit}', an unknown unit; add unit = \"{guess}\" or its like"
    line = Line("unit", told or "?", f"{common}: the FMU does not say", sure=False)
    return line, f"'{name}' has no unit; add unit = \"{guess}\", or what it is ({common})"


def _unit_in(name: str, wanted: Dimension) -> str:
    """The unit that a name ends with, as it is usually written: km/h for ``speed_kmh``."""
    last = re.split(r"[_.\s]", name)[-1]
    unit = units.named(last)
    if not last or last == name or unit.dimension != wanted:
        return ""
    usual = units.COMMON[wanted].split(", ")
    return next((u for u in usual if units.named(u).factor == unit.factor), last)


def axis_question(model: Model, inputs: Sequence[Variable]) -> tuple[str, Line, str] | None:
    """The question about the only torque or command in per cent: with a gain it is a force.

    Returns:
        the name, the line with the gain and the question; None: there is no such input, or two.
    """
    for dimension, what, line in (
        (units.TORQUE, "ratio of the gears / radius of the wheels [m]", "1/m"),
        (units.NONE, "the force at 1, which is 100 % [N]", "N at 100 %"),
    ):
        found = [
            v
            for v in inputs
            if v.scalar and v.is_real and (unit := model.unit_of(v)) is not None
            if units.to_si(unit).dimension == dimension
            and not (OTHER_PARTS - POWERED) & set(words_of(v.name))
        ]
        if len(found) == 1:
            name = printable(found[0].name, 60)
            kind = f"'{name}' is in {printable(found[0].unit, 40)}, {units.quantity(dimension)}"
            doubt = f"no input is a force; {kind}: if it drives and brakes, add gain = {what}"
            return found[0].name, Line("gain", "?", line, sure=False), doubt
    return None


def contradiction(guess: Guess, variable: Variable, role: str) -> tuple[Line, str]:
    """The question about a variable whose unit contradicts its name."""
    unit, name = printable(variable.unit, 40), printable(variable.name, 60)
    what = f"'{name}' is in {unit}, {units.quantity(guess.found)}"
    wanted = ROLES[role].dimension if role in ROLES else units.NONE
    if role in FORCES and guess.found == units.TORQUE:
        line = Line("gain", "?", "1/m: 1 over the wheels' radius", sure=False)
        return line, f"{what}; add gain = 1 / (radius of the wheels [m])"
    if role in FORCES and guess.found == units.MASS:
        line = Line("unit", "?", f"{unit} is a mass, not a force; kgf?", sure=False)
        return line, f'{what}, not a force; add the true unit: unit = "N" (or "kgf")'
    usual = units.COMMON.get(wanted, "1").split(",")[0]
    line = Line("unit", "?", f"{unit} is {units.quantity(guess.found)}", sure=False)
    return line, f'{what}, not {units.quantity(wanted)}; add the true unit: unit = "{usual}"'


def channel_name(channel: Channel) -> str:
    """The name as a profile may write it: an array of one element needs no number."""
    return channel.name if channel.variable.size > 1 else channel.variable.name


def numbers(variables: Sequence[Variable]) -> list[str]:
    """The names of all numeric variables; of an array the first elements one by one."""
    return [
        printable(channel_name(Channel(variable, element)), 40)
        for variable in variables
        if variable.is_real or variable.is_integer
        for element in range(min(variable.size, 8))
    ]
