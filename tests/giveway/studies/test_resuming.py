"""A study that is interrupted, killed, out of disk or changed goes on, and nothing is lost."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

from giveway.errors import GivewayError, ResultsError
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.study import StudyInterruptedError


def test_an_interrupted_study_goes_on_and_names_another_processor(
    small_study, study_of, small_study_text, tables_of, tmp_path, monkeypatch, capsys
):
    def interrupt(progress):
        if progress.made == 7:
            raise KeyboardInterrupt

    with pytest.raises(StudyInterruptedError, match="7 of 20 runs are kept"):
        study_of(small_study_text, tmp_path / "half", interrupt)
    half = StudyFolder.open(tmp_path / "half")
    assert len(half.records) == 7
    assert len(pd.read_csv(half.path / "runs.csv")) == 7

    states = []
    monkeypatch.setattr("giveway.studies.keeping.processor", lambda: {"name": "Another"})
    whole = study_of(small_study_text, tmp_path / "half", states.append, resume=True)
    told = [line for line in capsys.readouterr().err.splitlines() if "made on another" in line]
    assert [line.partition("; here ")[2] for line in told] == [
        "Another); the bytes are the same (docs/results.md)"
    ]
    assert states[-1].kept == 7
    assert states[-1].made == 13
    assert tables_of(whole.path) == tables_of(small_study.path)


def test_ctrl_c_twice_while_tables_are_made_is_one_line(
    small_study, study_of, small_study_text, tables_of, tmp_path, monkeypatch
):
    import shutil

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    folder = shutil.copytree(small_study.path, tmp_path / "copy")
    monkeypatch.setattr("giveway.studies.study.write_tables", interrupted)
    with pytest.raises(StudyInterruptedError, match="20 of 20 runs are kept"):
        study_of(small_study_text, folder, resume=True)
    monkeypatch.undo()
    assert not StudyFolder.open(folder).complete
    study_of(small_study_text, folder, resume=True)
    assert tables_of(folder) == tables_of(small_study.path)


def test_a_folder_that_has_become_read_only_is_said_in_one_line(
    small_study, study_of, small_study_text, tmp_path, monkeypatch
):
    import shutil

    def read_only(self, missing_ok=False):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(self))

    folder = shutil.copytree(small_study.path, tmp_path / "copy")
    monkeypatch.setattr(Path, "unlink", read_only)
    with pytest.raises(ResultsError, match=r"cannot be removed \(Read-only file system\)"):
        study_of(small_study_text, folder, resume=True)


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGKILL")
def test_a_killed_study_goes_on_where_it_was(small_study, small_study_text, tables_of, tmp_path):
    file = tmp_path / "small.toml"
    file.write_text(small_study_text, encoding="utf-8")
    command = [sys.executable, "-m", "giveway", "study", str(file), "--out", str(tmp_path / "out")]
    command += ["--quiet", "--no-report", "--jobs"]
    child = subprocess.Popen([*command, "2"], start_new_session=True)
    records = tmp_path / "out" / "records"
    deadline = time.monotonic() + 120.0
    while len(list(records.glob("*/*.json"))) < 3:
        assert child.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.01)
    os.kill(child.pid, signal.SIGKILL)
    child.wait()
    made = {path: path.read_bytes() for path in records.glob("*/*.json")}
    assert 3 <= len(made) < 20

    again = [*command, "1", "--resume"]
    done = subprocess.run(again, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert {path: path.read_bytes() for path in made} == made  # none was made again
    ours, theirs = tables_of(tmp_path / "out"), tables_of(small_study.path)
    assert ours.keys() == theirs.keys()
    assert [name for name in ours if ours[name] != theirs[name]] == []


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_a_study_that_is_ended_by_a_signal_says_so_and_tidies_up(small_study_text, tmp_path):
    number = signal.SIGHUP  # and SIGTERM: tests/giveway/processes/test_interrupts.py
    file = tmp_path / "small.toml"
    file.write_text(small_study_text, encoding="utf-8")
    command = [sys.executable, "-m", "giveway", "study", str(file), "--out", "out", "--jobs", "1"]
    with subprocess.Popen(
        [*command, "--quiet"],
        cwd=tmp_path,
        env=os.environ | {"TMPDIR": str(tmp_path)},
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),  # ours may be a CI runner's
    ) as study:
        deadline = time.monotonic() + 120.0
        while not list(tmp_path.glob("giveway-workers-*")):
            assert study.poll() is None
            assert time.monotonic() < deadline
            time.sleep(0.01)
        study.send_signal(number)
        _, errors = study.communicate(timeout=180)
    assert study.returncode == 128 + number
    (line,) = errors.splitlines()
    assert line.startswith(f"error: ended by {number.name}; ")
    assert line.endswith(" of 20 runs are kept in out: go on with --resume")
    assert not list(tmp_path.glob("giveway-workers-*"))


def test_a_record_that_somebody_broke_is_made_again(
    small_study, study_of, small_study_text, tables_of, tmp_path
):
    folder = study_of(small_study_text, tmp_path / "broken").path
    victims = sorted(folder.glob("records/*/*.json"))[:2]
    victims[0].write_text('{"run": "c1-s1"', encoding="utf-8")
    victims[1].unlink()
    (victims[0].parent / "left-over.new").write_text("half")
    states = []
    study_of(small_study_text, folder, states.append, resume=True)
    assert states[-1].made == 2
    assert tables_of(folder) == tables_of(small_study.path)


def test_more_seeds_can_be_added_later(study_of, small_study_text, tmp_path):
    few = small_study_text.replace("replications = 5", "replications = 2")
    folder = study_of(few, tmp_path / "grown").path
    states = []
    grown = study_of(few.replace("= 2\n[run]", "= 4\n[run]"), folder, states.append, resume=True)
    assert (states[-1].kept, states[-1].made) == (8, 8)
    assert len(grown.runs) == 16


def test_a_cluster_that_is_not_there_costs_nothing(
    small_study, study_of, small_study_text, tmp_path, monkeypatch
):
    import shutil

    monkeypatch.setattr("giveway.studies.execution.cluster._CONNECT", 0.5)
    folder = shutil.copytree(small_study.path, tmp_path / "kept")
    before = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    with pytest.raises(GivewayError, match="cannot be reached"):
        study_of(small_study_text, folder, resume=True, jobs=None, cluster="tcp://127.0.0.1:1")
    after = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    assert before == after
