"""The description of an FMU: its interfaces, its variables, their units."""

from __future__ import annotations

import enum
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path


class Kind(enum.StrEnum):
    """The kinds in which an FMU is stepped."""

    CO_SIMULATION = "co-simulation"  # it brings its own solver
    MODEL_EXCHANGE = "model-exchange"  # it gives derivatives, and giveway integrates


REAL_TYPES = frozenset({"Real", "Float64", "Float32"})
INTEGER_TYPES = frozenset(
    {"Integer", "Enumeration"}
    | {f"{sign}Int{bits}" for sign in ("", "U") for bits in (8, 16, 32, 64)}
)
NUMERIC_TYPES = REAL_TYPES | INTEGER_TYPES


Value = bool | int | float | str | list[float]
"""A start value of a variable, as a profile writes it."""

Dimension = tuple[int, int, int, int, int, int, int, int]
"""Exponents of the base units kg, m, s, A, K, mol, cd, rad."""


@dataclass(frozen=True)
class FmuDescription:
    """The data that identify an FMU in the record of a run."""

    name: str  # the model's name
    fmi_version: str  # e.g. "2.0"
    guid: str  # FMI 2's GUID, FMI 3's instantiation token
    generation_tool: str  # name of the tool; empty if the FMU does not say
    sha256: str  # SHA-256 of the .fmu file


@dataclass(frozen=True)
class Unit:
    """A unit as an FMU defines it: SI = factor * raw + offset.

    Attributes:
        name: Name as the FMU writes it.
        dimension: Exponents of the base units, or None if the FMU does not give them.
    """

    name: str
    factor: float = 1.0
    offset: float = 0.0
    dimension: Dimension | None = None


@dataclass(frozen=True)
class Variable:
    """A variable of an FMU."""

    name: str
    reference: int
    kind: str  # FMI's type: "Real", "Float64", "Boolean", ...
    causality: str  # "input", "output", "parameter", "local", ...
    variability: str = "continuous"
    start: str = ""  # start value as it is written; empty without one
    shape: tuple[int, ...] = ()  # shape of an FMI 3 array, from its dimensions' start values
    unit: str = ""  # name of its unit; empty without one
    description: str = ""
    minimum: float | None = None  # smallest value, in the variable's unit
    maximum: float | None = None
    settable: bool = False  # True if it can be set before the start
    clocks: tuple[int, ...] = ()  # references of the clocks with which it may change
    again_on: int = 0  # line of another variable of the same name; 0 without one
    negated: bool = False  # FMI 1's negatedAlias: the value is that of the reference, times -1

    @property
    def scalar(self) -> bool:
        """True if the variable is no array."""
        return not self.shape

    @property
    def is_real(self) -> bool:
        """True for a floating-point variable."""
        return self.kind in REAL_TYPES

    @property
    def is_integer(self) -> bool:
        """True for a whole number or an enumeration."""
        return self.kind in INTEGER_TYPES

    @property
    def is_boolean(self) -> bool:
        """True for a boolean variable."""
        return self.kind == "Boolean"

    @property
    def size(self) -> int:
        """Number of values of the variable."""
        size = 1
        for extent in self.shape:
            size *= extent
        return size


@dataclass(frozen=True)
class Channel:
    """One number that goes into, or comes out of, an FMU at every step."""

    variable: Variable
    element: int = 0  # index in an array, row by row from 0

    @property
    def name(self) -> str:
        """Name as a user would write it: ``x``, or ``x[2]`` for an array's second element."""
        return (
            f"{self.variable.name}[{self.element + 1}]"
            if self.variable.shape
            else self.variable.name
        )

    @property
    def parts(self) -> tuple[tuple[Channel, float], ...]:
        """The single channels, each with its factor."""
        return ((self, 1.0),)


@dataclass(frozen=True)
class JointChannel(Channel):
    """One number for several variables: each is set to its share, or their mean is read.

    ``variable`` and ``element`` are those of the first of them.
    """

    joined: tuple[tuple[Channel, float], ...] = ()

    @property
    def name(self) -> str:
        """Names of all of them, or the name of an array of which they are all elements."""
        if len(self.joined) == self.variable.size > 1:
            return self.variable.name
        return ", ".join(channel.name for channel, _factor in self.joined)

    @property
    def parts(self) -> tuple[tuple[Channel, float], ...]:
        """The single channels, each with its factor."""
        return self.joined


@dataclass(frozen=True)
class Clock:
    """A clock of FMI 3.

    Attributes:
        variability: How its interval varies: "constant", "fixed", "countdown", "triggered", ...
        interval: Time between two ticks [s], or None if the description does not tell.
        shift: Time of the first tick [s].
        needed: True if variables belong to it.
    """

    name: str
    reference: int
    causality: str
    variability: str
    interval: float | None
    shift: float
    needed: bool


@dataclass(frozen=True)
class Interface:
    """One of the kinds in which an FMU can run.

    Attributes:
        identifier: Name of its binaries.
        flags: Capability flags that are numbers, text or true, as the FMU writes them.
    """

    kind: Kind
    identifier: str
    saves_state: bool = False  # canGetAndSetFMUState
    needs_execution_tool: bool = False
    variable_step: bool = True  # canHandleVariableCommunicationStepSize
    fixed_internal_step: float | None = None  # [s]
    completed_step_needed: bool = True  # Model Exchange: completedIntegratorStep
    flags: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Link:
    """A connection: raw value of the target = gain * raw value of the source + shift.

    Names are those of the system: ``part.variable``, or a connector of the system itself.
    """

    source: str
    target: str
    gain: float = 1.0
    shift: float = 0.0


@dataclass(frozen=True)
class System:
    """Several FMUs that are one vehicle.

    Attributes:
        parts: Model of each part, by its name.
        links: Connections between parts.
        inputs: Links from each input or parameter of the system to its parts.
        outputs: Link of each output of the system.
        values: Start values that the system's file gives, by ``part.variable``.
        doubts: Remarks for the user.
    """

    parts: Mapping[str, Model]
    links: tuple[Link, ...]
    inputs: Mapping[str, tuple[Link, ...]]
    outputs: Mapping[str, Link]
    values: Mapping[str, Value]
    doubts: tuple[str, ...] = ()

    def part_of(self, name: str) -> tuple[str, str] | None:
        """Return the part and the variable in it for a name, or None for a connector."""
        fits = [part for part in self.parts if name.startswith(f"{part}.")]
        part = max(fits, key=len, default="")
        return (part, name.removeprefix(f"{part}.")) if part else None


@dataclass(frozen=True)
class Model:
    """The model description of an FMU, and the place of its binary for this platform."""

    path: Path
    fmi_version: str  # "1.0", "2.0" or "3.0"
    name: str
    guid: str
    generation_tool: str
    description: str
    interfaces: Mapping[Kind, Interface]
    variables: Mapping[str, Variable]
    units: Mapping[str, Unit]
    platforms: tuple[str, ...]  # folders of the archive that hold binaries
    states: int  # number of continuous states
    event_indicators: int
    default_step: float | None  # [s] step of its default experiment
    default_tolerance: float | None
    system: System | None = None  # the FMUs that it is made of, or None for one FMU
    clocks: tuple[Clock, ...] = ()

    def unit_of(self, variable: Variable) -> Unit | None:
        """Return the unit of a variable, or None if it has none."""
        return None if not variable.unit else self.units.get(variable.unit, Unit(variable.unit))
