"""Text that came from an FMU, fit for a terminal."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus.text import clean, listed, printable


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("two\nlines\tand  more", "two lines and more"),
        ("\x1b[31mred", "?[31mred"),
        ("turned \u202e round", "turned ? round"),
        ("half \ud800 surrogate", "half ? surrogate"),
        ("a\u00a0b", "a b"),
    ],
)
def test_what_could_steer_a_terminal_becomes_a_question_mark(text: str, line: str) -> None:
    assert printable(text) == line


@given(st.text(), st.integers(4, 60))
def test_a_line_is_printable_and_no_longer_than_its_limit(text: str, limit: int) -> None:
    line = printable(text, limit)
    assert line.isprintable()
    assert len(line) <= limit
    assert clean(line, limit) == line


def test_a_long_text_shows_that_it_is_cut() -> None:
    assert printable("x" * 300, 10) == "xxxxxxx..."


def test_of_many_names_the_others_are_counted() -> None:
    assert listed([]) == ""
    assert listed(["a", "b"]) == "a, b"
    assert listed(list("abcdefgh"), shown=2) == "a, b and 6 more"
