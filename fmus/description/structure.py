"""The system structure of SSP 1.0: components, connectors and connections of nested systems."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final
from urllib.parse import unquote

from fmus.archive.archive_check import Archive
from fmus.archive.kinds import SYSTEM, SYSTEM_ROOT
from fmus.archive.markup import Element, parse
from fmus.description.model import Unit
from fmus.description.variables import MAX_NAME, broken, number, whole
from fmus.errors import FmuInterfaceError
from fmus.text import clean, printable

FMU: Final = "application/x-fmu-sharedlibrary"
TYPES: Final = ("Real", "Integer", "Boolean", "String", "Enumeration")
KEPT: Final = frozenset(
    {"System", "Elements", "Component", "Connectors", "Connector", "Connections", "Connection"}
    | {"LinearTransformation", "Units", "Unit", "BaseUnit", *TYPES}
    | {"ParameterBindings", "ParameterBinding", "ParameterValues", "ParameterSet", "Parameters"}
    | {"Parameter", "ParameterMapping", "MappingEntry"}
)
BASE: Final = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


@dataclass(frozen=True)
class Edge:
    """A connection as the file gives it; places are ``part.connector``, or a system's own."""

    source: str
    target: str
    factor: float = 1.0
    offset: float = 0.0
    converts: bool = True  # whether units are converted


@dataclass
class Structure:
    """The contents of a system's description.

    Attributes:
        sources: Member of each component's FMU, by the component's name.
        kinds: Kind of each connector ("input", "output", "parameter", ...), by its place.
        unit_names: Unit of each connector that gives one.
        edges: Connection to each place.
        bindings: Parameter bindings with the prefix of their element, from the inside out.
        units: Units that the file defines.
    """

    sources: dict[str, str] = field(default_factory=dict)
    kinds: dict[str, str] = field(default_factory=dict)
    unit_names: dict[str, str] = field(default_factory=dict)
    edges: dict[str, Edge] = field(default_factory=dict)
    bindings: list[tuple[str, Element]] = field(default_factory=list)
    units: dict[str, Unit] = field(default_factory=dict)


def read_structure(archive: Archive) -> Structure:
    """Return the structure of a system.

    Raises:
        FmuFileError: the description is broken.
        FmuInterfaceError: a component is no FMU in the archive.
    """
    where = f"{archive.path}: {SYSTEM}"
    root = parse(archive.description, where, SYSTEM_ROOT, KEPT, namespaces=True)
    top = root.first("System")
    if top is None:
        raise broken(where, root, "no System")
    found = Structure(units=units_of(root, where))
    _Walk(archive, where, found).system(top, "")
    if not found.sources:
        raise broken(where, top, "a system without components")
    return found


def units_of(root: Element, where: str) -> dict[str, Unit]:
    """Return the units that a file of SSP defines."""
    units = {}
    for element in root.every("Units", "Unit"):
        base, name = element.first("BaseUnit"), clean(element.get("name"), MAX_NAME)
        if base is not None:
            kg, m, s, a, k, mol, cd, rad = (whole(where, base, symbol) or 0 for symbol in BASE)
            factor, offset = number(where, base, "factor"), number(where, base, "offset") or 0.0
            factor = 1.0 if factor is None else factor
            units[name] = Unit(name, factor, offset, (kg, m, s, a, k, mol, cd, rad))
    return units


def bindings_of(element: Element) -> Iterator[Element]:
    """Yield the parameter bindings of a system or a component."""
    yield from element.every("ParameterBindings", "ParameterBinding")


class _Walk:
    """One pass through nested systems.

    Args:
        archive: Archive of the system.
        where: Place of its description, for messages.
        found: Structure that is filled.
    """

    def __init__(self, archive: Archive, where: str, found: Structure) -> None:
        self._archive, self._where, self._found = archive, where, found

    def system(self, system: Element, prefix: str) -> None:
        """Take over a system whose elements' names get a prefix."""
        for element in system.every("Elements", "Component"):
            self._component(element, prefix)
        for element in system.every("Elements", "System"):
            self.system(element, f"{prefix}{self._name(element)}.")
        self._connectors(system, prefix)
        for element in system.every("Connections", "Connection"):
            edge = self._edge(element, prefix)
            if self._found.edges.setdefault(edge.target, edge) is not edge:
                raise broken(self._where, element, f"a second connection to {edge.target}")
        self._found.bindings += [(prefix, binding) for binding in bindings_of(system)]

    def _component(self, element: Element, prefix: str) -> None:
        name = f"{prefix}{self._name(element)}"
        source = unquote(element.get("source")).removeprefix("./")
        if element.get("type", FMU) != FMU or source not in self._archive.members:
            what = f"source {printable(source, 80)!r} of type {element.get('type', FMU)}"
            raise FmuInterfaceError(
                f"{self._where}, line {element.line}: component '{name}' has the {what}; expected "
                "an FMU in the archive, like resources/engine.fmu"
            )
        if name in self._found.sources:
            raise broken(self._where, element, f"a second component '{name}'")
        self._found.sources[name] = source
        self._connectors(element, f"{name}.")
        self._found.bindings += [(f"{name}.", binding) for binding in bindings_of(element)]

    def _connectors(self, element: Element, prefix: str) -> None:
        for connector in element.every("Connectors", "Connector"):
            place = f"{prefix}{self._name(connector)}"
            self._found.kinds[place] = connector.get("kind")
            unit = next((kind.get("unit") for kind in connector.every("Real")), "")
            if unit:
                self._found.unit_names[place] = clean(unit, MAX_NAME)

    def _edge(self, element: Element, prefix: str) -> Edge:
        ends = []
        for end in ("start", "end"):
            owner, connector = element.get(f"{end}Element"), element.get(f"{end}Connector")
            ends.append(f"{prefix}{owner}.{connector}" if owner else f"{prefix}{connector}")
        linear = element.first("LinearTransformation")
        factor = None if linear is None else number(self._where, linear, "factor")
        offset = None if linear is None else number(self._where, linear, "offset")
        return Edge(
            ends[0],
            ends[1],
            1.0 if factor is None else factor,
            offset or 0.0,
            element.get("suppressUnitConversion") not in {"true", "1"},
        )

    def _name(self, element: Element) -> str:
        name = clean(element.get("name"), MAX_NAME)
        if not name:
            raise broken(self._where, element, f"a {element.tag} without a name")
        return name


def chain(edges: Mapping[str, Edge], target: str, ends: Container[str]) -> list[Edge]:
    """Return the connections that lead to a place, from their first source on.

    They go through the connectors of systems and end at a component's, one of ``ends``.
    """
    way: list[Edge] = []
    while target in edges and len(way) <= len(edges):
        way.insert(0, edges[target])
        target = edges[target].source
        if target in ends:
            break
    return way
