"""The folder of a study belongs to this study alone."""

from __future__ import annotations

import pytest

from giveway.errors import ResultsError
from giveway.studies.folder.study_folder import StudyFolder


def test_a_study_is_not_overwritten_unasked(small_study, study_of, small_study_text):
    with pytest.raises(ResultsError, match="a study is there; go on with it by --resume"):
        study_of(small_study_text, small_study.path)


def test_a_folder_with_somebody_elses_files_is_left_alone(study_of, small_study_text, tmp_path):
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(ResultsError, match=r"holds 'thesis\.tex'"):
        study_of(small_study_text, tmp_path, force=True)
    assert list(tmp_path.iterdir()) == [tmp_path / "thesis.tex"]


def test_definition_and_manifest_of_two_studies_are_not_mixed(
    study_of, small_study_text, tmp_path, monkeypatch
):
    folder = study_of(small_study_text.replace("= 5", "= 1"), tmp_path / "mixed").path
    text = (folder / "study.toml").read_text(encoding="utf-8")
    (folder / "study.toml").write_text(text.replace("[3, 2]", "[2, 3]"), encoding="utf-8")
    with pytest.raises(
        ResultsError, match=r"study\.toml.*manifest\.json is about another.*--resume"
    ):
        StudyFolder.open(folder)


def test_another_study_does_not_go_on_in_this_folder(study_of, small_study_text, small_study):
    other = small_study_text.replace('"small"', '"other"')
    with pytest.raises(ResultsError, match="holds the study 'small'; expected 'other'"):
        study_of(other, small_study.path, resume=True)


def test_a_note_beside_a_study_does_no_harm(small_study, study_of, small_study_text, tmp_path):
    import shutil

    folder = shutil.copytree(small_study.path, tmp_path / "noted")
    (folder / "note.txt").touch()
    study_of(small_study_text, folder, resume=True)
    with pytest.raises(ResultsError, match=r"holds 'note\.txt'"):
        study_of(small_study_text, folder, force=True)
    assert (folder / "note.txt").is_file()
