"""The variables of a model description, in one form for FMI 1, 2 and 3."""

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from typing import Final, TypeVar

from fmus.archive.markup import Element
from fmus.description.model import INTEGER_TYPES, REAL_TYPES, Clock, Variable
from fmus.errors import FmuFileError
from fmus.text import clean, printable

_Number = TypeVar("_Number", float, int)

OTHER_TYPES: Final = frozenset({"Boolean", "String", "Binary", "Clock"})
TYPES: Final = REAL_TYPES | INTEGER_TYPES | OTHER_TYPES
VARIABLE_TAGS: Final = (
    TYPES
    | {f"{kind}Type" for kind in TYPES}
    | {"ModelVariables", "ScalarVariable", "Dimension", "Alias", "Start"}
    | {"TypeDefinitions", "SimpleType", "Type"}
)  # all elements that describe variables
BOOLEANS: Final = frozenset({"true", "false", "1", "0"})
PARAMETERS: Final = frozenset({"parameter", "calculatedParameter", "structuralParameter"})
FREE: Final = frozenset({"parameter", "structuralParameter", "input"})  # settable before the start
MAX_REFERENCE: Final = (1 << 32) - 1
MAX_SIZE: Final = 10_000_000  # values of an array
LONGEST: Final = 1e9  # [s] interval of a clock
MAX_NAME: Final = 1000  # characters
MAX_UNIT: Final = 60
MAX_DESCRIPTION: Final = 500


def broken(where: str, element: Element, what: str) -> FmuFileError:
    """Return the error for a line of the model description."""
    return FmuFileError(f"{where}, line {element.line}: {what}; export the model again")


def number(where: str, element: Element, name: str) -> float | None:
    """Return an attribute that must be a number, or None without it."""
    return _converted(where, element, name, float, "a number")


def whole(where: str, element: Element, name: str) -> int | None:
    """Return an attribute that must be a whole number, or None without it."""
    return _converted(where, element, name, int, "a whole number")


def _converted(
    where: str, element: Element, name: str, kind: Callable[[str], _Number], expected: str
) -> _Number | None:
    text = element.attributes.get(name)
    if text is None:
        return None
    try:
        return kind(text)
    except ValueError:
        raise _bad(where, element, name, expected) from None


def read_variables(
    root: Element, version: str, where: str, extents: Mapping[str, int]
) -> dict[str, Variable]:
    """Return all variables by name, in the order of the file.

    Args:
        root: Root of the model description.
        version: "1.0", "2.0" or "3.0".
        where: Name of the file in errors.
        extents: Values of structural parameters by name, in place of their start values.

    Raises:
        FmuFileError: a variable is malformed; the message names the line.
    """
    types = _types(root, version)
    by_reference = _extents(root, where, extents) if version == "3.0" else {}
    variables: dict[str, Variable] = {}
    for element, value in _elements(root, version, where):
        variable = _variable(element, value, version, where, types, by_reference)
        for name in (variable.name, *(alias.get("name") for alias in element.every("Alias"))):
            if not name:
                raise broken(where, element, "a variable without a name")
            if clean(name, MAX_NAME) != name:  # the name is shown in messages
                what = f"name {printable(name, 60)} too long or with control characters"
                raise broken(where, element, what)
            if name in variables:  # refused only if something uses it
                again = variables[name].again_on or element.line
                variables[name] = dataclasses.replace(variables[name], again_on=again)
                continue
            variables[name] = (
                variable if name == variable.name else dataclasses.replace(variable, name=name)
            )
    return variables


def _elements(root: Element, version: str, where: str) -> Iterator[tuple[Element, Element]]:
    """Yield each variable's element, and the element of its type (in FMI 1 and 2 a child)."""
    for element in _children(root, "ModelVariables"):
        if version == "3.0":
            if element.tag in TYPES:
                yield element, element
            continue
        if element.tag != "ScalarVariable":
            continue
        value = next((child for child in element.children if child.tag in TYPES), None)
        if value is None:
            raise broken(where, element, f"variable {_name(element)} without a type")
        yield element, value


def _variable(
    element: Element,
    value: Element,
    version: str,
    where: str,
    types: Mapping[str, Element],
    extents: Mapping[int, str],
) -> Variable:
    declared = value.get("declaredType")
    if declared and declared not in types:
        what = f"type {printable(declared, 100)} of variable {_name(element)} is not defined"
        raise broken(where, element, what)
    # a variable's own attributes count first
    layers = (value, types[declared]) if declared else (value,)
    causality, variability = _roles(element, value.tag, version)
    shape = _shape(element, where, extents) if version == "3.0" else ()
    start = _start(value)
    _require_readable(where, element, value.tag, start, bool(shape))
    initial = _initial(element, value, version)
    changeable = causality in FREE or initial in {"exact", "approx"}
    minima, maxima = ([number(where, e, limit) for e in layers] for limit in ("min", "max"))
    return Variable(
        name=element.get("name"),
        reference=_reference(where, element),
        kind=value.tag,
        causality=causality,
        variability=variability,
        start=start,
        shape=shape,
        unit=clean(next((e.get("unit") for e in layers if e.get("unit")), ""), MAX_UNIT),
        description=clean(element.get("description"), MAX_DESCRIPTION),
        minimum=next((limit for limit in minima if limit is not None), None),
        maximum=next((limit for limit in maxima if limit is not None), None),
        clocks=_clocks(element),
        settable=variability != "constant" and changeable,
        negated=version == "1.0" and element.get("alias") == "negatedAlias",
    )


def _roles(element: Element, kind: str, version: str) -> tuple[str, str]:
    """Return causality and variability, with the defaults of the standard (FMI 3: 2.4.7.4)."""
    # the causality is shown in messages
    causality = clean(element.get("causality", "local"), MAX_UNIT)
    variability = clean(element.get("variability"), MAX_UNIT)
    if version == "1.0":
        if variability == "parameter":
            return "parameter", "fixed"
        causality = "local" if causality in {"internal", "none"} else causality
    if variability:
        return causality, variability
    if version != "3.0":
        return causality, "continuous"
    if causality in PARAMETERS:
        return causality, "fixed"
    return causality, "continuous" if kind in REAL_TYPES else "discrete"


def _initial(element: Element, value: Element, version: str) -> str:
    if version != "1.0":
        return element.get("initial")
    if "start" not in value.attributes:
        return ""
    return "approx" if value.get("fixed", "true") in {"false", "0"} else "exact"


def _start(value: Element) -> str:
    if value.tag in {"String", "Binary"} and value.children:  # FMI 3
        return " ".join(start.get("value") for start in value.every("Start"))
    start = value.get("start")
    return start if value.tag == "String" else start.strip()


def _require_readable(where: str, element: Element, kind: str, start: str, array: bool) -> None:
    """Refuse a start value that is not of its variable's type."""
    words = start.split()
    if not words or kind in {"String", "Binary", "Clock"}:
        return
    if len(words) > 1 and not array:
        raise broken(where, element, f"start of {_name(element)}: {len(words)} values, expected 1")
    for word in words:
        try:
            if kind == "Boolean":
                good = word in BOOLEANS
            elif kind in REAL_TYPES:
                good = float(word) is not None
            else:
                good = float(word).is_integer()
        except ValueError:
            good = False
        if not good:
            what = f"start of {_name(element)} = {printable(word, 40)}; expected {_expected(kind)}"
            raise broken(where, element, what)


def _expected(kind: str) -> str:
    if kind == "Boolean":
        return "true or false"
    return "a number" if kind in REAL_TYPES else "a whole number"


def _extents(root: Element, where: str, given: Mapping[str, int]) -> dict[int, str]:
    """Return the values of the variables to which an FMI 3 array's dimensions may refer."""
    found = {}
    for element in _children(root, "ModelVariables"):
        if element.tag in INTEGER_TYPES and element.get("start"):
            value = given.get(element.get("name"), element.get("start"))
            found[_reference(where, element)] = str(value)
    return found


def _shape(element: Element, where: str, extents: Mapping[int, str]) -> tuple[int, ...]:
    shape: list[int] = []
    size = 1
    for dimension in element.every("Dimension"):
        extent = whole(where, dimension, "start")
        if extent is None:
            reference = whole(where, dimension, "valueReference")
            text = extents.get(-1 if reference is None else reference, "")
            if not text.isdecimal():
                what = f"dimension of {_name(element)}: no variable with a start value for it"
                raise broken(where, dimension, what)
            extent = int(text)
        size *= extent
        if extent < 0 or size > MAX_SIZE:
            what = f"dimension of {_name(element)} = {extent}; expected 0 to {MAX_SIZE} values"
            raise broken(where, dimension, what)
        shape.append(extent)
    return tuple(shape)


def _reference(where: str, element: Element) -> int:
    reference = whole(where, element, "valueReference")
    if reference is None or not 0 <= reference <= MAX_REFERENCE:
        raise _bad(where, element, "valueReference", f"0 to {MAX_REFERENCE}")
    return reference


def _clocks(element: Element) -> tuple[int, ...]:
    """Return the references of the clocks with which a variable may change."""
    return tuple(int(word) for word in element.get("clocks").split() if word.isdecimal())


def read_clocks(root: Element, where: str) -> tuple[Clock, ...]:
    """Return the clocks of FMI 3.

    Raises:
        FmuFileError: an interval is malformed; the message names the line.
    """
    elements = _children(root, "ModelVariables")
    needed = {reference for element in elements for reference in _clocks(element)}
    return tuple(
        Clock(
            name=element.get("name"),
            reference=_reference(where, element),
            causality=element.get("causality", "local"),
            variability=clean(element.get("intervalVariability"), MAX_UNIT),
            interval=_seconds(where, element, "interval"),
            shift=_seconds(where, element, "shift") or 0.0,
            needed=_reference(where, element) in needed,
        )
        for element in elements
        if element.tag == "Clock"
    )


def _seconds(where: str, element: Element, name: str) -> float | None:
    """Return an interval or a shift, which is a decimal or a fraction, or None without it."""
    value = number(where, element, f"{name}Decimal")
    if value is None and (counter := number(where, element, f"{name}Counter")) is not None:
        value = counter / (number(where, element, "resolution") or 1.0)
    if value is None or (0.0 <= value <= LONGEST and (value > 0.0 or name == "shift")):
        return value
    raise _bad(where, element, f"{name}Decimal", f"a time above 0, up to {LONGEST:g} s")


def _types(root: Element, version: str) -> dict[str, Element]:
    """Return the type definitions; in FMI 1 and 2 an inner element holds unit and limits."""
    types = {}
    for element in _children(root, "TypeDefinitions"):
        inner = element if version == "3.0" or not element.children else element.children[0]
        types[element.get("name")] = inner
    return types


def _children(root: Element, tag: str) -> list[Element]:
    parent = root.first(tag)
    return parent.children if parent else []


def _name(element: Element) -> str:
    return printable(element.get("name"), 100) or "without a name"


def _bad(where: str, element: Element, name: str, expected: str) -> FmuFileError:
    text = element.attributes.get(name)
    given = "missing" if text is None else f'"{printable(text, 40)}"'
    place = f"{element.tag} {_name(element)}" if element.get("name") else element.tag
    return broken(where, element, f"{name} of {place} {given}; expected {expected}")
