"""A run whose process dies: the report, the rows, the exit code, on real processes."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from giveway.api import run_checked
from giveway.config.files.loading import as_layer, load
from giveway.cosimulation.preflight import preflight
from giveway.errors import ResultsError
from giveway.gate import is_own
from giveway.journal.journal import MAGIC, RECORD, Kind, row_type
from giveway.journal.layout import ROWS
from giveway.journal.recorded import RecordedRows
from giveway.processes.heartbeat import Heartbeat
from giveway.processes.locks import locked
from giveway.processes.supervisor import Verdict
from giveway.recovery import recover, recover_left
from giveway.results.folder import Destination

MANY = 600
LONG = ["--pedestrians", str(MANY), "--spawn-area", "20,-200,120,-10", "--no-pictures"]
LONG += ["--desired-speed", "0.1", "--time-limit", "120"]


def start(folder: Path, *words: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "giveway", "run", *words, "--out", "r"],
        cwd=folder,
        env=os.environ | {"TMPDIR": str(folder)},  # the journal, to be watched
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def child_of(process: subprocess.Popen[str]) -> int:
    """The process id of the supervised child."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    if not children.exists():
        pytest.skip("needs Linux's /proc to find the child")
    deadline = time.monotonic() + 60
    while not children.read_text().split():
        assert time.monotonic() < deadline
        time.sleep(0.05)
    return int(children.read_text().split()[0])


def wait_for_the_loop(folder: Path) -> None:
    """Until some steps have been done, however busy the machine is."""
    deadline = time.monotonic() + 200
    while True:
        assert time.monotonic() < deadline
        for journal in folder.glob("giveway-journal-*"):
            with contextlib.suppress(OSError):
                if Heartbeat(journal).read().step > 5:
                    return
        time.sleep(0.05)


def test_a_native_crash_keeps_the_rows_and_says_where_it_was(tmp_path: Path) -> None:
    process = start(tmp_path, *LONG)
    child = child_of(process)
    wait_for_the_loop(tmp_path)
    os.kill(child, signal.SIGSEGV)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 1
    line = errors.strip().splitlines()[-1]
    assert "shared_space.sumocfg" in line
    assert "SIGSEGV" in line
    assert "rows up to then are in" in line
    manifest = json.loads((tmp_path / "r" / "manifest.json").read_text())
    assert manifest["ending"] == "crashed"
    ledger = manifest["pedestrians"]
    assert ledger["added"] == MANY == ledger["arrived"] + ledger["walking"]
    ego = pd.read_csv(tmp_path / "r" / "ego.csv")
    crowd = pd.read_csv(tmp_path / "r" / "trajectories.csv")
    assert len(ego) > 1
    assert (ego["time"].diff().dropna().round(6) == 0.05).all()
    assert set(crowd["time"]) == set(ego["time"])
    summary = json.loads((tmp_path / "r" / "summary.json").read_text())
    assert summary["ending"] == "crashed"


def test_a_crash_before_the_first_row_leaves_nothing_behind(tmp_path: Path) -> None:
    process = start(tmp_path, *LONG)
    child = child_of(process)
    os.kill(child, signal.SIGKILL)
    _, errors = process.communicate(timeout=180)
    assert process.returncode in {1, 128 + signal.SIGKILL}
    assert errors.startswith("error: ")
    assert not (tmp_path / "r").exists()


def test_former_results_survive_a_crash_before_the_first_row(
    type_here: Callable[..., subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    first = type_here("run", "--pedestrians", 0, "--no-pictures", "--out", "r")
    assert first.returncode == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "r").iterdir()}
    process = start(tmp_path, *LONG, "--force")
    os.kill(child_of(process), signal.SIGKILL)
    process.communicate(timeout=180)
    assert {path.name: path.read_bytes() for path in (tmp_path / "r").iterdir()} == before


def test_sigterm_while_loading_is_the_users_and_no_crash(tmp_path: Path) -> None:
    process = start(tmp_path, *LONG)
    child_of(process)
    process.send_signal(signal.SIGTERM)
    _, errors = process.communicate(timeout=180)
    assert process.returncode == 143
    *notes, line = errors.splitlines()
    assert line == "error: ended by SIGTERM before the run began"
    assert all(note.startswith("note: SIGTERM ") for note in notes)  # of a slow start
    assert not (tmp_path / "r").exists()


def test_a_run_that_the_user_has_killed_is_no_crash(tmp_path: Path) -> None:
    """Its native code did not heed the first signal, and the second one killed it."""
    journal = journalled(tmp_path)
    pulse = Heartbeat(journal).read()
    verdict = Verdict(143, True, True, "killed by a second interrupt", pulse, "", "")
    error = recover(journal, verdict)
    assert "the user has ended the run: killed by a second interrupt" in str(error)
    assert "doctor" not in str(error)
    manifest = json.loads((tmp_path / "r" / "manifest.json").read_text())
    assert (manifest["ending"], manifest["error"]) == ("interrupted", None)


def journalled(folder: Path) -> Path:
    """The journal of a run of three persons into r, as SIGKILL leaves it, and r."""
    journal = folder / "giveway-journal-of-a-killed-run"
    journal.mkdir()
    settings = {"crowd": {"pedestrians": 3}, "time_limit": 2.0}
    checked = preflight(*load([as_layer(settings)]))
    run_checked(checked, Destination(folder / "r", pictures=False), journal=journal)
    for file in (folder / "r").iterdir():
        if file.name != "ego.csv":
            file.unlink()
    (folder / "r" / "ego.csv").rename(folder / "whole.csv")
    (folder / "r" / "manifest.json").write_text('{"ending": "running"}\n')
    return journal


def test_what_sigkill_has_left_becomes_tables(
    tmp_path: Path,
    type_here: Callable[..., subprocess.CompletedProcess[str]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    journal = journalled(tmp_path)
    listed = type_here("recover")
    assert f"{journal}  " in listed.stdout
    assert "shared_space: 41 steps, up to" in listed.stdout
    with locked(journal):
        refused = type_here("recover", journal)
    assert refused.returncode == 2
    assert "its run is still at work" in refused.stderr

    done = type_here("recover", journal)
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "r" / "ego.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()
    manifest = json.loads((tmp_path / "r" / "manifest.json").read_text())
    assert manifest["ending"] == "crashed"
    assert "killed, with its supervisor," in manifest["error"]
    assert not journal.exists()
    assert "No run that was killed" in type_here("recover").stdout


def test_a_journal_of_somebody_else_decides_nothing(
    tmp_path: Path,
    type_here: Callable[..., subprocess.CompletedProcess[str]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Neither where the rows go, nor what code is imported; it is not even listed."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    journal = journalled(tmp_path)
    file = journal / "meta.json"
    meta = json.loads(file.read_text())
    assert is_own(meta)
    file.write_text(json.dumps(meta | {"results": str(tmp_path / "precious")}))
    refused = type_here("recover", journal)
    assert "whose folder for the results" in refused.stderr
    (tmp_path / "evil.fmu").write_text("code")
    for mine, theirs in (
        ('controller = "mpc"', 'controller = "own_code:Evil"'),
        ('fmu = "fmi2"', f'fmu = "{tmp_path / "evil.fmu"}"'),
    ):
        assert mine in meta["config"]
        code = meta["config"].replace(mine, theirs)
        file.write_text(json.dumps(meta | {"config": code}))
        assert "it names code" in type_here("recover", journal, "--out", "o").stderr
    os.mkfifo(tmp_path / "giveway-journal-pipe")
    (tmp_path / "giveway-journal-link").symlink_to(tmp_path / "precious")
    assert f"{journal}  " in type_here("recover").stdout
    if os.getuid() == 0:
        os.chown(journal, 12345, 12345)
        assert "No run that was killed" in type_here("recover").stdout
    file.write_text(json.dumps(meta | {"results": str(tmp_path / "precious")}))
    rows = journal / "rows"
    rows.rename(tmp_path / "rows")
    rows.symlink_to(tmp_path / "rows")
    assert "rows: is a link" in type_here("recover", journal, "--out", "o").stderr
    (tmp_path / "rows").replace(rows)
    assert type_here("recover", journal, "--out", "o").returncode == 0
    assert (tmp_path / "o" / "ego.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()
    assert not (tmp_path / "precious").exists()


@pytest.mark.parametrize(
    ("name", "content"),
    [("meta.json", b"[1]"), ("meta.json", b"{"), ("rows", b"giveway0"), ("rows", None)],
)
def test_what_is_no_journal_is_named(
    tmp_path: Path,
    type_here: Callable[..., subprocess.CompletedProcess[str]],
    name: str,
    content: bytes | None,
) -> None:
    (tmp_path / "j").mkdir()
    Heartbeat(tmp_path / "j")
    (tmp_path / "j" / "meta.json").write_text('{"config": "", "results": null}')
    if content is None:  # a row of a table that was never declared
        content = MAGIC + RECORD.pack(Kind.ROWS, 7, 8) + bytes(8) + RECORD.pack(Kind.COMMIT, 0, 0)
    (tmp_path / "j" / name).write_bytes(content)
    done = type_here("recover", "j")
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"error: j/{name}: is ")


@pytest.mark.parametrize(
    "meta", ['{"config": false, "results": null}', '{"config": "", "results": 1}']
)
def test_a_journal_whose_description_is_broken_is_named(
    tmp_path: Path,
    type_here: Callable[..., subprocess.CompletedProcess[str]],
    meta: str,
) -> None:
    (tmp_path / "j").mkdir()
    Heartbeat(tmp_path / "j")
    (tmp_path / "j" / "meta.json").write_text(meta)
    done = type_here("recover", "j")
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: j: holds no journal of a run; 'giveway recover' lists")


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("index", [np.nan, np.inf, 1e300])
def test_rows_whose_indices_are_none_are_not_cast(index: float) -> None:
    rows = {name: np.zeros(0, row_type(columns)) for name, columns in ROWS.items()}
    rows["clock"] = np.zeros(2, row_type(ROWS["clock"]))
    rows["crowd"] = np.zeros(1, row_type(ROWS["crowd"]))
    rows["crowd"]["pedestrian"] = index
    recorded = RecordedRows(rows, {"pedestrians": ("p",)})
    with pytest.raises(ValueError, match="no index"):
        recorded.crowd_track()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a full disk")
def test_a_full_disk_keeps_the_journal_and_a_manifest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal = tmp_path / "journal"
    journal.mkdir()
    real = pd.DataFrame.to_csv

    def full(self: pd.DataFrame, path: Path, **options: object) -> None:
        if path.name == "trajectories.csv":
            path.write_text("half a file")
            path = Path("/dev/full")
        real(self, path, **options)

    monkeypatch.setattr(pd.DataFrame, "to_csv", full)
    checked = preflight(*load([as_layer({"crowd": {"pedestrians": 3}, "time_limit": 2.0})]))
    command = f"'giveway recover {journal} --force'"
    with pytest.raises(
        ResultsError, match=rf"trajectories\.csv: cannot be written \(No space.*{command}"
    ):
        run_checked(checked, Destination(tmp_path / "r", pictures=False), journal=journal)
    assert Heartbeat(journal).kept  # the supervisor leaves it
    assert not (tmp_path / "r" / "trajectories.csv").exists()
    manifest = json.loads((tmp_path / "r" / "manifest.json").read_text())
    assert "trajectories.csv: cannot be written" in manifest["incomplete"]
    monkeypatch.undo()
    result, folder = recover_left(journal, force=True)
    assert (folder, len(result.time)) == (tmp_path / "r", 41)
    assert (folder / "trajectories.csv").is_file()
