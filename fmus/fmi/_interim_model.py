"""What an FMU says about itself, and how its variables are found."""

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from math import isfinite
from pathlib import Path

from fmus.errors import FmuVariableError
from fmus.model import FmuDescription


@dataclass(frozen=True)
class Variable:
    """A variable of an FMU."""

    name: str
    reference: int
    kind: str  # FMI's type: "Real", "Float64", "Boolean", ...
    causality: str  # "input", "output", "parameter", ...
    scalar: bool
    settable: bool  # before the start

    @property
    def is_real(self) -> bool:
        """A scalar in double precision."""
        return self.scalar and self.kind in {"Real", "Float64"}

    @property
    def is_boolean(self) -> bool:
        """A scalar that is true or false."""
        return self.scalar and self.kind == "Boolean"


@dataclass(frozen=True)
class Model:
    """A Co-Simulation FMU that can run on this platform."""

    path: Path
    fmi_version: str  # "2.0" or "3.0"
    guid: str
    identifier: str  # the name of its binaries
    folder: str  # where this platform's binary is in the archive
    variables: Mapping[str, Variable]
    saves_state: bool

    def role(self, name: str, causality: str) -> Variable:
        """The variable for an input or output of the vehicle: a real scalar.

        Raises:
            FmuVariableError: it is missing, or of another causality or type.
        """
        variable = self._find(name)
        if variable.causality == causality and variable.is_real:
            return variable
        fitting = [
            v.name for v in self.variables.values() if v.causality == causality and v.is_real
        ]
        msg = (
            f"{self.path}: variable '{name}' is {variable.causality} {variable.kind}; expected a "
            f"real scalar {causality}: {', '.join(fitting) or 'the FMU has none'}"
        )
        raise FmuVariableError(msg)

    def settable(self, name: str, value: float | bool) -> Variable:
        """The variable for a start value: a real or boolean scalar that can be set.

        Raises:
            FmuVariableError: it is missing, cannot be set, or not to this value.
        """
        variable = self._find(name)
        problem = None
        if not variable.settable:
            problem = f"'{name}' is {variable.causality}; expected a parameter or an input"
        elif variable.is_boolean and not isinstance(value, bool):
            problem = "expected true or false"
        elif variable.is_real and (isinstance(value, bool) or not isfinite(value)):
            problem = "expected a finite number"
        elif not (variable.is_real or variable.is_boolean):
            problem = f"'{name}' is {variable.kind}; expected a real or boolean scalar"
        if problem is None:
            return variable
        msg = f"{self.path}: start value {name} = {value}: {problem}"
        raise FmuVariableError(msg)

    def _find(self, name: str) -> Variable:
        if name in self.variables:
            return self.variables[name]
        close = get_close_matches(name, self.variables, n=1)
        hint = f"did you mean '{close[0]}'?" if close else f"it has {', '.join(self.variables)}"
        msg = f"{self.path}: no variable '{name}' in the FMU; {hint}"
        raise FmuVariableError(msg)
