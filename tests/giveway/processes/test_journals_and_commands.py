"""Whose journal it is, how long it stays, and how we are started again."""

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import psutil
import pytest

from giveway.processes.heartbeat import Heartbeat
from giveway.processes.locks import in_use
from giveway.processes.supervisor import journal_folder, journals, supervise

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the deaths here are Unix's")


def test_the_folder_of_a_journal_is_gone_afterwards(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    with journal_folder() as folder:
        assert folder.is_dir()
    assert not folder.exists()
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    with journal_folder() as folder:
        assert folder.parent == tmp_path


def test_a_journal_whose_rows_are_nowhere_else_stays(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    with journal_folder() as folder:
        (folder / "rows").touch()
        (folder / "tmp").mkdir()
        assert in_use(folder)
        Heartbeat(folder).keep()
    assert sorted(path.name for path in folder.iterdir()) == ["heartbeat", "rows"]
    assert not in_use(folder)
    assert journals() == [folder]


def test_journals_of_killed_supervisors_do_not_pile_up(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    for name, age in (("giveway-journal-old", 8 * 86400), ("giveway-journal-new", 60)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "rows").touch()
        os.utime(tmp_path / name / "rows", (time.time() - age,) * 2)
    with journal_folder():
        assert not (tmp_path / "giveway-journal-old").exists()
        assert (tmp_path / "giveway-journal-new").exists()


def test_open_files_reach_the_child(tmp_path: Path, journal: Path) -> None:
    """``giveway run --config <(...)`` names a file that only we have open."""
    file = tmp_path / "study.toml"
    file.write_text("seed = 7")
    with file.open() as opened:
        os.set_inheritable(opened.fileno(), True)
        code = f"import os, sys; sys.exit(5 if os.read({opened.fileno()}, 9) == b'seed = 7' else 6)"
        assert supervise([sys.executable, "-c", code], journal).code == 5


def test_supervising_imports_nothing_heavy() -> None:
    code = "import sys, giveway.processes.supervisor; print({m.split('.')[0] for m in sys.modules})"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    for heavy in ("numpy", "numba", "pandas", "typer", "pydantic", "libsumo", "ctypes"):
        assert f"'{heavy}'" not in done.stdout


def test_a_child_that_cannot_be_watched_does_not_stay(
    monkeypatch: pytest.MonkeyPatch, journal: Path
) -> None:
    """It would find its journal gone, and supervise a child of its own, and so on."""

    def no_thread(_: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    before = set(psutil.Process().children())
    monkeypatch.setattr(threading.Thread, "start", no_thread)
    with pytest.raises(OSError, match="Resource temporarily unavailable"):
        supervise([sys.executable, "-c", "import time; time.sleep(60)"], journal)
    assert set(psutil.Process().children()) == before
