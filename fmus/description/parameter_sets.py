"""The parameter values of SSP 1.0 (``.ssv``), and their mapping to other names (``.ssm``)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from fmus.archive.archive_check import MAX_DESCRIPTION, Archive, read_start
from fmus.archive.kinds import SYSTEM
from fmus.archive.markup import Element, parse
from fmus.description.model import Unit, Value
from fmus.description.structure import KEPT, units_of
from fmus.description.variables import broken, number, whole
from fmus.errors import FmuFileError
from fmus.text import printable

TRUE: Final = frozenset({"true", "1"})


def parameter_values(
    archive: Archive, binding: Element
) -> Iterator[tuple[str, Value, str, dict[str, Unit]]]:
    """Yield name, value, unit (or "") and defined units of a binding's parameters.

    A mapping renames parameters and leaves out those that it does not name.

    Raises:
        FmuFileError: a file is missing, or broken.
    """
    sets: list[tuple[str, Element, dict[str, Unit]]] = []
    if binding.get("source"):
        where, root = _read(archive, binding.get("source"), "ParameterSet")
        sets.append((where, root, units_of(root, where)))
    where = f"{archive.path}: {SYSTEM}"
    sets += [
        (where, e, units_of(e, where)) for e in binding.every("ParameterValues", "ParameterSet")
    ]
    mapping = _mapping(archive, binding)
    for where, root, units in sets:
        for parameter in root.every("Parameters", "Parameter"):
            value, unit = _value(where, parameter)
            name = parameter.get("name")
            if mapping is None:
                yield f"{binding.get('prefix')}{name}", value, unit, units
            for target, factor, offset in (mapping or {}).get(name, ()):
                if (factor, offset) != (1.0, 0.0) and isinstance(value, float):
                    value = factor * value + offset
                yield f"{binding.get('prefix')}{target}", value, unit, units


def _read(archive: Archive, member: str, root: str) -> tuple[str, Element]:
    where = f"{archive.path}: {printable(member, 80)}"
    if member not in archive.members:
        raise FmuFileError(f"{where}: no such file in the archive; export the system again")
    data = read_start(archive, member, MAX_DESCRIPTION)
    return where, parse(data, where, root, KEPT, namespaces=True)


def _mapping(
    archive: Archive, binding: Element
) -> dict[str, list[tuple[str, float, float]]] | None:
    """Return targets, factors and offsets by the source's name; None without a mapping."""
    found = binding.first("ParameterMapping")
    if found is None:
        return None
    where = f"{archive.path}: {SYSTEM}"
    if found.get("source"):
        where, found = _read(archive, found.get("source"), "ParameterMapping")
    else:
        found = found.first("ParameterMapping") or found
    targets: dict[str, list[tuple[str, float, float]]] = {}
    for entry in found.every("MappingEntry"):
        linear = entry.first("LinearTransformation")
        factor = None if linear is None else number(where, linear, "factor")
        offset = None if linear is None else number(where, linear, "offset")
        target = entry.get("target"), 1.0 if factor is None else factor, offset or 0.0
        targets.setdefault(entry.get("source"), []).append(target)
    return targets


def _value(where: str, parameter: Element) -> tuple[Value, str]:
    element = next(iter(parameter.children), None)
    if element is None or "value" not in element.attributes:
        raise broken(where, parameter, f"parameter '{parameter.get('name')}' has no value")
    if element.tag == "Real":
        return number(where, element, "value") or 0.0, element.get("unit")
    if element.tag == "Integer":
        return whole(where, element, "value") or 0, ""
    if element.tag == "Boolean":
        return element.get("value") in TRUE, ""
    return element.get("value"), ""
