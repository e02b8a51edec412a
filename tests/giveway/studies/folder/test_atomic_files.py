"""Files of a study are whole or absent."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from giveway.errors import ResultsError


def test_a_full_disk_keeps_what_is_there(
    study_of, small_study_text, tables_of, tmp_path, monkeypatch
):
    real = Path.replace
    written = []

    def full(self, target):
        if self.parent.parent.name == "records":
            written.append(self)
            if len(written) > 4:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(self))
        return real(self, target)

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(ResultsError, match=r"No space left.*go on with --resume"):
        study_of(small_study_text, tmp_path / "full")
    monkeypatch.undo()
    states = []
    study_of(small_study_text, tmp_path / "full", states.append, resume=True)
    assert states[-1].kept == 4


@pytest.mark.parametrize("name", ["runs.csv", "study.toml", "manifest.json", "datapackage.json"])
def test_a_study_killed_while_writing_a_file_can_be_resumed(
    small_study, study_of, small_study_text, tables_of, tmp_path, monkeypatch, name
):
    import shutil

    class KilledError(BaseException):
        pass

    def killed(self, target):
        if target.name == name:
            raise KilledError
        return real(self, target)

    folder = shutil.copytree(small_study.path, tmp_path / "copy")
    real = Path.replace
    monkeypatch.setattr(Path, "replace", killed)
    with pytest.raises(KilledError):
        study_of(small_study_text, folder, resume=True)
    monkeypatch.undo()
    study_of(small_study_text, folder, resume=True)
    assert tables_of(folder) == tables_of(small_study.path)
