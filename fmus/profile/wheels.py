"""The guesses about wheels: their torques, angles and speeds, which a radius turns into motion."""

import re
from collections.abc import Iterable, Sequence
from typing import Final

from fmus.description import units
from fmus.description.model import Dimension, Model, Variable
from fmus.profile.draft import Line
from fmus.profile.matching import all_words
from fmus.text import printable

WHEEL: Final = frozenset(["wheel", "wheels", "whl", "tyre", "tyres", "tire", "tires"])
NO_WHEEL: Final = frozenset(
    ["steer", "steering", "slip", "gear", "engine", "motor", "toe", "camber"]
    + ["yaw", "roll", "pitch", "clutch", "shaft", "propshaft"]
)
CORNERS: Final = frozenset(
    ["fl", "fr", "rl", "rr", "lf", "rf", "lr", "front", "rear", "left", "right", "f", "r", "l"]
)
RADII: Final = frozenset(["rwheel", "rw", "rdyn", "rtire", "rtyre", "wheelr", "reff", "rroll"])
RADIUS: Final = 0.3  # [m] of a passenger car's wheel
TURNED: Final[dict[Dimension, tuple[Dimension, ...]]] = {  # by the dimension of the motion
    units.SPEED: (units.TURNING, units.FREQUENCY),
    units.LENGTH: (units.ANGLE,),
    units.FORCE: (units.TORQUE,),
}


def wheel_group(
    model: Model, variables: Iterable[Variable], wanted: Dimension, *, named: bool
) -> list[Variable]:
    """Return the largest group of variables that differ only by the wheel's place.

    Args:
        model: Model of the FMU.
        variables: Variables to choose from.
        wanted: Dimension of the motion, such as that of a speed.
        named: True for variables that are named after wheels only.
    """
    groups: dict[tuple[str, ...], list[Variable]] = {}
    for variable in variables:
        words = all_words(variable.name)
        unit = model.unit_of(variable)
        dimension = units.to_si(unit).dimension if unit is not None else None
        if dimension not in TURNED[wanted] or not variable.is_real:
            continue
        if named and (NO_WHEEL & set(words) or not WHEEL & set(words)):
            continue
        stem = tuple(word for word in words if word not in CORNERS and not word.isdecimal())
        groups.setdefault((*stem, variable.unit), []).append(variable)
    return max(groups.values(), key=len, default=[])


def variables_line(group: Sequence[Variable]) -> Line:
    """Return the line that names a group: one variable, or all of them and of their elements."""
    first = group[0]
    comment = f"{first.unit}: {first.description}".rstrip(": ")
    if len(group) == 1 and first.size == 1:
        return Line("variable", first.name, comment)
    return Line("variables", tuple(variable.name for variable in group), comment)


def radius_line(model: Model, name: str) -> tuple[Line, str]:
    """Return the line with the wheels' radius, and the question about it or an empty text."""
    found = {v.name: float(v.start) * _metres(model, v) for v in _radii(model)}
    if len(set(found.values())) == 1:
        of, value = next(iter(found.items()))
        return Line("radius", value, f"m, the FMU's parameter {printable(of, 40)}"), ""
    line = Line("radius", RADIUS, "m of the wheels: the FMU does not say", sure=False)
    turns = f"'{printable(name, 60)}' is a wheel's: write radius = {RADIUS:g} or what it is [m]"
    return line, turns


def _radii(model: Model) -> list[Variable]:
    """Return the parameters that are the radius of a wheel."""
    return [
        v
        for v in model.variables.values()
        if v.causality == "parameter" and v.is_real and v.scalar and v.start
        if _metres(model, v) and _is_radius(v.name)
    ]


def _is_radius(name: str) -> bool:
    words = all_words(name)
    rolling = WHEEL | {"dynamic", "dyn", "rolling", "effective"}
    named = "radius" in words and (bool(rolling & set(words)) or len(words) == 1)
    return named or re.sub(r"[^a-z]", "", name.rpartition(".")[2].lower()) in RADII


def _metres(model: Model, variable: Variable) -> float:
    """Return the metres per unit of a variable, or 0 if it is no length above 0."""
    unit = model.unit_of(variable)
    si = units.to_si(unit) if unit is not None else None
    if (
        si is None
        or si.dimension != units.LENGTH
        or not 0.05 < float(variable.start) * si.factor < 5
    ):
        return 0.0
    return si.factor
