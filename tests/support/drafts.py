"""Vehicle FMUs described in a few words, for the drafts of their profiles."""

from __future__ import annotations

from pathlib import Path

import pytest

from fmus.description.model import Interface, Kind, Model, Variable
from fmus.errors import FmuProfileError
from fmus.profile.draft_profile import draft_profile, require_confident

PATH = Path("car.fmu")
CS = Interface(Kind.CO_SIMULATION, "car")


def variable(text, causality, **more):
    """``name [unit]`` as a variable."""
    name, _, unit = text.partition(" [")
    return Variable(name, 0, "Real", causality, unit=unit.rstrip("]"), **more)


def a_model(inputs, outputs, parameters=(), interfaces=(CS,), default_step=None, more=()):
    """Of texts such as ``speed [m/s]``, or variables."""
    variables = [
        v if isinstance(v, Variable) else variable(v, causality, settable=causality != "output")
        for causality, group in (("input", inputs), ("output", outputs), ("parameter", parameters))
        for v in group
    ]
    return Model(
        path=PATH,
        fmi_version="2.0",
        name="Car",
        guid="{}",
        generation_tool="",
        description="",
        interfaces={interface.kind: interface for interface in interfaces},
        variables={v.name: v for v in [*variables, *more]},
        units={},
        platforms=(),
        states=0,
        event_indicators=0,
        default_step=default_step,
        default_tolerance=None,
    )


def drafted(inputs, outputs, parameters=(), **more):
    return draft_profile(a_model(inputs, outputs, parameters, **more))


def questions(draft):
    """The one line that an unsure draft is refused with."""
    assert not draft.confident
    with pytest.raises(FmuProfileError) as caught:
        require_confident(draft, PATH)
    message = str(caught.value)
    assert message.startswith("car.fmu: ")
    assert message.isprintable()
    return message
