"""The script that counts sentences without a head, and the glossary's words in the code."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

_ROOT = Path(__file__).parents[1]
_SCRIPT = _ROOT / ".ci/words.py"
_PACKAGES = ("giveway", "controller", "pedestrian_model", "fmus", "sumo_scenarios")

_MODULE = '''
"""The crowd of one scenario."""


def speeds(crowd, config, step):
    """{first}

    Args:
        crowd: {crowd}
        config: Configuration of the ego.
        step: Index of the control step, or None
            of all steps.
    """
'''


def _words(folder: Path, *limits: str, first: str, crowd: str) -> tuple[int, list[str]]:
    (folder / "crowd.py").write_text(_MODULE.format(first=first, crowd=crowd))
    command = [sys.executable, str(_SCRIPT), str(folder), *limits]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert not done.stderr
    return done.returncode, done.stdout.splitlines()


@pytest.mark.parametrize(
    ("first", "kind"),
    [
        ("Return the speeds [m/s].", None),
        ("(n,) [m/s] speeds of the pedestrians.", None),
        ("What the pedestrians do.", "headless"),
        ("Of the pedestrians the speeds.", "headless"),
        ("(n,) [m/s].", "headless"),
        ("(n,) [m/s] of the pedestrians.", "headless"),
        ("Likewise the speeds.", "headless"),
        ("None if there are no people.", "headless"),
        ("Speeds of the pedestrians; None: there are none.", "absence"),
    ],
)
def test_a_first_line_needs_a_head(tmp_path: Path, first: str, kind: str | None) -> None:
    _, lines = _words(tmp_path, first=first, crowd="The people.")
    found = [line.split(": ")[1] for line in lines[:-1]]
    assert found == ([] if kind is None else [kind])
    assert lines[-1].startswith("2 docstrings: ")


def test_an_entry_of_args_must_not_open_with_a_preposition(tmp_path: Path) -> None:
    _, lines = _words(tmp_path, first="Return the speeds.", crowd="of the scenario.")
    assert lines[0] == f"{tmp_path / 'crowd.py'}:6: genitive: crowd: of the scenario."


@pytest.mark.parametrize(
    ("limits", "code"),
    [
        ((), 0),
        (("--headless", "50", "--genitive", "1"), 0),
        (("--headless", "49"), 1),
        (("--genitive", "0"), 1),
    ],
)
def test_only_a_limit_that_is_exceeded_fails(
    tmp_path: Path, limits: tuple[str, ...], code: int
) -> None:
    done, _ = _words(tmp_path, *limits, "--quiet", first="Of people.", crowd="of the scenario.")
    assert done == code


def _glossary() -> list[list[str]]:
    """The rows of the glossary's tables: term, meaning, unit, and what it is not called."""
    text = (_ROOT / "docs/glossary.md").read_text(encoding="utf-8")
    rows = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in row] for row in rows]
    return [row for row in cells if row[0] != "term" and set(row[0]) != {"-"}]


def _identifiers(file: Path) -> set[str]:
    """The names that a module defines or uses, and its own."""
    nodes = ast.walk(ast.parse(file.read_text(encoding="utf-8")))
    attributes = ("name", "id", "attr", "arg", "asname")
    found = {getattr(node, attribute, None) for node in nodes for attribute in attributes}
    return {name for name in found if isinstance(name, str)} | {file.stem}


def test_the_glossary_has_one_complete_row_per_term() -> None:
    rows = _glossary()
    assert {len(row) for row in rows} == {4}
    terms = [row[0] for row in rows]
    assert sorted(set(terms)) == sorted(terms)
    assert all(row[1] for row in rows)


def test_no_identifier_is_a_word_that_the_glossary_forbids() -> None:
    forbidden = {twin: row[0] for row in _glossary() for twin in re.findall(r"`([^`]+)`", row[3])}
    assert forbidden
    found = [
        f"{file.relative_to(_ROOT)}: {name}; call it {forbidden[name]}"
        for package in _PACKAGES
        for file in sorted((_ROOT / package).rglob("*.py"))
        for name in sorted(_identifiers(file) & forbidden.keys())
    ]
    assert found == []
