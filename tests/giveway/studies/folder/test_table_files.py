"""Tables of a study: complete, or said to be of a part."""

from __future__ import annotations

from giveway.studies.folder.study_folder import StudyFolder


def test_a_comparison_of_half_a_study_is_not_taken_for_the_whole(
    small_study, study_of, small_study_text, tables_of, tmp_path
):
    """Somebody has the report written while the study is at work."""
    from giveway.studies.folder.table_files import write_tables

    def look(progress):
        if progress.made == 17:
            write_tables(StudyFolder.open(tmp_path / "out"), whole=True)

    study = study_of(small_study_text, tmp_path / "out", look)
    assert tables_of(study.path) == tables_of(small_study.path)
