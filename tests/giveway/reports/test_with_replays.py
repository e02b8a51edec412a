"""A report whose shown runs are made again."""

from __future__ import annotations

import os
import shutil
import signal
import sys

import pytest

from giveway.reports.with_replays import write_report_of
from giveway.studies.folder import StudyFolder


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
