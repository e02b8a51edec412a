"""Systems of several FMUs as SSP 1.0 files."""

from __future__ import annotations

import zipfile
from typing import TYPE_CHECKING

from lxml import etree

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

SSP = "http://ssp-standard.org/SSP1/SystemStructure"
NAMES = {"ssd": f"{SSP}Description", "ssc": f"{SSP}Common", "ssv": f"{SSP}ParameterValues"}


def write_ssp(
    path: Path,
    parts: Mapping[str, Path],
    connections: Sequence[tuple[str, str]],
    connectors: Mapping[str, tuple[str, str]],
    *,
    values: Mapping[str, float] | None = None,
    linear: Mapping[str, tuple[float, float]] | None = None,
    plain: Sequence[str] = (),
) -> Path:
    """Write a system.

    Args:
        path: file to write.
        parts: FMU of each component.
        connections: pairs "part.variable" or the system's own connector, source first.
        connectors: kind and unit of each connector, by the same names.
        values: parameters of the system, like "chassis.mass".
        linear: factor and offset of the connection to a connector.
        plain: connectors to which units are not converted.
    """
    root = element(None, "ssd:SystemStructureDescription", version="1.0", name=path.stem)
    system = element(root, "ssd:System", name="vehicle")
    own = element(system, "ssd:Connectors")
    if values:
        bindings = element(system, "ssd:ParameterBindings")
        held = element(element(bindings, "ssd:ParameterBinding"), "ssd:ParameterValues")
        parameters = element(
            element(held, "ssv:ParameterSet", version="1.0", name="values"), "ssv:Parameters"
        )
        for name, value in values.items():
            element(element(parameters, "ssv:Parameter", name=name), "ssv:Real", value=repr(value))
    elements = element(system, "ssd:Elements")
    lists = {}
    for name in parts:
        component = element(
            elements,
            "ssd:Component",
            name=name,
            type="application/x-fmu-sharedlibrary",
            source=f"resources/{name}.fmu",
        )
        lists[name] = element(component, "ssd:Connectors")
    for place, (kind, unit) in connectors.items():
        part, _, name = place.rpartition(".")
        connector = element(lists.get(part, own), "ssd:Connector", name=name, kind=kind)
        element(connector, "ssc:Real", **({"unit": unit} if unit else {}))
    joined = element(system, "ssd:Connections")
    for source, target in connections:
        ends = {}
        for end, place in (("start", source), ("end", target)):
            part, _, name = place.rpartition(".")
            ends |= {f"{end}Element": part} if part else {}
            ends[f"{end}Connector"] = name
        ends |= {"suppressUnitConversion": "true"} if target in plain else {}
        connection = element(joined, "ssd:Connection", **ends)
        if target in (linear or {}):
            factor, offset = linear[target]
            element(
                connection, "ssc:LinearTransformation", factor=repr(factor), offset=repr(offset)
            )
    with zipfile.ZipFile(path, "w") as archive:
        text = etree.tostring(root, xml_declaration=True, encoding="UTF-8")
        archive.writestr("SystemStructure.ssd", text)
        for name, fmu in parts.items():
            archive.write(fmu, f"resources/{name}.fmu")
    return path


def element(parent, tag: str, **attributes: str):
    prefix, _, name = tag.partition(":")
    full = f"{{{NAMES[prefix]}}}{name}"
    if parent is None:
        return etree.Element(full, attributes, nsmap=NAMES)
    return etree.SubElement(parent, full, attributes)
