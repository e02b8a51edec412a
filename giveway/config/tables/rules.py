"""The table `[rules]`: which rules of the road an ego heeds, each by its registered name."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from typing import Any

from pydantic import ConfigDict, JsonValue, model_validator

from giveway.config.option import Section, option
from giveway.plug_ins.finding import declared_names, is_reference
from giveway.plug_ins.sockets import RULE

OF_PRIORITY = frozenset({"crossings", "right_of_way", "merging"})
"""The rules about who goes first; they hold by default if the controller keeps priority."""


class RulesConfig(Section):
    """Which rules of the road the ego heeds; a rule that is left out is up to its controller."""

    model_config = ConfigDict(extra="allow")

    __pydantic_extra__: dict[str, bool | dict[str, JsonValue]]

    traffic_lights: bool | None = option(
        None, None, "the ego stops at red lights. Left out: it does"
    )
    signal_advice: bool | None = option(
        None,
        None,
        "lights tell the ego their plan (SPaT): it waits for nobody who will find theirs red, and "
        "mpc arrives when its own is green. Left out: they do",
    )
    stops: bool | None = option(
        None,
        None,
        "an ego that is taken over serves its scheduled stops. Left out: if it is a bus, a coach "
        "or a tram",
    )
    crossings: bool | None = option(
        None,
        None,
        "the ego gives way to people at crossings, and they rely on it. Left out: it does, but "
        "not with the paper's controllers",
    )
    right_of_way: bool | None = option(
        None,
        None,
        "the ego gives way to vehicles at junctions by the network's priority. Left out: it does, "
        "but not with the paper's controllers",
    )
    merging: bool | None = option(
        None,
        None,
        "the ego and others come one behind the other where lanes become one. Left out: they do, "
        "but not with the paper's controllers",
    )
    following: bool | None = option(
        None, None, "the ego keeps its distance to vehicles in front. Left out: it does"
    )
    speed_limits: bool | None = option(
        None,
        None,
        "limits of lanes and comfort in bends cap the speed. Left out: if [regulation] "
        "reference_speed is 'lane'",
    )

    @model_validator(mode="before")
    @classmethod
    def _known(cls, values: Any) -> Any:
        """Refuse a name that is neither one of giveway's rules nor one of an installed package."""
        names = values if isinstance(values, Mapping) else {}
        for name in names:
            if name in cls.model_fields or is_reference(str(name)):
                continue
            declared = declared_names(RULE)
            if name not in declared:
                raise _unknown(str(name), [*cls.model_fields, *declared])
        return values

    @property
    def plugged_in(self) -> Mapping[str, Mapping[str, Any]]:
        """The rules of other packages that hold, by name, with the options that are set."""
        extra = self.__pydantic_extra__
        return {name: {} if own is True else own for name, own in extra.items() if own}


def _unknown(name: str, known: list[str]) -> ValueError:
    """The error that a name in ``[rules]`` is no rule's."""
    close = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    hint = f"did you mean '{close[0]}'?" if close else f"expected one of {', '.join(known)}"
    return ValueError(f"{name}: no rule has this name; {hint}, or module:Class of a package")
