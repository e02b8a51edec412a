"""A run of the Python API that is killed: the next one removes what it has left."""

import os
import signal
import subprocess
import sys
import tempfile

import pytest

import giveway
from fmus.archive import own_folder
from giveway.api import running
from giveway.replays.run_folder import RunFolder
from giveway.run_data.progress import Ending

SETTINGS = {"crowd": {"pedestrians": 0}, "time_limit": 0.3}
KILLED = f"""
import os, signal, giveway
giveway.run({SETTINGS}, watcher=lambda _: os.kill(os.getpid(), signal.SIGKILL))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such locks")
def test_the_scratch_folders_of_a_killed_run_are_swept_at_the_next_start(tmp_path, monkeypatch):
    killed = subprocess.run(
        [sys.executable, "-c", KILLED], env=os.environ | {"TMPDIR": str(tmp_path)}, check=False
    )
    assert killed.returncode == -signal.SIGKILL
    assert len(list(tmp_path.iterdir())) == 2  # for SUMO and for the FMU
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(own_folder, "_swept", set())
    giveway.run(SETTINGS)
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_right_after_the_folder_was_taken_leaves_whole_results(tmp_path, monkeypatch):
    written = running.dump_toml

    def interrupted(config):
        signal.raise_signal(signal.SIGINT)
        return written(config)

    monkeypatch.setattr(running, "dump_toml", interrupted)
    result = giveway.run(SETTINGS, results=tmp_path / "out", pictures=False)
    assert result.ending is Ending.INTERRUPTED
    assert RunFolder.read(tmp_path / "out").seal_note == ""
