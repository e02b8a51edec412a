"""Start values of an FMU, and the buffers that carry its inputs and outputs in every step."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from ctypes import c_bool, c_char_p, c_double, c_float, sizeof
from math import isfinite
from typing import Any

from fmus.description.model import Channel, Value, Variable
from fmus.errors import FmuStartError, FmuVariableError
from fmus.fmi.calls import Calls, CType, Setting
from fmus.text import printable

# ---- start values ----


def settings(calls: Calls, values: Mapping[Channel, Value]) -> list[Setting]:
    """Return start values for C; the elements of an array become one setting.

    Raises:
        FmuStartError: a value does not fit its variable.
    """
    wholes: dict[str, list[Any]] = {}
    variables: dict[str, Variable] = {}
    single = (
        (part, value if factor == 1.0 or not isinstance(value, int | float) else value * factor)
        for channel, value in values.items()
        for part, factor in channel.parts
    )
    for channel, value in single:
        variable = variables.setdefault(channel.variable.name, channel.variable)
        if isinstance(value, list):
            if len(value) != variable.size:
                raise _unfit(calls, variable, value, f"{variable.size} values")
            wholes[variable.name] = list(value)
        else:
            if variable.name not in wholes:
                wholes[variable.name] = start_list(variable)
            wholes[variable.name][channel.element] = value
    return [_setting(calls, variables[name], whole) for name, whole in wholes.items()]


def start_list(variable: Variable) -> list[Any]:
    """Return the description's start values, or 0 (or an empty text) without one."""
    text = variable.kind == "String"
    words = [variable.start] if text or variable.scalar else variable.start.split()
    words = [word for word in words if word] or [""]
    # One value counts for all elements, and for those that a structural parameter has added.
    words = (words + words[:1] * variable.size)[: variable.size]
    return words if text else [_number(word) for word in words]


def _number(word: str) -> float:
    if word in {"true", "false"}:
        return float(word == "true")
    try:
        return float(word)
    except ValueError:
        return 0.0


def _setting(calls: Calls, variable: Variable, whole: Sequence[Any]) -> Setting:
    ctype = calls.types.get(variable.kind)
    if ctype is None:
        expected = f"another variable: a {printable(variable.kind)} cannot be set"
        raise _unfit(calls, variable, whole, expected)
    try:
        ready = [_ready(variable, ctype, value) for value in whole]
    except ValueError as error:
        raise _unfit(calls, variable, whole, str(error)) from None
    if variable.negated and ctype.type is not c_char_p:
        ready = [_negated(variable, value) for value in ready]
    array = (ctype.type * len(ready))(*ready)
    return Setting(variable.name, variable.reference, ctype, array)


def _ready(variable: Variable, ctype: CType, value: Any) -> Any:
    """Convert a value for a ctypes array; a ValueError says what was expected."""
    if ctype.type is c_char_p:
        if not isinstance(value, str) or "\0" in value:
            raise ValueError("a text")
        return value.encode()
    number = value if isinstance(value, int | float) else None
    if number is None or (variable.is_real and isinstance(value, bool)) or not isfinite(number):
        raise ValueError("true or false" if variable.is_boolean else "a finite number")
    if variable.is_boolean:
        if number not in (0, 1):
            raise ValueError("true or false")
        return int(number)
    if variable.is_real:
        return float(number)
    low, high = bounds(ctype)
    if number != int(number) or not low <= number <= high:
        raise ValueError(f"a whole number from {low} to {high}")
    return int(number)


def _unfit(calls: Calls, variable: Variable, value: Any, expected: str) -> FmuStartError:
    shown = value[0] if isinstance(value, list) and len(value) == 1 else value
    return FmuStartError(
        f"{calls.model.path}: start value {printable(variable.name)} = {printable(repr(shown))}: "
        f"expected {expected}; change it under [parameters]"
    )


def _negated(variable: Variable, value: Any) -> Any:
    """Return the value of a negated alias: not, or minus, the value of the other variable."""
    return 1 - value if variable.is_boolean else -value


def bounds(ctype: CType) -> tuple[int, int]:
    """Return the smallest and the largest whole number of a C type."""
    bits = 8 * sizeof(ctype.type)
    unsigned = ctype.type(-1).value > 0
    return (0, (1 << bits) - 1) if unsigned else (-(1 << bits - 1), (1 << bits - 1) - 1)


# ---- channels ----


class Transfer:
    """Carries one side's channels between a buffer of doubles and the FMU.

    If every channel is a scalar double, the FMU reads or writes the buffer itself, and ``function``
    is the C function. Otherwise values are copied, and whole arrays are set or read.

    Attributes:
        view: One double per channel.
        function, arguments: Call of every step, which returns a status.
    """

    def __init__(self, calls: Calls, verb: str, channels: Sequence[Channel]) -> None:
        buffer = (c_double * len(channels))()
        self.view = memoryview(buffer).cast("B").cast("d")
        self.function: Callable[..., int] = _nothing
        self.arguments: tuple[Any, ...] = ()
        types = [_type(calls, channel) for channel in channels]
        kinds = [(t, frozenset(c.variable.clocks)) for t, c in zip(types, channels, strict=True)]
        for index, channel in enumerate(channels):
            self.view[index] = float(start_list(channel.variable)[channel.element])
        if not channels:
            return
        plain = all(
            c.parts[0][0] is c and c.variable.scalar and not c.variable.negated for c in channels
        ) and not any(clocks for _, clocks in kinds)
        if plain and len(set(types)) == 1 and types[0].type is c_double:
            self.function = calls.function(calls.name(verb, types[0].suffix))
            references = [channel.variable.reference for channel in channels]
            self.arguments = calls.arguments(references, buffer)
            return
        self._groups = [
            _Group(
                calls, verb, kind[0], [(i, c) for i, c in enumerate(channels) if kinds[i] == kind]
            )
            for kind in dict.fromkeys(kinds)
        ]
        self._calls = calls
        self._setting = verb == "Set"
        self.function = self._copy

    def _copy(self) -> int:
        """Set or get all groups, and return the worst status."""
        worst, active = 0, self._calls.active
        for group in self._groups:
            if self._setting:
                if active is not None and group.clocks and not group.clocks & active:
                    continue  # it may change only as its clock ticks
                group.fill(self.view)
            status = group.function(*group.arguments)
            if status not in (0, 1):
                return status
            if not self._setting:
                group.empty(self.view)
            worst = max(worst, status)
        return worst


class _Group:
    """The variables of one C type, with all their elements, in a buffer of their own."""

    def __init__(
        self, calls: Calls, verb: str, ctype: CType, channels: Sequence[tuple[int, Channel]]
    ) -> None:
        parts = [part for _, channel in channels for part, _factor in channel.parts]
        variables = list(dict.fromkeys(part.variable for part in parts))
        first: dict[str, int] = {}
        elements: list[Any] = []
        for variable in variables:
            first[variable.name] = len(elements)
            start = start_list(variable)
            elements += [_negated(variable, v) for v in start] if variable.negated else start
        convert = _converter(ctype)
        self._values: Any = (ctype.type * len(elements))(*map(convert, elements))
        self._places = [
            (
                i,
                first[c.variable.name] + c.element,
                c.variable if c.variable.negated else None,
                factor,
            )
            for i, channel in channels
            for c, factor in channel.parts
        ]
        self._joint = [i for i, channel in channels if channel.parts[0][0] is not channel]
        self._convert = convert
        self.clocks = frozenset(variables[0].clocks)
        references = [variable.reference for variable in variables]
        self.function = calls.function(calls.name(verb, ctype.suffix))
        self.arguments = calls.arguments(references, self._values)
        if verb == "Set" and any(len(v.start.split()) not in (0, 1, v.size) for v in variables):
            # A structural parameter has changed an array's size; its own values are the FMU's.
            calls.function(calls.name("Get", ctype.suffix))(*self.arguments)

    def fill(self, view: memoryview[float]) -> None:
        values, convert = self._values, self._convert
        for index, place, negated, factor in self._places:
            value = view[index] * factor
            values[place] = convert(_negated(negated, value) if negated else value)

    def empty(self, view: memoryview[float]) -> None:
        values = self._values
        for index in self._joint:
            view[index] = 0.0
        for index, place, negated, factor in self._places:
            value = values[place]
            value = _negated(negated, value) if negated else value
            view[index] = view[index] + factor * value if index in self._joint else value


def _converter(ctype: CType) -> Callable[[float], Any]:
    """Return a function from a double to a value of the C type."""
    if ctype.type in {c_double, c_float}:
        return float
    if ctype.type is c_bool or ctype.suffix == "Boolean":
        return lambda value: int(value >= 0.5)
    low, high = bounds(ctype)
    return lambda value: min(max(round(value), low), high)


def _type(calls: Calls, channel: Channel) -> CType:
    ctype = calls.types.get(channel.variable.kind)
    if ctype is None or ctype.type is c_char_p:
        raise FmuVariableError(
            f"{calls.model.path}: {printable(channel.name)} is a {printable(channel.variable.kind)}"
            "; expected a number or a boolean; name another variable in the profile"
        )
    return ctype


def _nothing() -> int:
    return 0
