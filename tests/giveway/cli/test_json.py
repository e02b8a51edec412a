"""``--json``: what a command has found, for scripts, and nothing else on standard output."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from fmus import bundled_fmu

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from subprocess import CompletedProcess

    Type = Callable[..., CompletedProcess[str]]

STUDY = """
replications = 2
name = "two"
[run]
scenario = "shared_space"
controller = "pid-paper"
[factors]
"crowd.pedestrians" = [2, 3]
"""


def test_a_run(type_here: Type, tmp_path: Path) -> None:
    words = ("run", "shared_space", "--pedestrians", 3, "--controller", "pid-paper", "--json")
    done = type_here(*words, "--no-pictures", "--out", "here")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["results"] == "here"
    assert found["ending"] == "completed"
    kept = json.loads((tmp_path / "here" / "summary.json").read_text())
    assert found["summary"] == kept
    assert kept["pedestrians"] == 3


def test_a_study(type_here: Type, tmp_path: Path) -> None:
    (tmp_path / "two.toml").write_text(STUDY)
    done = type_here("study", "two.toml", "--json", "--no-report", "--jobs", 1)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert (found["runs"], found["failed"]) == (4, 0)
    times = [row for row in found["levels"] if row["metric"] == "completion_time"]
    assert [row["runs"] for row in times] == [2, 2]
    assert all(row["mean"] > 9.0 for row in times)


def test_findings(type_here: Type) -> None:
    for words, key in ((("doctor",), "level"), (("fmu", "check", bundled_fmu()), "verdict")):
        done = type_here(*words, "--json")
        assert done.returncode == 0, done.stderr
        found = json.loads(done.stdout)
        assert found["findings"]
        assert all(finding[key] and finding["text"] for finding in found["findings"])


@pytest.mark.parametrize("listed", ["scenarios", "studies"])
def test_a_list_has_the_same_names_and_descriptions(type_here: Type, listed: str) -> None:
    found = json.loads(type_here(listed, "--json").stdout)
    lines = type_here(listed).stdout.splitlines()
    assert [line.split(maxsplit=1) for line in lines] == [list(item) for item in found.items()]


def test_an_error_stays_one_line_on_standard_error(type_here: Type) -> None:
    done = type_here("run", "nowhere", "--json")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: unknown scenario 'nowhere'")
