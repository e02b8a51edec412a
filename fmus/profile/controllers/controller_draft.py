"""The draft of a controller profile from names; only unambiguous names are used."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from fmus.description.model import Model, Variable
from fmus.errors import FmuProfileError
from fmus.profile.controllers.controller_profile import (
    GUIDE,
    SERIES,
    TOLD,
    ControllerProfile,
    make_controller_profile,
)
from fmus.profile.draft import toml_value
from fmus.text import listed, printable

_NAMES: Final = {  # names of variables, in small letters, without separators and brackets
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


@dataclass(frozen=True)
class ControllerDraft:
    """The roles of a controller's variables by their names, and the open questions.

    Attributes:
        path: Path of the FMU.
        inputs: Variables by role.
        answers: Output variables by role.
        open: Variables without a role, and the question about each of them.
    """

    path: Path
    inputs: Mapping[str, Variable]
    answers: Mapping[str, Variable]
    open: tuple[tuple[str, str], ...]

    def profile(self) -> ControllerProfile:
        """Return the profile if nothing is open.

        Raises:
            FmuProfileError: something is open; the message says which lines to write.
        """
        if self.open:
            raise FmuProfileError(
                f"{self.path}: needs a controller profile (--controller-profile FILE.toml): "
                f"{self.open[0][1]}; 'giveway fmu inspect {self.path} --controller --draft "
                f"FILE.toml' writes the rest, {GUIDE} explains it"
            )
        tables = {
            table: {role: {"variable": _base(variable.name)} for role, variable in found.items()}
            for table, found in (("inputs", self.inputs), ("outputs", self.answers))
        }
        return make_controller_profile(tables, f"{self.path}: drafted profile")

    @property
    def toml(self) -> str:
        """Return the draft as a file, with the open questions in comments."""
        blocks = [f"# Controller profile of {printable(self.path.name, 100)}, drafted from names."]
        for table, found in (("inputs", self.inputs), ("outputs", self.answers)):
            for role, variable in found.items():
                unit = "" if variable.unit else '\n# unit = "..."'
                name = toml_value(_base(variable.name))
                blocks.append(f"[{table}.{role}]\nvariable = {name}{unit}")
        for name, doubt in self.open:
            lines = [f"# ? {printable(doubt, 400)}"]
            if name:
                lines += ["# ? [inputs.ROLE]", f"# ? variable = {toml_value(name)}"]
            blocks.append("\n".join(lines))
        return "\n\n".join(blocks) + "\n"


def draft_controller(model: Model) -> ControllerDraft:
    """Draft the profile of a controller from the names of its variables."""
    inputs: dict[str, Variable] = {}
    doubts: dict[str, str] = {}
    for variable in model.variables.values():
        if variable.causality != "input":
            continue
        base = _base(variable.name)
        roles = _roles_of(base, _NAMES)
        if not roles or (_is_series(variable) != (roles[0] in SERIES)):
            doubts[base] = (
                f"what is its input '{base}' to be told? Write [inputs.ROLE] with variable = "
                f'"{base}", ROLE one of {", ".join(TOLD)}'
            )
        elif _base(inputs.setdefault(roles[0], variable).name) != base:
            doubts[base] = f"'{base}' and '{_base(inputs[roles[0]].name)}' are both {roles[0]}"
    outputs = [v for v in model.variables.values() if v.causality == "output"]
    answers = {role: v for v in outputs for role in _roles_of(v.name, _ANSWERS)}
    if len(answers) != 1:
        known = listed([v.name for v in outputs], 8) or "it has none"
        doubts[""] = (
            f"which of its outputs ({known}) is the answer? Write one of [outputs.force], "
            "[outputs.acceleration], [outputs.speed] with variable = ..."
        )
        answers = {}
    return ControllerDraft(model.path, inputs, answers, tuple(doubts.items()))


def _base(name: str) -> str:
    """Return the name of a series' variable without its number."""
    return _NUMBER.sub("", name)


def _roles_of(name: str, known: dict[str, str]) -> list[str]:
    plain = re.sub(r"[^a-z0-9]", "", name.lower())
    return [role for role, names in known.items() if plain in names.split()]


def _is_series(variable: Variable) -> bool:
    return bool(variable.shape) or _NUMBER.search(variable.name) is not None
