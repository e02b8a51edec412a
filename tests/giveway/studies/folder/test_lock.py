"""The lock of a study's folder: one process works on it."""

from __future__ import annotations

import pytest

from giveway.errors import ResultsError
from giveway.studies.folder.lock import reserved
from giveway.studies.study_options import StudyOptions


def test_two_processes_do_not_work_on_one_study(study_of, small_study_text, tmp_path):
    def second(progress):
        if progress.made == 1:
            with pytest.raises(ResultsError, match="another giveway study is at work"):
                study_of(small_study_text, tmp_path / "one", resume=True)

    study_of(small_study_text.replace("= 5", "= 1"), tmp_path / "one", second)


def test_a_lock_that_is_a_link_is_not_opened(tmp_path):
    (tmp_path / "study").mkdir()
    (tmp_path / "precious").write_text("mine")
    (tmp_path / "study" / ".lock").symlink_to(tmp_path / "precious")
    with (
        pytest.raises(ResultsError, match=r"\.lock: is a link"),
        reserved(tmp_path / "study", "small", StudyOptions()),
    ):
        pass
    assert (tmp_path / "precious").read_text() == "mine"
