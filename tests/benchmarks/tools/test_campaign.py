"""A sample of the campaign of mutated inputs; what each failure of it was has a test of its own."""

from __future__ import annotations

import dataclasses
import os
import shutil
import signal
from collections import Counter
from collections.abc import Iterator
from itertools import count
from pathlib import Path

import campaign
import campaign_kinds
import pytest
from campaign_bases import Bases
from campaign_folders import FOLDER_KINDS, Expected
from campaign_inputs import INPUT_KINDS
from campaign_kinds import KINDS, Case, make_case
from campaign_nursery import Ended, Nursery
from campaign_verdicts import TABLES, judge

SEED = 100
LIMIT = campaign.PATIENCE * campaign.LIMIT  # [s] for what takes less than one
ALARM = getattr(signal, "SIGALRM", 14)
SAMPLE = {  # some seventy cases; those of studies take longest
    "scenario": 10,
    "settings": 8,
    "profile": 7,
    "fmu": 9,
    "preset": 5,
    "trajectories": 5,
    "records": 4,
    "study": 3,
    "report": 1,
    "rerun": 1,
    "replay": 4,
    "recover": 3,
    "journal_links": 2,
    "pipes": 2,
    "tables": 4,
    "targets": 2,
    "scenes": 2,
    "booleans": 5,
    "kernels": 0,  # each compiles for a while; giveway/_kernels has its own tests
    "networks": 2,
    "vehicles": 0,  # the base is a run of an isolated FMU; config/files/test_trust.py
}
LONG = ("validate", "doctor", "check")  # commands that draw, or load what nothing else needs

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="cases are forked")


@pytest.fixture(scope="module")
def nursery(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Nursery]:
    with (
        pytest.MonkeyPatch.context() as patch,
        Nursery(tmp_path_factory.mktemp("cache")) as started,
    ):
        patch.setenv("PYTHONOPTIMIZE", "2")  # no assert and no docstring is needed
        yield started


@pytest.fixture(scope="module")
def bases(nursery: Nursery, tmp_path_factory: pytest.TempPathFactory) -> Bases:
    return Bases(tmp_path_factory.mktemp("bases"), nursery)


def of_each_kind(bases: Bases, folder: Path, most: dict[str, int]) -> Iterator[Case]:
    """So many cases of each kind, without those that take long."""
    numbers = count()
    for kind, wanted in most.items():
        made = 0
        while made < wanted:
            number = next(numbers)
            case = make_case(SEED, number, bases, folder / str(number), kind)
            if not set(LONG) & set(map(str, case.words)):
                made += 1
                yield case
            shutil.rmtree(case.folder)


def test_mutated_inputs_of_each_kind_are_met_with_civility(
    nursery: Nursery, bases: Bases, tmp_path: Path
) -> None:
    assert SAMPLE.keys() == KINDS.keys()
    outcomes: Counter[str] = Counter()
    for case in of_each_kind(bases, tmp_path, SAMPLE):
        ended = nursery.type(case.words, case.folder, LIMIT)
        verdict = judge(case, ended, 0.0, bases.study if case.kind == "records" else None)
        assert not verdict.bad, verdict
        outcomes[verdict.outcome] += 1
    assert min(outcomes[word] for word in ("fine", "refused", "recomputed")) > 2, outcomes


def test_what_is_not_mutated_is_not_refused(
    nursery: Nursery, bases: Bases, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(campaign_kinds, "mutate", lambda _, content, __: (content, ""))
    monkeypatch.setattr(campaign_kinds, "_broken", lambda *_: "")
    refused = FOLDER_KINDS.keys() | INPUT_KINDS.keys() | {"kernels"}
    for case in of_each_kind(bases, tmp_path, dict.fromkeys(KINDS.keys() - refused, 1)):
        ended = nursery.type(case.words, case.folder, LIMIT)
        assert ended.code == 0, (case, ended.err)


def test_what_sumo_says_of_types_stays_in_its_log(
    nursery: Nursery, bases: Bases, tmp_path: Path
) -> None:
    town = Path(shutil.copytree(bases.scenarios["town"], tmp_path / "town"))
    config = town / "town.sumocfg"
    config.write_text(
        config.read_text().replace('<step-length value="0.5"', '<step-length value="7.5"')
    )
    words = ("run", config.name, "--no-ego", "--zone", "everywhere", "--time-limit", 1)
    ended = nursery.type((*words, "--no-pictures", "--out", "out"), town, LIMIT)
    assert (ended.code, ended.err) == (0, "")


def test_a_case_is_determined_by_seed_and_number(bases: Bases, tmp_path: Path) -> None:
    def content(seed: int, number: int) -> tuple[object, ...]:
        case = make_case(seed, number, bases, tmp_path / "case")
        files = sorted(f for f in case.folder.rglob("*") if f.is_file())
        return case.words, case.mutations, [(f.name, f.read_bytes()) for f in files]

    assert content(1, 3) == content(1, 3)
    assert content(1, 3) != content(2, 3)


def ended(code: int, err: str = "", out: str = "") -> Ended:
    return Ended(code, out, err)


TRACEBACK = 'Traceback (most recent call last):\n  File "x.py"\nValueError: x\n'


@pytest.mark.parametrize(
    ("end", "outcome"),
    [
        (ended(0), "fine"),
        (ended(0, "x.py:3: RuntimeWarning: overflow\n"), "noise"),
        (ended(2, "error: run.toml: [ego] lane = -1: expected 0\n"), "refused"),
        (ended(2, "note: something\nerror: run.toml: [ego] lane\n"), "refused"),
        (ended(2, "error: one\nerror: two\n"), "noise"),
        (ended(2, "error: \x1b[31mred\n"), "noise"),
        (ended(2, f"error: {'x' * 5000}\n"), "noise"),
        (ended(0, out="\x1b[31mred"), "noise"),
        (ended(0, "note: turned \u202e round\n"), "noise"),
        (ended(1), "mute"),
        (ended(1, TRACEBACK), "traceback"),
        (ended(0, out=TRACEBACK), "traceback"),
        (ended(-ALARM), "hang"),
    ],
)
def test_the_verdict_on_an_end(tmp_path: Path, end: Ended, outcome: str) -> None:
    case = Case(1, "settings", ["run", "--config", "run.toml"], tmp_path, "")
    assert judge(case, end, 0.1, None).outcome == outcome


def test_what_is_not_refused_or_is_written_through_is_wrong(tmp_path: Path) -> None:
    precious = tmp_path / "precious"
    precious.write_text("what is mine\n")
    expected = Expected("ego.csv: has ", precious=precious)
    case = Case(1, "tables", ["replay", "run"], tmp_path, "", expected)
    refused = ended(2, "error: run/ego.csv: has another content\n")
    assert judge(case, refused, 0.1, None).outcome == "refused"
    assert judge(case, ended(0), 0.1, None).outcome == "wrong"
    assert judge(case, ended(2, "error: something else\n"), 0.1, None).outcome == "wrong"
    precious.write_text("a page")
    assert judge(case, refused, 0.1, None).outcome == "wrong"


def test_an_infinite_number_in_a_table_is_nonsense(tmp_path: Path) -> None:
    case = Case(1, "settings", ["run", "--config", "run.toml"], tmp_path, "")
    table = tmp_path / "out" / "ego.csv"
    table.parent.mkdir()
    outcomes = []
    for number in ("1.0", "-inf"):
        table.write_text(f"time,speed,reason\n0.0,{number},information\n")
        outcomes.append(judge(case, ended(0), 0.1, None).outcome)
    assert outcomes == ["fine", "nonsense"]


def test_the_verdict_on_a_resumed_study(tmp_path: Path) -> None:
    original, out = tmp_path / "original", tmp_path / "out"
    for folder in (original, out):
        folder.mkdir()
        for name in (*(f"{table}.csv" for table in TABLES), "study.toml", "manifest.json"):
            (folder / name).write_text("1\n")
    case = Case(1, "records", ["study", "--resume"], tmp_path, "")
    told = ended(0, "note: out/runs.csv: put aside\n")

    def outcomes() -> list[str]:
        return [judge(case, end, 0.1, original).outcome for end in (ended(0), told)]

    assert outcomes() == ["fine", "recomputed"]
    (out / "runs.csv").write_text("2\n")
    assert outcomes() == ["different", "different"]


def test_what_native_code_ends_is_typed_again_as_a_user_does(tmp_path: Path) -> None:
    case = Case(1, "settings", ["config", "--config", "none.toml"], tmp_path, "")
    verdict = judge(case, ended(-signal.SIGSEGV), 0.1, None)
    assert verdict.outcome == "told"
    assert verdict.line.startswith("error: none.toml")
    again = dataclasses.replace(case, words=["--version"])
    assert judge(again, ended(-signal.SIGSEGV), 0.1, None).outcome == "native"


def test_a_nursery_ends_what_hangs_and_goes_on(nursery: Nursery, tmp_path: Path) -> None:
    here = tmp_path / "here"
    here.mkdir()
    words = ["run", "--time-limit", 100, "--no-pictures", "--pedestrians", 200]
    assert nursery.type(words, here, 1).hung
    assert nursery.type(["--version"], here, 60).out.startswith("giveway ")
