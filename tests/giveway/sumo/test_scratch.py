"""The folder that a session writes into: its own, or one that a worker keeps."""

import tempfile
from pathlib import Path

import pytest

from giveway.sumo import scratch


@pytest.fixture(autouse=True)
def _nothing_kept(monkeypatch, tmp_path):
    monkeypatch.setattr(scratch, "_kept", [])
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


def test_each_session_has_a_folder_of_its_own_which_goes_with_it():
    first, second = scratch.scratch(), scratch.scratch()
    assert first.name != second.name
    first.cleanup()
    second.cleanup()
    assert not Path(first.name).exists()


def test_a_worker_keeps_one_folder_that_sessions_leave_empty():
    scratch.keep_scratch()
    first = scratch.scratch()
    folder = Path(first.name)
    (folder / "giveway.add.xml").write_text("<additional/>")
    (folder / "outputs" / "deep").mkdir(parents=True)
    (folder / "outputs" / "deep" / "fcd.xml").touch()
    first.cleanup()
    scratch.keep_scratch()
    second = scratch.scratch()
    assert Path(second.name) == folder
    assert list(folder.iterdir()) == []
