"""The reading of an FMU's model description.

FMPy's reader is not used, because it refuses FMUs that run without a fault, knows neither FMI 1's
capabilities nor the units of declared types, and does not report the line of a fault.
"""

import math
import os
import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Final

from fmus.archive.archive_check import Archive, open_archive
from fmus.archive.kinds import DESCRIPTION, ROOT, is_system
from fmus.archive.markup import Element, parse
from fmus.description.binaries import platforms_of
from fmus.description.model import FmuDescription, Interface, Kind, Model, Unit, Value, Variable
from fmus.description.systems import compose
from fmus.description.variables import (
    MAX_DESCRIPTION,
    MAX_SIZE,
    MAX_UNIT,
    VARIABLE_TAGS,
    broken,
    number,
    read_clocks,
    read_variables,
    whole,
)
from fmus.errors import FmuInterfaceError, FmuVariableError
from fmus.text import LIMIT, clean, printable

VERSIONS: Final = re.compile(r"(1\.0|2\.0|3\.0)(\.\d+)?")
TAGS: Final = {Kind.CO_SIMULATION: "CoSimulation", Kind.MODEL_EXCHANGE: "ModelExchange"}
TRUE: Final = frozenset({"true", "1"})
MAX_IDENTIFIER: Final = 240  # characters: with a suffix it is a file's name
KEPT: Final = VARIABLE_TAGS | {
    *("CoSimulation", "ModelExchange", "ScheduledExecution", "DefaultExperiment"),
    *("Implementation", "CoSimulation_StandAlone", "CoSimulation_Tool", "Capabilities"),  # FMI 1
    *("UnitDefinitions", "Unit", "BaseUnit", "ModelStructure"),
    *("Outputs", "Derivatives", "InitialUnknowns", "Unknown"),  # FMI 2
    *("Output", "ContinuousStateDerivative", "InitialUnknown", "EventIndicator"),  # FMI 3
}
BASE: Final = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


def read_model(path: Path, start_values: Mapping[str, Value] | None = None) -> Model:
    """Read an FMU's model description, without loading or unpacking the FMU.

    Args:
        path: File of the FMU.
        start_values: Start values by name. Those of structural parameters give the sizes of arrays.

    Raises:
        FmuFileError: the file is missing or refused, or its model description is broken.
        FmuInterfaceError: the FMU has a version of FMI, or an interface, that cannot be run.
        FmuVariableError: no array has a size that a start value demands.
    """
    archive = open_archive(path)
    model = model_of(archive)
    sizes = []
    for name, value in (start_values or {}).items():
        variable = model.variables.get(name)
        if variable is None or variable.causality != "structuralParameter":
            continue
        if isinstance(value, int) and not 0 <= value <= MAX_SIZE:
            what = f"start value {printable(name)} = {value}: expected a size, 0 to {MAX_SIZE}"
            raise FmuVariableError(f"{path}: {what}; change it under [parameters]")
        if isinstance(value, int):  # another type is refused with the other start values
            sizes.append((name, int(value)))
    return model_of(archive, tuple(sizes)) if sizes else model


@lru_cache(maxsize=4)  # preparing a vehicle needs it repeatedly
def model_of(archive: Archive, sizes: tuple[tuple[str, int], ...] = ()) -> Model:
    """Return the same as :func:`read_model` for an archive that is open already.

    Args:
        archive: Archive of the FMU.
        sizes: Structural parameters and their values.
    """
    path, where = archive.path, f"{archive.path}: {DESCRIPTION}"
    if is_system(path):
        return compose(archive, read_model)
    root = parse(archive.description, where, ROOT, KEPT)
    version = _version(root, path)
    guid = root.attributes.get("instantiationToken" if version == "3.0" else "guid")
    if guid is None:
        name = "instantiationToken" if version == "3.0" else "guid"
        raise broken(where, root, f"no {name}")
    interfaces = _interfaces(root, version, where)
    if not interfaces:
        raise FmuInterfaceError(f"{path}: {_nothing_to_run(root)}")
    variables = read_variables(root, version, where, dict(sizes))
    states, indicators = _structure(root, version, where, variables)
    experiment = root.first("DefaultExperiment")
    return Model(
        path=path,
        fmi_version=version,
        name=clean(root.get("modelName"), LIMIT),
        guid=guid,
        generation_tool=clean(root.get("generationTool"), LIMIT),
        description=clean(root.get("description"), MAX_DESCRIPTION),
        interfaces=interfaces,
        variables=variables,
        units=_units(root, version, where),
        platforms=platforms_of(archive),
        states=states,
        event_indicators=indicators,
        default_step=_positive(where, experiment, "stepSize"),
        default_tolerance=_positive(where, experiment, "tolerance"),
        clocks=read_clocks(root, where) if version == "3.0" else (),
    )


def describe(path: str | os.PathLike[str]) -> FmuDescription:
    """Return name, version and fingerprint of an FMU.

    Raises:
        FmuFileError: the file is missing or refused, or has no model description.
        FmuInterfaceError: the FMU has a version of FMI that cannot be run.
    """
    archive = open_archive(Path(path))
    model = model_of(archive)
    return FmuDescription(
        name=model.name,
        fmi_version=model.fmi_version,
        guid=model.guid,
        generation_tool=model.generation_tool,
        sha256=archive.sha256,
    )


# ---- parts of the description ----


def _version(root: Element, path: Path) -> str:
    where = f"{path}: {DESCRIPTION}"
    text = root.attributes.get("fmiVersion")
    if text is None:
        raise broken(where, root, "no fmiVersion")
    match = VERSIONS.fullmatch(text)
    if match is None:
        given = printable(text, 40) or "nothing"
        raise FmuInterfaceError(
            f"{path}: FMI version {given}; expected 1.0, 2.0 or 3.0; export the model for one"
        )
    return match[1]


def _interfaces(root: Element, version: str, where: str) -> dict[Kind, Interface]:
    if version == "1.0":
        return _fmi1_interface(root, where)
    elements = ((kind, root.first(tag)) for kind, tag in TAGS.items())
    return {kind: _interface(kind, e, version, where) for kind, e in elements if e is not None}


def _interface(kind: Kind, element: Element, version: str, where: str) -> Interface:
    on = {name for name, text in element.attributes.items() if text in TRUE}
    if version == "3.0":
        completed = "needsCompletedIntegratorStep" in on
    else:
        completed = "completedIntegratorStepNotNeeded" not in on
    return Interface(
        kind=kind,
        identifier=_identifier(element, where),
        saves_state=bool(on & {"canGetAndSetFMUstate", "canGetAndSetFMUState"}),
        needs_execution_tool="needsExecutionTool" in on,
        variable_step="canHandleVariableCommunicationStepSize" in on or kind is Kind.MODEL_EXCHANGE,
        fixed_internal_step=_positive(where, element, "fixedInternalStepSize"),
        completed_step_needed=completed,
        flags=_flags(element),
    )


def _fmi1_interface(root: Element, where: str) -> dict[Kind, Interface]:
    """Return the one interface of an FMI 1 file, whose capabilities are a separate element."""
    identifier = _identifier(root, where)
    implementation = root.first("Implementation")
    if implementation is None:
        return {Kind.MODEL_EXCHANGE: Interface(Kind.MODEL_EXCHANGE, identifier)}
    tool = implementation.first("CoSimulation_Tool")
    place = tool or implementation.first("CoSimulation_StandAlone")
    capabilities = place.first("Capabilities") if place else None
    flags = _flags(capabilities) if capabilities else {}
    interface = Interface(
        Kind.CO_SIMULATION,
        identifier,
        needs_execution_tool=tool is not None,
        variable_step=flags.get("canHandleVariableCommunicationStepSize") in TRUE,
        flags=flags,
    )
    return {Kind.CO_SIMULATION: interface}


def _identifier(element: Element, where: str) -> str:
    identifier = element.get("modelIdentifier")
    named = 0 < len(identifier) <= MAX_IDENTIFIER and identifier.isprintable()
    if not named or set(identifier) & set('/\\:"'):
        what = f"modelIdentifier {printable(identifier, 60)!r}; expected a name in C"
        raise broken(where, element, what)
    return identifier


def _flags(element: Element) -> dict[str, str]:
    return {
        name: printable(text, 60)
        for name, text in element.attributes.items()
        if name != "modelIdentifier" and text not in {"false", "0", ""}
    }


def _nothing_to_run(root: Element) -> str:
    wanted = "expected Co-Simulation or Model Exchange; export the model for Co-Simulation"
    if root.first("ScheduledExecution"):
        return f"only Scheduled Execution; {wanted}"
    return f"neither Co-Simulation nor Model Exchange; {wanted}"


def _structure(
    root: Element, version: str, where: str, variables: Mapping[str, Variable]
) -> tuple[int, int]:
    """Return the numbers of continuous states and event indicators; all references must exist."""
    indicators = whole(where, root, "numberOfEventIndicators") or 0
    if version == "1.0":
        return whole(where, root, "numberOfContinuousStates") or 0, indicators
    if version == "2.0":
        count = sum(1 for _ in root.every("ModelVariables", "ScalarVariable"))
        for group in ("Outputs", "Derivatives", "InitialUnknowns"):
            for unknown in root.every("ModelStructure", group, "Unknown"):
                index = whole(where, unknown, "index")
                if index is None or not 1 <= index <= count:
                    raise broken(where, unknown, f"{group}: no variable {index} of {count}")
        return sum(1 for _ in root.every("ModelStructure", "Derivatives", "Unknown")), indicators
    by_reference = {variable.reference: variable for variable in variables.values()}
    sizes = {"ContinuousStateDerivative": 0, "EventIndicator": 0}
    for tag in ("Output", "ContinuousStateDerivative", "InitialUnknown", "EventIndicator"):
        for unknown in root.every("ModelStructure", tag):
            reference = whole(where, unknown, "valueReference")
            variable = by_reference.get(-1 if reference is None else reference)
            if variable is None:
                raise broken(where, unknown, f"{tag}: no variable has reference {reference}")
            if tag in sizes:
                sizes[tag] += variable.size
    return sizes["ContinuousStateDerivative"], sizes["EventIndicator"]


def _units(root: Element, version: str, where: str) -> dict[str, Unit]:
    if version == "1.0":  # names only
        names = [clean(u.get("unit"), MAX_UNIT) for u in root.every("UnitDefinitions", "BaseUnit")]
        return {name: Unit(name) for name in names}
    units = {}
    for element in root.every("UnitDefinitions", "Unit"):
        name, base = clean(element.get("name"), MAX_UNIT), element.first("BaseUnit")
        units[name] = Unit(name) if base is None else _unit(name, base, where)
    return units


def _unit(name: str, base: Element, where: str) -> Unit:
    kg, m, s, a, k, mol, cd, rad = (whole(where, base, symbol) or 0 for symbol in BASE)
    factor = number(where, base, "factor")
    offset = number(where, base, "offset") or 0.0
    if factor is None:
        factor = 1.0
    if not math.isfinite(factor) or factor == 0.0 or not math.isfinite(offset):
        what = f"unit {printable(name, 40)}: factor {factor}, offset {offset}; expected numbers"
        raise broken(where, base, what)
    return Unit(name, factor, offset, (kg, m, s, a, k, mol, cd, rad))


def _positive(where: str, element: Element | None, name: str) -> float | None:
    """Return an attribute that is useful only as a positive number, otherwise None."""
    value = number(where, element, name) if element else None
    return value if value is not None and 0.0 < value < math.inf else None
