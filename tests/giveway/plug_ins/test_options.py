"""Options of somebody else's controller."""

from __future__ import annotations

import dataclasses

import pydantic
import pytest

from giveway.errors import ConfigError, ControlError
from giveway.plug_ins.options import plain, read_options


@dataclasses.dataclass(frozen=True)
class Plain:
    headway: float = 2.0
    polite: bool = False


class Model(pydantic.BaseModel):
    headway: float = pydantic.Field(2.0, gt=0.0)
    polite: bool = False


@pytest.mark.parametrize("kind", [Plain, Model])
def test_texts_and_numbers_become_the_options_types(kind):
    options = read_options("own", kind, {"headway": "1.5", "polite": "yes"})
    assert (options.headway, options.polite) == (1.5, True)
    assert plain(options) == {"headway": 1.5, "polite": True}
    assert plain(read_options("own", kind, {})) == {"headway": 2.0, "polite": False}


@pytest.mark.parametrize("kind", [Plain, Model])
@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"headwy": 1.0}, "headwy: 'own' has no such option; did you mean 'headway'"),
        ({"zzz": 1.0}, "expected one of headway, polite"),
        ({"headway": "wide"}, "headway = 'wide'"),
        ({"headway": True}, "headway = True: should be a number, not true or false"),
    ],
)
def test_what_is_wrong_is_one_line_with_key_and_value(kind, values, said):
    with pytest.raises(ConfigError, match=said) as caught:
        read_options("own", kind, values)
    assert str(caught.value).isprintable()


def test_bounds_are_the_authors():
    with pytest.raises(ConfigError, match=r"headway = -1.0: should be greater than 0"):
        read_options("own", Model, {"headway": -1.0})


def test_a_controller_without_options_takes_none():
    assert read_options("own", None, {}) is None
    with pytest.raises(ConfigError, match="it has no options"):
        read_options("own", None, {"headway": 1.0})


def test_options_are_a_dataclass_or_a_model():
    with pytest.raises(ControlError, match="expected a dataclass or a pydantic model"):
        read_options("own", dict, {"a": 1})


def test_what_its_own_check_raises_is_the_users_to_mend():
    @dataclasses.dataclass
    class Picky:
        headway: float = 2.0

        def __post_init__(self):
            raise RuntimeError("never\nenough")

    with pytest.raises(ConfigError, match=r"'own' refuses them .RuntimeError: never"):
        read_options("own", Picky, {})
