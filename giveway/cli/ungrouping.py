"""Commands that take whole groups of options, of which typer sees one parameter for each field."""

import inspect
from collections.abc import Callable
from typing import Any


def ungrouped(command: Callable[..., None]) -> Callable[..., None]:
    """Return ``command`` with one parameter for each field of the groups that it takes."""
    own = inspect.signature(command, eval_str=True).parameters
    flat: list[inspect.Parameter] = []
    for parameter in own.values():
        flat += _fields(parameter.annotation) if _is_group(parameter) else [parameter]
    # values arrive by keyword, so that one without a default may follow one that has one
    shown = [parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY) for parameter in flat]

    def call(**given: Any) -> None:
        command(
            **{
                name: (
                    parameter.annotation(*(given[key] for key in parameter.annotation._fields))
                    if _is_group(parameter)
                    else given[name]
                )
                for name, parameter in own.items()
            }
        )

    call.__signature__ = inspect.Signature(shown)  # type: ignore[attr-defined]
    call.__annotations__ = {parameter.name: parameter.annotation for parameter in shown}
    call.__doc__, call.__name__ = command.__doc__, command.__name__
    return call


def _is_group(parameter: inspect.Parameter) -> bool:
    return hasattr(parameter.annotation, "_fields")


def _fields(group: Any) -> list[inspect.Parameter]:
    kinds, defaults = group.__annotations__, group._field_defaults
    return [
        inspect.Parameter(
            name,
            inspect.Parameter.KEYWORD_ONLY,
            default=defaults.get(name, inspect.Parameter.empty),
            annotation=kinds[name],
        )
        for name in group._fields
    ]
