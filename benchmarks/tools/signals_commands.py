"""The commands of the campaign of signals, on inputs that take a few seconds at most."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from campaign_bases import Bases

Words = list[object]

_FEW: Final = ("--pedestrians", 3, "--time-limit", 1, "--no-pictures", "--out", "out")
_STUDY: Final = """name = "two"
replications = 1
[run]
scenario = "shared_space"
time_limit = 0.3
[factors]
"crowd.pedestrians" = [2, 3]
"""


@dataclass(frozen=True)
class Command:
    """A command of the campaign.

    Attributes:
        prepare: Function that puts the input into the case's folder and returns the words.
        results: Kind of the folder ``out``: "run", "study" or "" without one.
        pages: Files that are written whole or not at all.
    """

    prepare: Callable[[Bases, Path], Words]
    results: str = ""
    pages: tuple[str, ...] = ()


def _run(_bases: Bases, _folder: Path) -> Words:
    return ["run", *_FEW]


def _run_alone(_bases: Bases, _folder: Path) -> Words:
    return ["run", "--no-isolate", *_FEW]


def _study(_bases: Bases, folder: Path) -> Words:
    (folder / "two.toml").write_text(_STUDY)
    return ["study", "two.toml", "--out", "out", "--no-report"]


def _replay(bases: Bases, folder: Path) -> Words:
    shutil.copytree(bases.runs[1], folder / "run")
    return ["replay", "run"]


def _export(bases: Bases, folder: Path) -> Words:
    shutil.copytree(bases.runs[0], folder / "run")
    return ["export", "run", "run", "--format", "fcd", "--out", "fcd.xml"]


def _report(bases: Bases, folder: Path) -> Words:
    shutil.copytree(bases.study, folder / "study")
    return ["report", "study", "--no-replays"]


def _rerun(bases: Bases, folder: Path) -> Words:
    shutil.copytree(bases.study, folder / "study")
    return ["rerun", "study", "c1-s1", "--no-pictures", "--out", "out"]


def _recover(bases: Bases, folder: Path) -> Words:
    shutil.copytree(bases.journal, folder / "journal")
    return ["recover", "journal", "--out", "out"]


def _doctor(_bases: Bases, _folder: Path) -> Words:
    return ["doctor"]


def _fmu_check(bases: Bases, _folder: Path) -> Words:
    return ["fmu", "check", bases.fmus[0], "--out", "checked"]


def _fmu_identify(bases: Bases, _folder: Path) -> Words:
    wanted = ("--out", "identified.toml", "--picture", "identified.png")
    return ["fmu", "identify", bases.fmus[0], "--speeds", 2, *wanted]


def _scenarios(_bases: Bases, _folder: Path) -> Words:
    return ["scenarios"]


def _check(_bases: Bases, _folder: Path) -> Words:
    return ["check", "controller", "idm"]


COMMANDS: Final[dict[str, Command]] = {
    "run": Command(_run, "run"),
    "run-alone": Command(_run_alone, "run"),
    "study": Command(_study, "study"),
    "replay": Command(_replay, pages=("run/replay.html",)),
    "export": Command(_export, pages=("fcd.xml",)),
    "report": Command(_report, pages=("study/report.html",)),
    "rerun": Command(_rerun, "run"),
    "recover": Command(_recover, "run"),
    "doctor": Command(_doctor),
    "fmu-check": Command(_fmu_check),
    "fmu-identify": Command(_fmu_identify, pages=("identified.toml", "identified.png")),
    "check": Command(_check),
    "scenarios": Command(_scenarios),
}
