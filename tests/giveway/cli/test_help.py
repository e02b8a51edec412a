"""Help pages: everyday options first, whole names at every width; the shell's completion."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from giveway.config.files.layers import options

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from subprocess import CompletedProcess

    Type = Callable[..., CompletedProcess[str]]


def test_the_help_of_run_fits_on_a_screen(type_here: Type, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    lines = type_here("run", "--help").stdout.splitlines()
    assert len(lines) <= 60
    assert max(map(len, lines)) <= 80
    shown = [word for line in lines for word in re.findall(r"^  (?:-q, )?(--[\w-]+)", line)]
    assert 12 <= len(shown) <= 20
    assert {"--controller", "--pedestrians", "--vehicle", "--help-all"} <= set(shown)


@pytest.mark.parametrize("width", [60, 80, 200])
def test_all_options_are_there_whole(
    type_here: Type, monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    text = type_here("run", "--help-all").stdout
    assert all(len(s) <= width for s in text.splitlines() if not s.startswith("  --"))
    shown = set(re.findall(r"(?<![\w-])--[\w-]+", text))
    assert {option.flag for option in options() if option.location != ("scenario",)} <= shown
    assert "…" not in text
    for heading in ("Options:", "Run:", "Ego:", "Vehicle:", "Pedestrians:", "Regulation:"):
        assert re.search(f"^{heading}$", text, re.M)


def test_controllers_of_installed_packages_are_named(type_here: Type) -> None:
    text = type_here("run", "--help").stdout
    assert re.search(r"--controller mpc\|.*\|idm\|speed-holder$", text, re.M)


def test_commands_are_listed_with_whole_sentences(type_here: Type) -> None:
    text = type_here("--help").stdout
    assert "..." not in text.partition("Commands:")[2]
    assert "  --runs, --seeds INTEGER " in type_here("study", "--help").stdout


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("giveway run sh", "shared_space"),
        ("giveway run --controller pid-t", "pid-tuned"),
        ("giveway study abl", "ablation"),
        ("giveway stud", "studies"),
        ("giveway run --pedest", "--pedestrians"),
    ],
)
def test_shells_complete_names(
    type_here: Type, monkeypatch: pytest.MonkeyPatch, line: str, found: str
) -> None:
    monkeypatch.setenv("_GIVEWAY_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", line.replace(" ", "\n"))
    monkeypatch.setenv("COMP_CWORD", str(line.count(" ")))
    assert found in type_here().stdout.split()
    monkeypatch.setenv("_GIVEWAY_COMPLETE", "complete_zsh")
    monkeypatch.delenv("COMP_WORDS")
    monkeypatch.setenv("_TYPER_COMPLETE_ARGS", line)
    assert f'"{found}"' in type_here().stdout


def test_shells_complete_a_scenario_of_ones_own(
    type_here: Type, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "town").mkdir()
    (tmp_path / "town" / "town.sumocfg").touch()
    (tmp_path / "town" / "town.net.xml").touch()
    monkeypatch.setenv("_GIVEWAY_COMPLETE", "complete_bash")
    for typed, found in (("to", ["town/"]), ("town/", ["town/town.sumocfg"])):
        monkeypatch.setenv("COMP_WORDS", f"giveway\nrun\n{typed}")
        monkeypatch.setenv("COMP_CWORD", "2")
        assert type_here().stdout.split() == found
