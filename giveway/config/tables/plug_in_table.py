"""A table whose keys are the names of plug-ins, as `[rules]` and `[metrics]` are."""

from collections.abc import Mapping
from typing import Any, ClassVar

from pydantic import ConfigDict, JsonValue, model_validator

from giveway.config.option import Section
from giveway.errors import suggestion
from giveway.plug_ins.finding import declared_names, is_reference
from giveway.plug_ins.sockets import Socket


class PlugInTable(Section):
    """Names of plug-ins, each with `true` or a table of its options, beside giveway's own keys."""

    model_config = ConfigDict(extra="allow")

    __pydantic_extra__: dict[str, bool | dict[str, JsonValue]]

    socket: ClassVar[Socket]

    @model_validator(mode="before")
    @classmethod
    def _known(cls, values: Any) -> Any:
        """Refuse a name that is neither a key of giveway's nor a name of an installed package."""
        names = values if isinstance(values, Mapping) else {}
        for name in names:
            if name in cls.model_fields or is_reference(str(name)):
                continue
            declared = declared_names(cls.socket)
            if name not in declared:
                raise _unknown(str(name), [*cls.model_fields, *declared], cls.socket.what)
        return values

    @property
    def plugged_in(self) -> Mapping[str, Mapping[str, Any]]:
        """The named plug-ins, each with its options; a plug-in that is set to false is left out."""
        extra = self.__pydantic_extra__
        return {name: {} if own is True else own for name, own in extra.items() if own is not False}


def _unknown(name: str, known: list[str], what: str) -> ValueError:
    """Return the error for a key that is no plug-in's name."""
    some = f"one of {', '.join(known)}, or " if known else ""
    hint = suggestion(name, known, f"expected {some}module:Class of a package")
    return ValueError(f"{name}: no {what} has this name; {hint}")
