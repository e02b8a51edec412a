"""A controller profile drafted from names: only what leaves no doubt is used."""

from __future__ import annotations

import re
from typing import Final, NoReturn

from fmus.description.model import Model, Variable
from fmus.errors import FmuProfileError
from fmus.profile.controller_profile import (
    GUIDE,
    SERIES,
    TOLD,
    ControllerProfile,
    make_controller_profile,
)
from fmus.text import listed

_NAMES: Final = {  # of variables, in small letters and without separators and brackets
    "speed": "speed egospeed velocity egovelocity v vego vx",
    "acceleration": "acceleration egoacceleration a aego ax",
    "position": "position egoposition station s",
    "last_force": "lastforce previousforce appliedforce",
    "gap": "gap obstaclegap gaptoobstacle",
    "person_gap": "persongap pedestriangap gaptoperson gaptopedestrian",
    "leader_gap": "leadergap leadgap gaptoleader",
    "leader_speed": "leaderspeed leadspeed vleader vlead",
    "speed_limit": "speedlimit vlimit vmax",
    "stop_gap": "stopgap gaptostop stoplinegap",
    "obstacle_positions": "obstacleposition obstaclepositions",
    "obstacle_gaps": "obstaclegaps predictedgap predictedgaps",
}
_ANSWERS: Final = {
    "force": "force u f wantedforce",
    "acceleration": "acceleration wantedacceleration desiredacceleration aset aref ades acmd",
    "speed": "speed wantedspeed desiredspeed speedsetpoint vset vref vdes vcmd",
}
_NUMBER = re.compile(r"\[\d+\]$")


def draft_controller(model: Model) -> ControllerProfile:
    """The profile of a controller whose names say what its variables are.

    Raises:
        FmuProfileError: there is doubt; the message says which lines to write.
    """
    inputs: dict[str, dict[str, str]] = {}
    for variable in model.variables.values():
        if variable.causality != "input":
            continue
        base = _NUMBER.sub("", variable.name)
        roles = _roles_of(base, _NAMES)
        if not roles or (_is_series(variable) != (roles[0] in SERIES)):
            _doubt(
                model,
                f"what is its input '{variable.name}' to be told? Write [inputs.ROLE] with "
                f'variable = "{variable.name}", ROLE one of {", ".join(TOLD)}',
            )
        if inputs.setdefault(roles[0], {"variable": base})["variable"] != base:
            _doubt(model, f"'{base}' and '{inputs[roles[0]]['variable']}' are both {roles[0]}")
    answers = {
        role: {"variable": variable.name}
        for variable in model.variables.values()
        if variable.causality == "output"
        for role in _roles_of(variable.name, _ANSWERS)
    }
    if len(answers) != 1:
        outputs = listed([v.name for v in model.variables.values() if v.causality == "output"], 8)
        _doubt(
            model,
            f"which of its outputs ({outputs or 'it has none'}) is the answer? Write one of "
            "[outputs.force], [outputs.acceleration], [outputs.speed] with variable = ...",
        )
    tables = {"inputs": inputs, "outputs": answers}
    return make_controller_profile(tables, f"{model.path}: drafted profile")


def _roles_of(name: str, known: dict[str, str]) -> list[str]:
    plain = re.sub(r"[^a-z0-9]", "", name.lower())
    return [role for role, names in known.items() if plain in names.split()]


def _is_series(variable: Variable) -> bool:
    return bool(variable.shape) or _NUMBER.search(variable.name) is not None


def _doubt(model: Model, doubt: str) -> NoReturn:
    raise FmuProfileError(
        f"{model.path}: needs a controller profile (--controller-profile FILE.toml): {doubt}; "
        f"{GUIDE} shows one"
    )
