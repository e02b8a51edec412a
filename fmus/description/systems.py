"""The model of a vehicle that is made of several FMUs (SSP 1.0): one model with all variables.

A variable of a part is called ``part.variable``; a connector of the system keeps its own name.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from fmus.archive.archive_check import Archive, extract, open_archive
from fmus.description import units as si
from fmus.description.channels import find_channel
from fmus.description.feedthrough import Dependencies, algebraic_loop, feedthrough
from fmus.description.model import Interface, Kind, Link, Model, System, Unit, Value, Variable
from fmus.description.parameter_sets import parameter_values
from fmus.description.structure import Edge, Structure, chain, read_structure
from fmus.errors import FmuError, FmuInterfaceError, FmuVariableError
from fmus.text import listed

_NOTHING = Interface(Kind.CO_SIMULATION, "")


def compose(archive: Archive, read_model: Callable[[Path], Model]) -> Model:
    """Return the model of a system in an archive.

    Args:
        archive: Archive of the system.
        read_model: Function that reads the model of one FMU.

    Raises:
        FmuFileError: a file in the archive is broken or missing.
        FmuInterfaceError: a component cannot be run, or there is an algebraic loop.
        FmuVariableError: a connection leads from or to a variable that does not exist.
    """
    structure, parts, told = read_structure(archive), {}, {}
    with _unpacked(archive, structure.sources.values()) as folder:
        for name, source in structure.sources.items():
            try:
                found = read_model(Path(folder, *source.split("/")))
                told[name] = feedthrough(found)
            except FmuError as error:
                reason = str(error).partition(": ")[2]
                raise type(error)(f"{archive.path}: part '{name}': {reason}") from None
            parts[name] = replace(found, path=archive.path / source)
    joined = _Joined(archive.path, structure, parts)
    system = System(
        parts, joined.links(), joined.inputs(), joined.outputs(), joined.values(archive)
    )
    return _model(archive.path, joined, _without_loop(archive.path, system, told))


@contextmanager
def unpacked_parts(model: Model) -> Iterator[dict[str, Model]]:
    """Yield the parts of a system, by name, while their FMUs are unpacked in a temporary folder."""
    assert model.system is not None  # it has parts
    archive, parts = open_archive(model.path), model.system.parts
    sources = {name: part.path.relative_to(model.path) for name, part in parts.items()}
    with _unpacked(archive, [source.as_posix() for source in sources.values()]) as folder:
        yield {name: replace(part, path=folder / sources[name]) for name, part in parts.items()}


@contextmanager
def _unpacked(archive: Archive, members: Iterable[str]) -> Iterator[Path]:
    with tempfile.TemporaryDirectory(prefix="vehicle-ssp-", ignore_cleanup_errors=True) as folder:
        extract(archive, Path(folder), frozenset(members).__contains__)
        yield Path(folder)


def _without_loop(path: Path, system: System, told: Mapping[str, Dependencies]) -> System:
    loop = algebraic_loop(system, told, assumed=False)
    if loop:
        raise FmuInterfaceError(
            f"{path}: an algebraic loop: {' -> '.join(loop)}; leave out one of its connections, or "
            "put a part with a state (a lag) between them"
        )
    loop = algebraic_loop(system, told, assumed=True)
    if not loop:
        return system
    doubt = f"perhaps an algebraic loop (an FMU does not tell its dependencies): {listed(loop, 8)}"
    return replace(system, doubts=(doubt,))


def _model(path: Path, joined: _Joined, system: System) -> Model:
    first = next(iter(system.parts.values()))
    platforms = set(first.platforms).intersection(*(m.platforms for m in system.parts.values()))
    return Model(
        path=path,
        fmi_version="SSP 1.0",
        name=path.stem,
        guid="",
        generation_tool=f"{len(system.parts)} FMUs",
        description=", ".join(f"{name} ({part.name})" for name, part in system.parts.items()),
        interfaces={Kind.CO_SIMULATION: _NOTHING},
        variables=joined.variables(system),
        units=joined.units,
        platforms=tuple(sorted(platforms)),
        states=sum(model.states for model in system.parts.values()),
        event_indicators=sum(model.event_indicators for model in system.parts.values()),
        default_step=None,
        default_tolerance=None,
        system=system,
    )


class _Joined:
    """The structure of a system together with the models of its parts.

    Args:
        path: Path of the system.
        structure: Structure of the system.
        parts: Model of each part.

    Attributes:
        units: Units of all parts and of the system, by name.
    """

    def __init__(self, path: Path, structure: Structure, parts: Mapping[str, Model]) -> None:
        self._path, self._structure, self._parts = path, structure, parts
        self.units = dict(structure.units)
        for model in parts.values():
            self.units = dict(model.units) | self.units
        edges = structure.edges.values()
        self._ends = dict.fromkeys(
            place
            for place in (*structure.kinds, *(e.source for e in edges), *structure.edges)
            if any(place.startswith(f"{part}.") for part in parts)
        )

    def variables(self, system: System) -> dict[str, Variable]:
        """Return the variables of all parts, and the system's own connectors."""
        driven = {link.target for link in self._all(self._ends)}
        found: dict[str, Variable] = {}
        for part, model in self._parts.items():
            for variable in model.variables.values():
                name = f"{part}.{variable.name}"
                causality = "local" if name in driven else variable.causality
                sized = variable.causality == "structuralParameter"  # its arrays have a fixed size
                free = variable.settable and name not in driven and not sized
                found[name] = replace(
                    variable, name=name, causality=causality, settable=free, unit=variable.unit
                )
        for name, links in system.inputs.items():
            found[name] = self._connector(name, links[0].target)
            if (links[0].gain, links[0].shift, len(links)) == (1.0, 0.0, 1):
                like = self._variable(links[0].target, "connector")
                found[name] = replace(
                    found[name], minimum=like.minimum, maximum=like.maximum, start=like.start
                )
        for name, link in system.outputs.items():
            found[name] = self._connector(name, link.source)
        for name, value in system.values.items():
            found[name] = replace(found[name], start=str(value))
        return found

    def links(self) -> tuple[Link, ...]:
        """Return the connections between parts."""
        return tuple(link for link in self._all(self._ends) if link.source in self._ends)

    def inputs(self) -> dict[str, tuple[Link, ...]]:
        """Return the links of each input and parameter of the system."""
        found: dict[str, tuple[Link, ...]] = {}
        for link in self._all(self._ends):
            if link.source not in self._ends:
                found[link.source] = (*found.get(link.source, ()), link)
        return found

    def outputs(self) -> dict[str, Link]:
        """Return the link of each output of the system."""
        own = [place for place in self._structure.kinds if place not in self._ends]
        return {link.target: link for link in self._all(own) if link.source in self._ends}

    def values(self, archive: Archive) -> dict[str, Value]:
        """Return the start values that the system's file gives, the outer ones last."""
        found: dict[str, Value] = {}
        for prefix, binding in self._structure.bindings:
            for name, value, unit, units in parameter_values(archive, binding):
                place = f"{prefix}{name}"
                if place not in self._structure.kinds:
                    self._variable(place, "parameter")
                    self._ends[place] = None
                there = self._unit(place)
                if unit and there and isinstance(value, float):
                    value = self._converted(value, (place, unit), (place, there), units)
                found[place] = value
        return found

    # ---- connections ----

    def _all(self, targets: Iterable[str]) -> Iterator[Link]:
        for target in targets:
            way = chain(self._structure.edges, target, self._ends)
            if way:
                yield self._link(target, way)

    def _link(self, target: str, way: list[Edge]) -> Link:
        """Return the link along connections, with unit conversions and linear transformations."""
        unit, gain, shift = self._unit(way[0].source), 1.0, 0.0
        for edge in way:
            there = self._unit(edge.target)
            if unit and there and edge.converts:
                zero = self._converted(0.0, (edge.source, unit), (edge.target, there), {})
                one = self._converted(1.0, (edge.source, unit), (edge.target, there), {})
                gain, shift = (one - zero) * gain, (one - zero) * shift + zero
            unit = there or unit
            gain, shift = edge.factor * gain, edge.factor * shift + edge.offset
        for place in (way[0].source, target):
            if place in self._ends or place not in self._structure.kinds:
                self._variable(place, "connector")
        return Link(way[0].source, target, gain, shift)

    def _unit(self, place: str) -> str:
        """Return the unit of a place: that of the FMU's variable if it has one."""
        declared = self._variable(place, "connector").unit if place in self._ends else ""
        return declared or self._structure.unit_names.get(place, "")

    def _converted(
        self, value: float, begin: tuple[str, str], end: tuple[str, str], more: Mapping[str, Unit]
    ) -> float:
        """Return a value of one place and unit in the unit of another.

        Raises:
            FmuVariableError: the units are of different kinds.
        """
        if begin[1] == end[1]:
            return value
        known = self.units | dict(more)
        one, other = (si.to_si(known.get(name) or Unit(name)) for _, name in (begin, end))
        if one.dimension is None or other.dimension is None or one.dimension != other.dimension:
            raise FmuVariableError(
                f"{self._path}: {begin[0]} is in '{begin[1]}', but {end[0]} in '{end[1]}'; "
                "expected units of the same kind, or suppressUnitConversion with a "
                "LinearTransformation"
            )
        return (one.factor * value + one.offset - other.offset) / other.factor

    def _variable(self, place: str, what: str) -> Variable:
        """Return the variable of a part.

        Raises:
            FmuVariableError: there is no such part or variable.
        """
        system = System(self._parts, (), {}, {}, {})
        found = system.part_of(place)
        if found is None:
            known = listed(list(self._parts))
            raise FmuVariableError(f"{self._path}: {what} '{place}': no such part; it has {known}")
        part, name = found
        try:
            return find_channel(self._parts[part], what, name).variable
        except FmuVariableError as error:
            reason = str(error).partition(": ")[2]
            raise FmuVariableError(f"{self._path}: part '{part}': {reason}") from None

    def _connector(self, name: str, place: str) -> Variable:
        """Return the variable of a connector of the system, which stands for one of a part."""
        kind = self._structure.kinds.get(name, "")
        kind = kind if kind in {"parameter", "output"} else "input"
        like = self._variable(place, "connector")
        unit = self._structure.unit_names.get(name, like.unit)
        settable = kind != "output" and like.settable
        return replace(
            like, name=name, causality=kind, unit=unit, settable=settable, shape=(), start="",
            minimum=None, maximum=None, description=f"of {place}",
        )  # fmt: skip
