"""Errors of the command line are one line that cannot steer a terminal."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.cli.exit import fail, visible


def test_an_error_is_one_line_and_its_code(capsys: pytest.CaptureFixture[str]) -> None:
    assert fail("a.toml: wrong\n  twice", 2) == 2
    assert capsys.readouterr().err == "error: a.toml: wrong twice\n"


def test_a_long_word_is_shortened(capsys: pytest.CaptureFixture[str]) -> None:
    fail(f"{'x' * 1000} is no name", 1)
    line = capsys.readouterr().err
    assert "...(700 more characters)..." in line
    assert line.endswith("is no name\n")


@given(st.text())
def test_what_is_visible_is_printable(text: str) -> None:
    shown = visible(text)
    assert len(shown) == len(text)
    assert all(c.isprintable() or c == "\n" for c in shown)
