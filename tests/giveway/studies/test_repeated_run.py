"""Which run is which: keys, cells and ids, and a run that is made again."""

from __future__ import annotations

import pandas as pd
import pytest

from giveway.errors import ResultsError
from giveway.results.folder import Destination
from giveway.studies.folder.store import RecordStore
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.identity import software_identity
from giveway.studies.repeated_run import OtherNumbersError, rerun


def test_a_rerun_gives_the_studys_row_and_all_trajectories(small_study, tmp_path):
    result = rerun(small_study, "c3-s2", Destination(tmp_path / "again", pictures=False))
    assert len(result.egos) == 1
    summary = pd.read_csv(tmp_path / "again" / "summary.csv").iloc[0]
    row = pd.read_csv(small_study.path / "runs.csv").set_index("run").loc["c3-s2"]
    shared = [name for name in summary.index if name in row.index]
    assert len(shared) > 15
    pd.testing.assert_series_equal(summary[shared], row[shared], check_names=False)
    assert (tmp_path / "again" / "trajectories.csv").stat().st_size > 1000


def test_a_rerun_with_other_numbers_says_which(small_study, study_of, small_study_text, tmp_path):
    study = study_of(small_study_text.replace("= 5", "= 1"), tmp_path / "forged")
    store = RecordStore(study.path, software_identity())
    record = study.record("c1-s1")
    import dataclasses

    rows = ({**record.rows[0], "mean_speed": 3.21},)
    store.put(dataclasses.replace(record, rows=rows))
    with pytest.raises(OtherNumbersError, match=r"mean_speed = .* where .* has 3\.21"):
        rerun(StudyFolder.open(study.path), "c1-s1")


def test_the_folder_names_the_cells_as_they_were_run(study_of, tmp_path):
    """A named factor stands first: the file that keeps the study must not move it."""
    text = """
        name = "order"
        replications = 1
        [run]
        time_limit = 0.5
        [factors.crowd_of]
        "two" = { crowd = { pedestrians = 2 } }
        "one" = { crowd = { pedestrians = 1 } }
        [factors]
        controller = ["mpc-paper", "pid-paper"]
    """
    study = study_of(text, tmp_path / "order")
    rows = study.runs.set_index("run")
    for name, crowd, controller in (
        ("c2-s1", "two", "pid-paper"),
        ("c3-s1", "one", "mpc-paper"),
    ):
        assert (rows["crowd_of"][name], rows["controller"][name]) == (crowd, controller)
        again = rerun(study, name)
        assert again.config.controller == controller
        assert again.config.crowd.pedestrians == {"two": 2, "one": 1}[crowd]


@pytest.mark.parametrize("run", ["c9-s1", "c01-s1", "1-s1", "c1-s99", "c1", "17", "", "c1-s-1"])
def test_a_run_that_is_not_in_the_study(small_study, run):
    with pytest.raises(ResultsError, match="expected c<cell>-s<seed>, c1-s1 to c4-s5"):
        rerun(small_study, run)
