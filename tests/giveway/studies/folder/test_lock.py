"""The lock of a study's folder: one process works on it."""

from __future__ import annotations

import pytest

from giveway.errors import ResultsError


def test_two_processes_do_not_work_on_one_study(study_of, small_study_text, tmp_path):
    def second(progress):
        if progress.made == 1:
            with pytest.raises(ResultsError, match="another giveway study is at work"):
                study_of(small_study_text, tmp_path / "one", resume=True)

    study_of(small_study_text.replace("= 5", "= 1"), tmp_path / "one", second)
