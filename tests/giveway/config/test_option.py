"""Options: bounds, units, and values as flags and files give them."""

from typing import Any

import pytest
from pydantic import ValidationError

from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.config.option import (
    NameList,
    OptionList,
    Section,
    SpeedOrLane,
    TextOrNumber,
    TimeOrWindow,
    expectation,
    is_number,
    option,
)
from giveway.errors import ConfigError


class Table(Section):
    """A table with an option of each kind."""

    width: float = option(
        1.0, "m", "width of a door", least=0.1, because=("people fit", "no door is wider"), ge=0
    )
    people: int = option(0, None, "number of people", ge=0, le=9, because="more do not fit")
    names: NameList = ()
    radius: TextOrNumber = ""
    speed: SpeedOrLane = 4.0
    time: TimeOrWindow = 0.0
    words: OptionList = ()


def said(**values: Any) -> str:
    with pytest.raises(ValidationError) as caught:
        Table(**values)
    (error,) = caught.value.errors()
    return expectation(error, Table.model_fields[str(error["loc"][0])])


def test_what_a_flag_says_is_what_a_file_says() -> None:
    by_flag = Table(names="a, b", radius="2.5", speed="lane", time="3,9", words="--a 'b c'")
    by_file = Table(names=["a", "b"], radius=2.5, speed="lane", time=[3, 9], words=["--a", "b c"])
    assert by_flag == by_file
    assert by_flag.words == ("--a", "b c")
    assert by_flag.time == (3.0, 9.0)


@pytest.mark.parametrize("width", [0.0, 0.1, 5.0])
def test_zero_or_a_sensible_size_is_taken(width: float) -> None:
    assert Table(width=width).width == width


def test_a_size_too_small_is_refused_with_unit_and_reason() -> None:
    assert said(width=1e-9) == "should be 0, or at least 0.1 [m]: people fit (width of a door)"
    assert "at least 0 [m]: people fit" in said(width=-1.0)


def test_a_wrong_sign_is_not_told_the_reason_of_the_maximum() -> None:
    assert said(people=-3) == "should be at least 0 (number of people)"
    assert "at most 9: more do not fit (" in said(people=30)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"speed": "quick"}, "expected a number or 'lane'"),
        ({"time": "9,3"}, "the earliest and the latest"),
        ({"time": "never"}, "expected a time"),
        ({"words": "'open"}, "as in a shell"),
    ],
)
def test_a_value_of_no_sense_is_told_what_would_have(values: dict[str, str], words: str) -> None:
    assert words in said(**values)


def test_truth_and_infinity_are_no_numbers() -> None:
    assert is_number(3)
    assert is_number(0.5)
    assert not is_number(True)
    assert not is_number(float("inf"))
    assert not is_number("3")


@pytest.mark.parametrize(
    ("value", "reason", "other"),
    [(0.0001, "milliseconds", "too far"), (0.7, "too far", "milliseconds")],
)
def test_the_reason_given_is_that_of_the_bound_that_was_broken(value, reason, other):
    with pytest.raises(ConfigError) as refused:
        load([Layer("", {"time_step": value})])
    assert reason in str(refused.value)
    assert other not in str(refused.value)
