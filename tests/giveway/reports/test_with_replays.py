"""A report whose shown runs are made again."""

from __future__ import annotations

import json
import os
import shutil
import signal
import sys

import pytest

from giveway.errors import ConfigError
from giveway.gate import signed
from giveway.reports import with_replays
from giveway.reports.report_page import shown_runs
from giveway.reports.with_replays import write_report_of
from giveway.studies.folder.study_folder import StudyFolder


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_report_shows_no_run_that_was_cut_off(
    small_study, tmp_path, monkeypatch, number
):
    from giveway.cosimulation import loop

    folder = shutil.copytree(small_study.path, tmp_path / "copy")
    (folder / "report.html").unlink(missing_ok=True)
    before = signal.signal(number, signal.default_int_handler)
    real = loop.Loop.run

    def told_to_end(self, watcher, interrupt):
        os.kill(os.getpid(), number)
        return real(self, watcher, interrupt)

    monkeypatch.setattr(loop.Loop, "run", told_to_end)
    try:
        with pytest.raises(KeyboardInterrupt):
            write_report_of(StudyFolder.open(folder))
    finally:
        signal.signal(number, before)
    assert not (folder / "report.html").exists()


@pytest.fixture
def made(monkeypatch):
    """The runs that are made again, in their order."""
    found = []

    def rerun(study, run, *args, **options):
        found.append(run)
        return real(study, run, *args, **options)

    real = with_replays.rerun
    monkeypatch.setattr(with_replays, "rerun", rerun)
    return found


@pytest.mark.usefixtures("unpictured")
def test_a_report_makes_each_run_once_and_the_next_one_none(
    small_study, tmp_path, made, monkeypatch
):
    folder = shutil.copytree(small_study.path, tmp_path / "copy")
    shutil.rmtree(folder / "replays", ignore_errors=True)
    study, told = StudyFolder.open(folder), []
    runs = shown_runs(study)
    page = write_report_of(study, tell=told.append)
    first = {path.name: path.read_bytes() for path in (folder / "replays").iterdir()}
    assert made == runs
    steps = [f"Making run {run} again for its replay, {k} of {len(runs)}"
             for k, run in enumerate(runs, start=1)]  # fmt: skip
    assert [line.startswith(step) for line, step in zip(told, steps, strict=False)] == [True] * len(
        runs
    )
    assert told[len(runs) :] == ["Drawing the figures ..."]
    report = page.read_bytes()
    made.clear()
    write_report_of(StudyFolder.open(folder))
    assert made == []
    assert page.read_bytes() == report
    assert {path.name: path.read_bytes() for path in (folder / "replays").iterdir()} == first

    # What is damaged, or belongs to another record, is made again; what is not shown goes.
    (folder / "replays" / f"{runs[0]}.html").write_text("cut off")
    (folder / "replays" / f"{runs[1]}.npz").unlink()
    listed = json.loads((folder / "replays" / "kept.json").read_text())
    listed[runs[2]]["record"] = "another"
    del listed["maker"]
    (folder / "replays" / "kept.json").write_text(json.dumps(signed(listed)))
    (folder / "replays" / "c9-s9.html").write_text("of a former report")
    write_report_of(StudyFolder.open(folder))
    assert made == runs[:3]
    assert page.read_bytes() == report
    assert {path.name: path.read_bytes() for path in (folder / "replays").iterdir()} == first

    # Pages run scripts: without the user's signature they are made again, or not shown.
    made.clear()
    listed = json.loads((folder / "replays" / "kept.json").read_text())
    (folder / "replays" / "kept.json").write_text(json.dumps(listed | {"maker": "0" * 64}))

    def refused(*_, **__):
        raise ConfigError("study.toml: somebody else's results folder names code")

    monkeypatch.setattr(with_replays, "checked_run", refused)
    warned = []
    page = write_report_of(StudyFolder.open(folder), warn=warned.append)
    assert made == []
    (line,) = warned
    assert line.startswith(f"{len(runs)} of {len(runs)} shown runs have no replay: study.toml: ")
    assert "replays/" not in page.read_text()
