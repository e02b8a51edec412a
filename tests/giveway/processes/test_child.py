"""The supervised process: it alone takes the journal."""

import sys
from pathlib import Path

import pytest

from giveway.processes.child import JOURNAL_VARIABLE, take_journal_folder

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the deaths here are Unix's")


def test_only_the_supervised_process_takes_the_journal(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    assert take_journal_folder() is None
    monkeypatch.setenv(JOURNAL_VARIABLE, str(tmp_path))
    assert take_journal_folder() == tmp_path
    assert take_journal_folder() is None  # nor do the processes that it starts
    monkeypatch.setenv(JOURNAL_VARIABLE, str(tmp_path / "of a run long gone"))
    assert take_journal_folder() is None
