"""The variables of an FMU that a profile names, and the start values for them."""

import re
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from sys import float_info

from fmus.description.model import Channel, Model, Value, Variable
from fmus.errors import FmuVariableError
from fmus.text import listed

_ELEMENT = re.compile(r"(?P<name>.*)\[(?P<number>[0-9]{1,9})\]")


def find_channel(model: Model, place: str, name: str) -> Channel:
    """Return the variable, or the element of an array, that is called ``name``.

    Args:
        model: Model of the FMU.
        place: Place of the name in the profile, for errors.
        name: Name as ``x``, or ``x[2]`` for an array's second element.

    Raises:
        FmuVariableError: there is no such variable, or it is a whole array.
    """
    here, variables = f"{model.path}: {place}", model.variables
    if name in variables:
        variable = _single(here, variables[name])
        if variable.size == 1:
            return Channel(variable)
        if variable.size == 0:
            raise FmuVariableError(
                f"{here} variable '{name}' is an array without elements; name another variable"
            )
        raise FmuVariableError(
            f"{here} variable '{name}' is an array of {variable.size}; name one element, "
            f"'{name}[1]' to '{name}[{variable.size}]', or all: variables = [\"{name}\"]"
        )
    element = _ELEMENT.fullmatch(name)
    if element is not None and element["name"] in variables:
        array = _single(here, variables[element["name"]])
        return _element(here, name, array, int(element["number"]))
    close = get_close_matches(name, variables, n=1)
    hint = f"did you mean '{close[0]}'?" if close else f"it has {known_names(variables)}"
    raise FmuVariableError(f"{here} no variable '{name}' in the FMU; {hint}")


def find_channels(model: Model, place: str, name: str) -> list[Channel]:
    """Return the variable or element that is called ``name``, or all elements of an array.

    Raises:
        FmuVariableError: there is no such variable.
    """
    array = model.variables.get(name)
    if array is None or array.size < 2:
        return [find_channel(model, place, name)]
    _single(f"{model.path}: {place}", array)
    return [Channel(array, element) for element in range(array.size)]


def _single(here: str, variable: Variable) -> Variable:
    """Return a variable if no other one has its name."""
    if variable.again_on:
        raise FmuVariableError(
            f"{here} variable '{variable.name}': the model description declares it again on line "
            f"{variable.again_on}; name another variable, or export the model again"
        )
    return variable


def _element(here: str, name: str, variable: Variable, number: int) -> Channel:
    if variable.shape and 1 <= number <= variable.size:
        return Channel(variable, number - 1)
    what = (
        f"'{variable.name}' has {variable.size} element(s), counted from 1"
        if variable.shape
        else f"'{variable.name}' is not an array; leave out the brackets"
    )
    raise FmuVariableError(f"{here} variable '{name}': {what}")


def known_names(names: Iterable[str]) -> str:
    """Return the first names that a message could have meant, and the number of the others."""
    return listed(list(names), 8) or "the FMU has none"


# ---- start values ----


def start_channels(model: Model, values: Mapping[str, Value]) -> dict[Channel, Value]:
    """Return the start values by channel; a whole array is given by its first element.

    Raises:
        FmuVariableError: a variable is missing, cannot be set, or not to this value.
    """
    return {_start_channel(model, name, value): value for name, value in values.items()}


def _start_channel(model: Model, name: str, value: Value) -> Channel:
    whole = name in model.variables and isinstance(value, list)
    place = "start value:"
    if whole:
        channel = Channel(_single(f"{model.path}: {place}", model.variables[name]))
    else:
        channel = find_channel(model, place, name)
    variable = channel.variable
    if not variable.settable:
        problem = f"'{name}' is {variable.causality}; expected a parameter or an input"
    elif whole:
        problem = _misfit_list(variable, value)
    else:
        problem = _misfit(variable, value)
    if problem:
        raise FmuVariableError(f"{model.path}: start value {name} = {str(value)[:60]}: {problem}")
    return channel


def _misfit_list(variable: Variable, values: Value) -> str:
    """Return the fault in the values of a whole array, or an empty text."""
    assert isinstance(values, list)
    if len(values) != variable.size:
        return f"expected {variable.size} value(s)"
    for number, value in enumerate(values, start=1):
        # A profile's lists hold numbers, so whole numbers may come as floats.
        whole = variable.is_integer and isinstance(value, float) and value.is_integer()
        problem = _misfit(variable, int(value) if whole else value)
        if problem:
            return f"{problem} as value {number}"
    return ""


def _misfit(variable: Variable, value: object) -> str:
    """Return the fault in a start value, or an empty text."""
    if variable.is_boolean:
        return "" if isinstance(value, bool) else "expected true or false"
    if variable.kind == "String":
        return "" if isinstance(value, str) else "expected text"
    if not (variable.is_integer or variable.is_real):
        return f"'{variable.name}' is {variable.kind}; expected a number, text, true or false"
    number = value if isinstance(value, int | float) and not isinstance(value, bool) else None
    if variable.is_integer and not isinstance(number, int):
        return "expected a whole number"
    if number is None or not abs(number) <= float_info.max:
        return "expected a finite number"
    return _out_of_range(variable, number)


def _out_of_range(variable: Variable, value: float) -> str:
    low, high = variable.minimum, variable.maximum
    allowed = ""
    if low is not None and value < low:
        allowed = f"at least {low:g}"
    elif high is not None and value > high:
        allowed = f"at most {high:g}"
    return f"expected {allowed} {variable.unit}".rstrip() if allowed else ""
