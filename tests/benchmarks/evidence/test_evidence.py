"""The command that makes the measured blocks of README and docs anew."""

from __future__ import annotations

import ast
import json
import re
import runpy
import sys
from pathlib import Path

import blocks
import digests
import fingerprints
import ledger
import pytest
from pages import PAGES
from tables import FRONTAL, Column, Tables
from work import Command, Study

ROOT = Path(__file__).parents[3]
VERSION = re.compile(r"[Cc]ommit [0-9a-f]{7,10}|[Ss]eeds \d|Not made yet")
PACKAGE = ROOT / "benchmarks" / "evidence"


def measured() -> dict[str, str]:
    """The blocks of README and docs, by file and name."""
    files = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
    return {
        f"{file.relative_to(ROOT)}: {match['name']}": match["text"]
        for file in files
        for match in blocks.BLOCK.finditer(file.read_text(encoding="utf-8"))
        if match["name"] != "NAME"
    }


def test_each_block_has_a_maker_and_each_maker_a_block() -> None:
    made = [f"{page.file}: {block.name}" for page in PAGES.values() for block in page.blocks]
    assert sorted(made) == sorted(measured())


@pytest.mark.parametrize("name", measured())
def test_a_block_says_in_its_first_line_of_which_version_it_is(name: str) -> None:
    assert VERSION.search(measured()[name].splitlines()[0])


@pytest.mark.parametrize("name", PAGES)
def test_what_a_page_runs_is_there(name: str) -> None:
    page = PAGES[name]
    assert len(ledger.page_digest(page)) == 16
    for block in page.blocks:
        if isinstance(block.work, Command):
            assert (ROOT / "benchmarks" / block.work.words.split()[0]).is_file()
        else:
            assert page.kept or block.work.runs <= 60


def test_a_room_that_is_missing_is_an_error() -> None:
    with pytest.raises(FileNotFoundError, match="no_such_room"):
        digests.digest_of(["no_such_room"], "")


def statements(text: str) -> list[str]:
    return list(digests._statements(ast.parse(text)))


def test_a_docstring_is_no_change_of_the_code_but_a_number_is() -> None:
    code = '"""Speed."""\n\ndef f(x):\n    """{}"""\n    return {} * x  # {}\n'
    assert statements(code.format("a", 2, "b")) == statements(code.format("c", 2, "d"))
    assert statements(code.format("a", 2, "b")) != statements(code.format("a", 3, "b"))


def test_a_page_is_stale_until_it_is_entered(tmp_path: Path) -> None:
    page, file = PAGES["install"], tmp_path / "evidence.json"
    assert ledger.is_stale(page, ledger.read_ledger(file))
    ledger.enter(page, 1.25, file)
    entries = ledger.read_ledger(file)
    assert not ledger.is_stale(page, entries)
    assert entries["install"]["minutes"] == 1.2
    seeds = page._replace(blocks=PAGES["gym"].blocks)
    assert ledger.is_stale(seeds, entries)


def test_other_code_with_the_same_drives_can_be_confirmed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page, file = PAGES["pid"], tmp_path / "evidence.json"
    before = dict.fromkeys(fingerprints.RUNS, "of before")
    monkeypatch.setattr(ledger, "drive_digests", lambda: before)
    ledger.enter(page, 1.0, file)
    entries = ledger.read_ledger(file)
    entries["pid"]["digest"] = "of other code"
    file.write_text(json.dumps(entries), encoding="utf-8")
    monkeypatch.setattr(ledger, "drive_digests", lambda: before | {"mpc": "of now"})
    assert ledger.confirm({"pid": page}, file) == []
    monkeypatch.setattr(ledger, "drive_digests", lambda: before | {"junction, walls": "of now"})
    assert ledger.confirm({"pid": page._replace(junctions=True)}, file) == []
    other_samples = page._replace(blocks=page.blocks[:1])
    assert ledger.confirm({"pid": other_samples}, file) == []
    assert ledger.confirm({"pid": page}, file) == ["pid"]
    assert not ledger.is_stale(page, ledger.read_ledger(file))
    assert "same drives at" in ledger.listing({"pid": page}, ledger.read_ledger(file))[1]


def test_each_number_of_a_block_is_in_a_stored_file_as_its_command_wrote_it() -> None:
    expected: dict[str, str] = {}
    for place, text in measured().items():
        page, _, name = place.partition(": ")
        files = blocks.stored_files(Path(page).stem, name, text.splitlines()[1:])
        assert files, f"{place}: nothing in it"
        assert not files.keys() & expected.keys(), f"{place}: another block's file"
        expected |= files
    stored = {file.name: file.read_text("utf-8") for file in blocks.MEASURED.iterdir()}
    differ = {name for name, text in expected.items() if stored.get(name) != text}
    assert not differ, "changed by hand?"
    assert stored.keys() == expected.keys()


def test_a_block_that_is_written_replaces_its_files(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("<!-- evidence: a -->\n*1*\n1\n<!-- end -->\n", encoding="utf-8")
    (tmp_path / "page_a.txt").write_text("1\n", encoding="utf-8")
    table = ["| car | time, s |", "|---|---|", "| `mpc` | 2.5 **+** |", "| a \\| b | |"]
    blocks.write_block(page, "a", [*table, "", "and more"], "Commit abc.", tmp_path)
    stored = {file.name: file.read_text("utf-8") for file in tmp_path.iterdir() if file != page}
    rows = 'car,"time, s"\nmpc,2.5 +\na | b,\n'
    assert stored == {"page_a.csv": rows, "page_a.txt": "and more\n"}
    assert "*Commit abc; [CSV](measured/page_a.csv).*" in page.read_text(encoding="utf-8")


def test_only_the_named_block_of_a_page_is_written() -> None:
    page = "a\n<!-- evidence: x -->\nold\n<!-- end -->\n<!-- evidence: y -->\nkept\n<!-- end -->\n"
    text = blocks.filled(page, "x", ["new"], "Commit 1.")
    assert text.startswith("a\n<!-- evidence: x -->\n*Commit 1.*\n\nnew\n<!-- end -->")
    assert text.endswith("<!-- evidence: y -->\nkept\n<!-- end -->\n")
    with pytest.raises(ValueError, match="no single block <!-- evidence: z -->"):
        blocks.filled(page, "z", ["new"], "")


def test_a_study_goes_on_and_its_table_has_all_columns(tmp_path: Path) -> None:
    factors = {"people": {"few": {"crowd": {"pedestrians": 2}}}, "controller": ["mpc", "pid-tuned"]}
    keys = {"name": "small", "run": {"time_limit": 3.0}, "factors": factors}
    small = Study({**keys, "comparison": {"baseline": "pid-tuned"}}, 3, first_seed=1)
    folder = small.make(tmp_path / "small", 1, quick=False)
    before = (folder / "runs.csv").read_bytes()
    assert small.make(folder, 1, quick=False) == folder
    assert (folder / "runs.csv").read_bytes() == before
    speed = Column("mean_speed", "speed", 1)
    lines = Tables(folder).means([speed, speed._replace(show="less"), FRONTAL])
    assert lines[0] == "| people | controller | speed | speed | frontal |"
    few, again = lines[2:]
    assert few.startswith("| few | mpc | ")
    assert again.startswith("|  | pid-tuned | ")
    assert few.endswith(" | 0 |")


def test_a_command_that_fails_says_what_it_was(tmp_path: Path) -> None:
    failing = Command("tuning/tune_pid.py --no-such-option")
    with pytest.raises(RuntimeError, match=r"tune_pid\.py --no-such-option: .*unrecognized"):
        failing.make(tmp_path, 1, quick=False)
    assert not (tmp_path / "printed.md").exists()


def test_stale_pages_are_listed_and_a_strange_page_is_refused(monkeypatch, capsys) -> None:
    def run(*words: str) -> int:
        monkeypatch.setattr(sys, "argv", ["evidence", *words])
        with pytest.raises(SystemExit) as ended:
            runpy.run_path(str(PACKAGE), run_name="__main__")
        return int(ended.value.code)

    entries = json.loads((ROOT / "docs" / "evidence.json").read_text(encoding="utf-8"))
    expected = [name for name, page in PAGES.items() if ledger.is_stale(page, entries)]
    assert run("--check") == bool(expected)
    assert capsys.readouterr().out.split() == expected
    assert run("no-such-page") == 2
    assert "expected one of cookbook" in capsys.readouterr().err
