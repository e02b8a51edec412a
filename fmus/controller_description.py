"""What the controller FMU says of itself: its parameters, its variables, modelDescription.xml."""

from __future__ import annotations

import dataclasses
import math
import struct
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final
from xml.sax.saxutils import quoteattr

from fmus.errors import FmuVariableError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fmus.bundled import FmiVersion

CONTROLLER: Final = "LongitudinalController"
CONTROLLER_FILES: Final[dict[FmiVersion, str]] = {
    "2.0": f"{CONTROLLER}.fmi2.fmu",
    "3.0": f"{CONTROLLER}.fmi3.fmu",
}
HORIZON_MAX: Final = 200  # [steps] HORIZON_MAX of parameters.h
FAR_AWAY: Final = 1e9  # [m] [m/s] nobody is in front, there is no limit: FAR_AWAY of instance.c

_FIRST_PARAMETER: Final = 10  # value references: PARAMETER_M ...
_OBSTACLE: Final = 100  # ... and OBSTACLE of instance.h


def _parameter(default: float, symbol: str, unit: str | None, description: str) -> Any:
    metadata = {"symbol": symbol, "unit": unit, "description": description}
    return field(default=default, metadata=metadata)


@dataclass(frozen=True, slots=True)
class ControllerParameters:
    """Start values of an exported controller (Yang & Özgüner 2019, table 1).

    The order is that of ``Parameters`` in parameters.h. K_p is not the printed 300, which
    contradicts the paper's own steady-state error.

    Raises:
        FmuVariableError: a value is out of range.
    """

    mass: float = _parameter(1000.0, "M", "kg", "Mass of the vehicle as the MPC sees it")
    friction: float = _parameter(100.0, "alpha", "N.s/m", "Its viscous friction coefficient")
    time_step: float = _parameter(0.05, "dt", "s", "Time between two decisions")
    reference_speed: float = _parameter(4.0, "v_r", "m/s", "Desired speed")
    safe_distance: float = _parameter(8.0, "d_safe", "m", "Distance to keep to the obstacle")
    margin: float = _parameter(
        0.0, "d_margin", "m", "Added to d_safe in plans: how far the vehicle may miss the model"
    )
    buffer_distance: float = _parameter(
        10.0, "d_buffer", "m", "Distance over which the PID's reference speed rises to v_r"
    )
    speed_min: float = _parameter(0.0, "v_min", "m/s", "Lowest speed of a plan")
    speed_max: float = _parameter(20.0, "v_max", "m/s", "Highest speed of a plan")
    force_limit: float = _parameter(8000.0, "u_max", "N", "Largest force, either way")
    force_rate_limit: float = _parameter(
        1000.0, "du_max", "N", "Largest change of a plan's force from one step to the next"
    )
    proportional_gain: float = _parameter(2400.0, "K_p", "N.s/m", "Proportional gain of the PID")
    integral_gain: float = _parameter(10.0, "K_i", "N/m", "Integral gain of the PID")
    derivative_gain: float = _parameter(100.0, "K_d", "N.s2/m", "Derivative gain of the PID")
    horizon: int = _parameter(15, "N", None, "Horizon of the MPC in steps of dt")
    mpc: bool = _parameter(
        True, "mpc", None, "true: the MPC, with the PID as its fallback; false: the PID alone"
    )

    def __post_init__(self) -> None:
        for entry in dataclasses.fields(self)[:_REALS]:
            value = getattr(self, entry.name)
            may_be_zero = entry.metadata["symbol"] in _MAY_BE_ZERO
            good = math.isfinite(value) and (value >= 0.0 if may_be_zero else value > 0.0)
            expected = f"a finite number {'>=' if may_be_zero else '>'} 0"
            _require(good, entry.name, value, f"{expected} [{entry.metadata['unit']}]")
        expected = f"more than speed_min = {self.speed_min:g} [m/s]"
        _require(self.speed_max > self.speed_min, "speed_max", self.speed_max, expected)
        whole = isinstance(self.horizon, int) and 2 <= self.horizon <= HORIZON_MAX
        _require(whole, "horizon", self.horizon, f"a whole number from 2 to {HORIZON_MAX} [steps]")
        lost = self.friction * self.time_step / self.mass
        expected = "at most 1, or forward Euler is unstable; lower friction or time_step"
        _require(lost <= 1.0 or not self.mpc, "friction * time_step / mass", lost, expected)


_REALS: Final = 14  # parameters before the horizon
_MAY_BE_ZERO: Final = frozenset({"alpha", "d_safe", "d_margin", "v_min", "K_p", "K_i", "K_d"})


def _require(good: bool, name: str, value: object, expected: str) -> None:
    if not good:
        msg = f"controller FMU: {name} = {value}: expected {expected}"
        raise FmuVariableError(msg)


def token_of(build: str, parameters: ControllerParameters) -> str:
    """The GUID or instantiation token of an export.

    The binaries are the same for all exports, and the only text of the model description that a
    host hands over to them is this one: so the start values travel in it, bit by bit.
    """
    values = dataclasses.astuple(parameters)
    return f"{build};{''.join(struct.pack('>d', float(value)).hex() for value in values)}"


# ---- variables ----


@dataclass(frozen=True, slots=True)
class _Variable:
    """A variable; ``start`` None: it is calculated."""

    name: str
    reference: int
    kind: str  # "real", "whole", "boolean"
    causality: str
    description: str
    unit: str | None = None
    start: float | bool | None = None
    elements: int = 0  # of an array; 0: a scalar
    low: float | None = None
    high: float | None = None

    @property
    def variability(self) -> str:
        """As the causality wants it."""
        if self.causality in ("parameter", "structuralParameter"):
            return "fixed"
        return "discrete" if self.causality == "output" else "continuous"


_NOBODY = f"{FAR_AWAY:g}, or infinity: nobody"
_WHY = (
    "Why the MPC has no plan: 0 it has one, or is not asked; 1 the obstacle will be nearer than "
    "d_safe; 2 the force limits leave no speed within its bounds; 3 not even the hardest braking "
    "keeps d_safe; 4 not even the strongest drive holds v_min; 5 no plan keeps all constraints; "
    "6 none was found that does"
)
_TIME = _Variable("time", 0, "real", "independent", "Simulation time", "s")
_INPUTS: Final = (
    _Variable("speed", 1, "real", "input", "Speed of the vehicle", "m/s", 0.0),
    _Variable(
        "position",
        2,
        "real",
        "input",
        "Place along the path of the vehicle's point that keeps the distance, e.g. its front",
        "m",
        0.0,
    ),
    _Variable(
        "gap",
        3,
        "real",
        "input",
        f"Distance from there to the closest obstacle in front now; {_NOBODY}",
        "m",
        FAR_AWAY,
    ),
    _Variable(
        "speed_limit",
        4,
        "real",
        "input",
        "Caps the desired speed, e.g. before a stop line; 0: come to a stand",
        "m/s",
        FAR_AWAY,
    ),
)
_OUTPUTS: Final = (
    _Variable("force", 5, "real", "output", "Force to be held until the next decision", "N"),
    _Variable("reference_speed", 6, "real", "output", "Speed that who acts aims at", "m/s"),
    _Variable("acting", 7, "whole", "output", "Who acts: 1 the MPC, 2 the PID"),
    _Variable("feasible", 8, "boolean", "output", "Whether the MPC acts: it has a plan"),
    _Variable("infeasibility", 9, "whole", "output", _WHY),
)


def _obstacles(version: FmiVersion, horizon: int) -> Iterator[_Variable]:
    text = f"Predicted place of the closest obstacle, in the coordinate of position; {_NOBODY}"
    if version == "3.0":
        text = f"[i]: after i dt. {text}"
        yield _Variable(
            "obstacle_position", _OBSTACLE, "real", "input", text, "m", FAR_AWAY, horizon
        )
        return
    for i in range(horizon):
        name, after = f"obstacle_position[{i + 1}]", f"{text}; after {i + 1} dt"
        yield _Variable(name, _OBSTACLE + i, "real", "input", after, "m", FAR_AWAY)


def _parameters(version: FmiVersion, parameters: ControllerParameters) -> Iterator[_Variable]:
    for number, entry in enumerate(dataclasses.fields(parameters)):
        symbol, value = entry.metadata["symbol"], getattr(parameters, entry.name)
        kind = {"N": "whole", "mpc": "boolean"}.get(symbol, "real")
        structural = symbol == "N" and version == "3.0"
        low = 2 if symbol == "N" else 0.0 if symbol in _MAY_BE_ZERO else None
        # In FMI 2 there are as many inputs as were exported; the array of FMI 3 follows N.
        high = (HORIZON_MAX if structural else value) if symbol == "N" else None
        yield _Variable(
            symbol,
            _FIRST_PARAMETER + number,
            kind,
            "structuralParameter" if structural else "parameter",
            entry.metadata["description"],
            entry.metadata["unit"],
            value,
            low=low,
            high=high,
        )


def variables_of(version: FmiVersion, parameters: ControllerParameters) -> list[_Variable]:
    """All variables in the order of the model description."""
    own = list(_parameters(version, parameters))
    return [_TIME, *_INPUTS, *_obstacles(version, parameters.horizon), *_OUTPUTS, *own]


# ---- XML ----

_UNITS: Final = {
    "s": {"s": 1},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "kg": {"kg": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
    "N.s2/m": {"kg": 1},
}
_TYPES: Final[dict[FmiVersion, dict[str, str]]] = {
    "2.0": {"real": "Real", "whole": "Integer", "boolean": "Boolean"},
    "3.0": {"real": "Float64", "whole": "Int32", "boolean": "Boolean"},
}


def _attributes(values: dict[str, object]) -> str:
    """XML attributes; those that are None are left out."""
    return "".join(f" {k}={quoteattr(_text(v))}" for k, v in values.items() if v is not None)


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):  # as short as it can be written without loss
        return f"{value:g}" if float(f"{value:g}") == value else repr(value)
    return str(value)


def _element(version: FmiVersion, v: _Variable) -> str:
    common = {
        "name": v.name,
        "valueReference": v.reference,
        "causality": v.causality,
        "variability": v.variability,
        "initial": {"output": "calculated", "parameter": "exact"}.get(v.causality),
        "description": v.description,
    }
    start = v.start if not v.elements else " ".join([_text(v.start)] * v.elements)
    values = {"unit": v.unit, "min": v.low, "max": v.high, "start": start}
    kind = "UInt64" if v.causality == "structuralParameter" else _TYPES[version][v.kind]
    if version == "2.0":
        inner = f"<{kind}{_attributes(values)}/>"
        return f"    <ScalarVariable{_attributes(common)}>{inner}</ScalarVariable>"
    if not v.elements:
        return f"    <{kind}{_attributes(common | values)}/>"
    dimension = f'<Dimension valueReference="{_FIRST_PARAMETER + _REALS}"/>'
    return f"    <{kind}{_attributes(common | values)}>{dimension}</{kind}>"


def _structure(version: FmiVersion, variables: list[_Variable]) -> Iterator[str]:
    """Every output depends on every input, at once; at the start on every parameter too."""
    inputs = [i for i, v in enumerate(variables, start=1) if v.causality == "input"]
    outputs = [i for i, v in enumerate(variables, start=1) if v.causality == "output"]
    if version == "2.0":
        known = " ".join(map(str, inputs))
        yield "    <Outputs>"
        yield from (f'      <Unknown index="{i}" dependencies="{known}"/>' for i in outputs)
        yield "    </Outputs>"
        yield "    <InitialUnknowns>"
        yield from (f'      <Unknown index="{i}"/>' for i in outputs)
        yield "    </InitialUnknowns>"
        return
    known = " ".join(str(variables[i - 1].reference) for i in inputs)
    references = [variables[i - 1].reference for i in outputs]
    yield from (f'    <Output valueReference="{r}" dependencies="{known}"/>' for r in references)
    yield from (f'    <InitialUnknown valueReference="{r}"/>' for r in references)


def _interface(version: FmiVersion, sources: tuple[str, ...]) -> Iterator[str]:
    state = "FMUstate" if version == "2.0" else "FMUState"
    flags = {
        "modelIdentifier": CONTROLLER,
        "canHandleVariableCommunicationStepSize": True,
        "canNotUseMemoryManagementFunctions": True if version == "2.0" else None,
        f"canGetAndSet{state}": True,
        f"canSerialize{state}": True,
    }
    if version == "3.0":
        yield f"  <CoSimulation{_attributes(flags)}/>"
        return
    yield f"  <CoSimulation{_attributes(flags)}>"
    yield "    <SourceFiles>"
    yield from (f'      <File name="{name}"/>' for name in sources)
    yield "    </SourceFiles>"
    yield "  </CoSimulation>"


def model_description(
    version: FmiVersion,
    parameters: ControllerParameters,
    *,
    token: str,
    tool: str,
    sources: tuple[str, ...],
) -> bytes:
    """The file modelDescription.xml of an export.

    Args:
        version: of FMI.
        parameters: the start values; in FMI 2 the horizon is also the number of inputs.
        token: of :func:`token_of`.
        tool: what generated the FMU.
        sources: the C files, in the order of compilation.
    """
    head = {
        "fmiVersion": version,
        "modelName": CONTROLLER,
        "guid" if version == "2.0" else "instantiationToken": token,
        "description": "Longitudinal regulator: MPC behind predicted obstacles, PID as fallback",
        "author": "The giveway engineers",
        "license": "MIT",
        "generationTool": tool,
        "variableNamingConvention": "structured",
    }
    variables = variables_of(version, parameters)
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', f"<fmiModelDescription{_attributes(head)}>"]
    lines += _interface(version, sources)
    lines.append("  <UnitDefinitions>")
    for name, base in _UNITS.items():
        lines.append(f'    <Unit name="{name}"><BaseUnit{_attributes(dict(base))}/></Unit>')
    lines += [
        "  </UnitDefinitions>",
        "  <LogCategories>",
        '    <Category name="logStatusError" description="Calls and values refused, and why"/>',
        '    <Category name="logEvents" description="Who takes over, with debug logging on"/>',
        "  </LogCategories>",
        f'  <DefaultExperiment startTime="0" stepSize="{parameters.time_step!r}"/>',
        "  <ModelVariables>",
        *(_element(version, variable) for variable in variables),
        "  </ModelVariables>",
        "  <ModelStructure>",
        *_structure(version, variables),
        "  </ModelStructure>",
        "</fmiModelDescription>",
        "",
    ]
    return "\n".join(lines).encode()
