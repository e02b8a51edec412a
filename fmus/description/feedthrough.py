"""Algebraic loops: cycles of connections and of outputs that depend on inputs at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

from fmus.archive.archive_check import open_archive
from fmus.archive.kinds import DESCRIPTION, ROOT
from fmus.archive.markup import parse
from fmus.description.model import Model, System

KEPT: Final = frozenset(
    {"ModelVariables", "ScalarVariable", "ModelStructure", "Outputs", "Unknown", "Output"}
)


Dependencies = Mapping[str, frozenset[str]]
"""Names on which each output of an FMU depends."""


def feedthrough(model: Model) -> Dependencies:
    """Return the names on which each output depends, as far as the FMU tells it.

    An output is missing if the FMU does not tell its dependencies.
    """
    where = f"{model.path}: {DESCRIPTION}"
    root = parse(open_archive(model.path).description, where, ROOT, KEPT)
    if model.fmi_version == "3.0":
        names = {str(v.reference): v.name for v in model.variables.values()}
        unknowns, key = root.every("ModelStructure", "Output"), "valueReference"
    else:
        listed = root.every("ModelVariables", "ScalarVariable")
        names = {str(index): v.get("name") for index, v in enumerate(listed, start=1)}
        unknowns, key = root.every("ModelStructure", "Outputs", "Unknown"), "index"
    return {
        names[unknown.get(key)]: frozenset(
            names[one] for one in unknown.attributes["dependencies"].split() if one in names
        )
        for unknown in unknowns
        if "dependencies" in unknown.attributes and unknown.get(key) in names
    }


def algebraic_loop(system: System, told: Mapping[str, Dependencies], *, assumed: bool) -> list[str]:
    """Return the variables of an algebraic loop in their order, or an empty list.

    Args:
        system: System of several FMUs.
        told: Dependencies of each part.
        assumed: True if an output whose FMU tells no dependencies depends on all its inputs.
    """
    after: dict[str, set[str]] = {}
    for link in system.links:
        after.setdefault(link.source, set()).add(link.target)
    targets = [link.target for link in system.links]
    for source in {link.source for link in system.links}:
        part, output = _split(system, source)
        known = told[part].get(output)
        for target in targets:
            owner, name = _split(system, target)
            if owner == part and (assumed if known is None else name in known):
                after.setdefault(target, set()).add(source)
    return _cycle(after, [link.source for link in system.links])


def _split(system: System, name: str) -> tuple[str, str]:
    place = system.part_of(name)
    assert place is not None  # links lead from parts to parts
    return place


def _cycle(after: Mapping[str, Iterable[str]], begins: Iterable[str]) -> list[str]:
    done: set[str] = set()
    for begin in begins:
        way: list[str] = []
        stack = [(begin, iter(sorted(after.get(begin, ()))))] if begin not in done else []
        way = [begin] if stack else []
        while stack:
            node, rest = stack[-1]
            step = next(rest, None)
            if step is None:
                stack.pop()
                way.pop()
                done.add(node)
            elif step in way:
                return [*way[way.index(step) :], step]
            elif step not in done:
                stack.append((step, iter(sorted(after.get(step, ())))))
                way.append(step)
    return []
