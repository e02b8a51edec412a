"""The model description of the controller FMU, for both versions of FMI."""

import dataclasses
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final
from xml.sax.saxutils import quoteattr

from fmus.profile.bundled import FmiVersion
from fmus.sources.parameters import (
    CONTROLLER,
    FAR_AWAY,
    HORIZON_MAX,
    MAY_BE_ZERO,
    REALS,
    ControllerParameters,
)

_FIRST_PARAMETER: Final = 10  # value references: PARAMETER_M ...
_OBSTACLE: Final = 100  # ... and OBSTACLE of instance.h

# ---- variables ----


@dataclass(frozen=True, slots=True)
class _Variable:
    """A variable of the controller FMU. It is calculated if ``start`` is None."""

    name: str
    reference: int
    kind: str  # "real", "whole", "boolean"
    causality: str
    description: str
    unit: str | None = None
    start: float | bool | None = None
    elements: int = 0  # number of elements of an array; 0: a scalar
    low: float | None = None
    high: float | None = None

    @property
    def variability(self) -> str:
        """Variability that belongs to the causality."""
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
        low = 2 if symbol == "N" else 0.0 if symbol in MAY_BE_ZERO else None
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
    """Return all variables in the order of the model description."""
    own = list(_parameters(version, parameters))
    # FMI 2 can do without time; FMI Library reports as an error that it has no start value.
    time = [_TIME] if version == "3.0" else []
    return [*time, *_INPUTS, *_obstacles(version, parameters.horizon), *_OUTPUTS, *own]


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


def _attributes(values: Mapping[str, object]) -> str:
    """Return XML attributes without those that are None."""
    return "".join(f" {k}={quoteattr(_text(v))}" for k, v in values.items() if v is not None)


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):  # shortest text without loss
        return f"{value:g}" if float(f"{value:g}") == value else repr(value)
    return str(value)


def _element(version: FmiVersion, v: _Variable) -> str:
    common: dict[str, object] = {
        "name": v.name,
        "valueReference": v.reference,
        "causality": v.causality,
        "variability": v.variability,
        "initial": {"output": "calculated", "parameter": "exact"}.get(v.causality),
        "description": v.description,
    }
    start = v.start if not v.elements else " ".join([_text(v.start)] * v.elements)
    values: dict[str, object] = {"unit": v.unit, "min": v.low, "max": v.high, "start": start}
    kind = "UInt64" if v.causality == "structuralParameter" else _TYPES[version][v.kind]
    if version == "2.0":
        inner = f"<{kind}{_attributes(values)}/>"
        return f"    <ScalarVariable{_attributes(common)}>{inner}</ScalarVariable>"
    if not v.elements:
        return f"    <{kind}{_attributes(common | values)}/>"
    dimension = f'<Dimension valueReference="{_FIRST_PARAMETER + REALS}"/>'
    return f"    <{kind}{_attributes(common | values)}>{dimension}</{kind}>"


def _structure(version: FmiVersion, variables: list[_Variable]) -> Iterator[str]:
    """Yield the dependencies: every output on every input, and at the start also on parameters."""
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
    """Return the file modelDescription.xml of an export.

    Args:
        version: Version of FMI.
        parameters: Start values; in FMI 2 the horizon is also the number of inputs.
        token: Token of :func:`token_of`.
        tool: Name of the tool that generated the FMU.
        sources: C files in the order of compilation.
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
