"""JSON as giveway writes it."""

import json
import math

from hypothesis import given
from hypothesis import strategies as st

from giveway.results.json_text import DECIMALS, json_text


def test_what_is_no_number_becomes_null() -> None:
    assert json.loads(json_text({"a": math.nan, "b": [math.inf, (-math.inf, 1.0)]})) == {
        "a": None,
        "b": [None, [None, 1.0]],
    }


def test_there_is_no_negative_zero_and_no_noise() -> None:
    assert json_text({"a": -1e-9, "b": 0.1 + 0.2}) == '{\n  "a": 0.0,\n  "b": 0.3\n}\n'


def test_letters_of_every_language_stay() -> None:
    assert "Özgüner" in json_text({"author": "Özgüner"})


@given(st.floats(-1e6, 1e6))
def test_a_number_is_kept_to_the_decimals(value: float) -> None:
    kept = json.loads(json_text({"x": value}))["x"]
    assert abs(kept - value) <= 0.51 * 10.0**-DECIMALS
