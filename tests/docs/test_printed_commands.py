"""Every command that README, docs and tutorials print is one, and a few of them are run."""

from __future__ import annotations

import importlib.util
import random
import re
import shlex
import sys
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import typer.main

from giveway.cli.app import build_app
from giveway.studies.definition import read_definition
from sumo_scenarios import available

if TYPE_CHECKING:
    from collections.abc import Callable
    from subprocess import CompletedProcess

ROOT = Path(__file__).parents[2]
SPEC = importlib.util.spec_from_file_location("run_printed", ROOT / "docs" / "run_printed.py")
assert SPEC is not None
assert SPEC.loader is not None
runner: Any = importlib.util.module_from_spec(SPEC)
sys.modules["run_printed"] = runner
SPEC.loader.exec_module(runner)
PAGES: list[Path] = runner.PAGES
RUN = 2  # of those that need nothing, drawn by a seed


def commands_in(text: str) -> list[list[str]]:
    """The words behind each ``giveway`` in shell lines."""
    return [words for words, _ in runner.commands_in(text)]


def printed() -> dict[str, list[str]]:
    """Every printed command, by its page and its words."""
    found = {}
    for page in PAGES:
        for command in runner.printed_on(page):
            words = list(command.words)
            found[f"{page.relative_to(ROOT)}: {' '.join(words)}"] = words
    records = tomllib.loads((ROOT / "docs" / "figures" / "records.toml").read_text("utf-8"))
    for name, record in records.items():
        for words in commands_in("\n".join(record["commands"])):
            found[f"records.toml, {name}: {' '.join(words)}"] = words
    return found


PRINTED = printed()


def parse(words: list[str]) -> None:
    """Read a command's arguments as the program does, without doing anything."""
    command: Any = typer.main.get_command(build_app(words))
    context = command.make_context("giveway", list(words))
    while hasattr(command, "resolve_command"):
        rest = [*context._protected_args, *context.args]
        name, command, rest = command.resolve_command(context, rest)
        if {"--help", "--help-all", "-h"} & set(rest):
            return
        context = command.make_context(name, rest, parent=context)


def test_the_runner_reads_on_below_a_block_of_another_language(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "```python\nimport giveway\n```\n\n"
        "```sh\n.venv/bin/giveway config street > run.toml  # all\n"
        "cd there && giveway doctor\n```\n\n"
        "<!-- not run -->\n```sh\ngiveway run car.sumocfg\n```\n",
        encoding="utf-8",
    )
    config, doctor, shown = runner.printed_on(page)
    assert (config.words, config.out) == (("config", "street"), "run.toml")
    assert doctor.text == "giveway doctor"
    assert [config.shown, shown.shown] == [False, True]


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("run encounter --seed 4 --out results/mine", ""),
        ("run sumo_scenarios/junction/junction.sumocfg", ""),  # lies in the repository
        ("run junction --style careful", ""),
        ("run mine.sumocfg", "mine.sumocfg is not there"),
        ("replay results/mine", "results/mine is not there"),
        ("run --controller careful", "careful is a plug-in of the reader's"),
        ("validate CITR_FOLDER --dataset citr", "a placeholder"),
        ("study paper --runs 5", ""),
        ("study paper --dry-run", ""),
        ("study paper --runs 50", "slow: --all"),
        ("study paper", "slow: --all"),
    ],
)
def test_the_runner_says_why_it_leaves_a_command_out(
    words: str, reason: str, tmp_path: Path
) -> None:
    command = runner.Printed(runner.README, tuple(words.split()), "", False)
    assert runner.why_not(command, tmp_path, tmp_path / "readme", slow=False) == reason


def test_the_runner_tells_a_failure(tmp_path: Path) -> None:
    command = runner.Printed(runner.README, ("run", "nowhere"), "", False)
    assert "nowhere" in runner.run(command, tmp_path)
    config = runner.Printed(runner.README, ("config", "street"), "run.toml", False)
    assert runner.run(config, tmp_path) == ""
    assert tomllib.loads((tmp_path / "run.toml").read_text("utf-8"))["scenario"]


def test_the_pages_print_many() -> None:
    assert len(PRINTED) > 100


@pytest.mark.parametrize("name", PRINTED)
def test_a_printed_command_is_one(name: str) -> None:
    parse(PRINTED[name])


@pytest.mark.parametrize(
    "words",
    [["runn", "encounter"], ["run", "encounter", "--sed", "4"], ["study", "--runs", "many"]],
)
def test_another_is_not(words: list[str]) -> None:
    with pytest.raises(Exception, match=r"No such|valid integer"):
        parse(words)


def needs_nothing(words: list[str]) -> bool:
    """Whether a command can be typed in an empty folder, and is a matter of seconds."""
    if words[:1] in (["scenarios"], ["studies"]) or words[:2] == ["config", "street"]:
        return True
    foreign = runner.PLUG_INS | {"--set", "--set-model", "--config", "--vehicle", "--profile"}
    return (
        words[:1] == ["run"]
        and words[1:2] != []
        and words[1] in available()
        and not foreign & set(words)
        and not any(re.search(r"[:<]|\.(toml|fmu|sumocfg)$", word) for word in words)
    )


def drawn() -> list[str]:
    """Some of those that need nothing, the same every time."""
    able = sorted({" ".join(words) for words in PRINTED.values() if needs_nothing(words)})
    return random.Random(21).sample(able, RUN)


@pytest.mark.parametrize("command", drawn())
def test_a_printed_command_does_something(
    command: str, type_here: Callable[..., CompletedProcess[str]]
) -> None:
    done = type_here(*shlex.split(command))
    assert done.returncode == 0, done.stderr
    assert done.stdout


STUDIES = [
    pytest.param(block, id=f"{page.name}-{number}")
    for page in PAGES
    for number, block in enumerate(
        re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    )
    if "[factors" in block
]


@pytest.mark.parametrize("block", STUDIES)
def test_a_printed_study_is_one(block: str, tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text(block, encoding="utf-8")
    assert read_definition(file).factors


def test_the_readmes_screen_is_that_of_its_first_drive(
    type_here: Callable[..., CompletedProcess[str]],
) -> None:
    text = runner.README.read_text(encoding="utf-8")
    first = next(words for words in commands_in(text) if words[:1] == ["run"])
    shown = re.search(r"```text\n(.*?)```", text, re.DOTALL)
    assert shown is not None
    printed = [line.rstrip() for line in type_here(*first, "--no-pictures").stdout.splitlines()]
    told = [line for line in shown[1].splitlines() if "Real-time" not in line]
    assert [line for line in printed if line in told] == told
    assert len(told) > 15


def test_the_readme_is_short() -> None:
    text = runner.README.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 110
    assert len(text.split()) <= 750
    assert len(commands_in(text)) <= 10
    assert text.count("![") == 3
