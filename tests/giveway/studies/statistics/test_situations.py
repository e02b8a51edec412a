"""situations.csv: how often both stop, one does, none does; what is lost on the way."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from giveway.studies.statistics import SITUATION_COLUMNS, situations

SHARES = [column.name for column in SITUATION_COLUMNS if column.name.startswith("share_")]


def table(study) -> pd.DataFrame:
    return situations(study.runs, study.design, study.comparison)


def test_shares_of_the_pairs_that_are_not_lost(new_study) -> None:
    study = new_study({"crowd.pedestrians": [30], "controller": ["mpc", "pid"]})
    study.add(30, "mpc", stops=[1, 2, 1, 0, 0], completion_time=[9, 9, 9, np.nan, 9])
    study.add(30, "pid", stops=[1, 1, 0, 0], completion_time=[9, 9, np.nan, np.nan])
    study.lose(30, "pid", seeds=[5])
    (found,) = table(study).to_dict("records")
    assert found == {
        "crowd.pedestrians": 30,
        "ego": "ego",
        "treatment": "mpc",
        "baseline": "pid",
        "pairs": 5,
        "share_both_stop": 0.5,
        "share_neither_stops": 0.25,
        "share_only_treatment_stops": 0.25,
        "share_only_baseline_stops": 0.0,
        "lost": 1,
        "incomplete": 2,
    }


def test_without_the_ego_there_is_no_pair_a_failed_run_loses_it(new_study) -> None:
    study = new_study({"controller": ["mpc", "pid"]})
    study.add("mpc", stops=[0, 0, 0]).add("pid", stops=[0], seeds=[1])
    study.add("pid", stops=[0], seeds=[2], ego="other").lose("pid", seeds=[3])
    (found,) = table(study).to_dict("records")
    assert (found["ego"], found["pairs"], found["lost"]) == ("ego", 2, 1)


def test_where_all_runs_are_lost_there_is_no_share(new_study) -> None:
    study = new_study({"controller": ["mpc", "pid"]})
    study.lose("mpc", seeds=[1, 2], ending="failed").lose("pid", seeds=[1, 2])
    (found,) = table(study).to_dict("records")
    assert (found["ego"], found["pairs"], found["lost"]) == ("", 2, 2)
    assert np.isnan([found[name] for name in SHARES]).all()


def test_no_runs_no_rows(new_study) -> None:
    found = table(new_study({"controller": ["mpc", "pid"]}))
    assert list(found.columns) == [column.name for column in SITUATION_COLUMNS]
    assert found.empty


@given(arrays(np.float64, (2, 20), elements=st.sampled_from([0.0, 1.0, 3.0, np.nan])))
@settings(max_examples=40)
def test_every_pair_is_in_one_situation_or_lost(new_study, stops: np.ndarray) -> None:
    study = new_study({"controller": ["mpc", "pid"]})
    study.add("mpc", stops=stops[0]).add("pid", stops=stops[1])
    (found,) = table(study).to_dict("records")
    assert found["lost"] == np.count_nonzero(np.isnan(stops).any(axis=0))
    if found["lost"] < 20:
        assert sum(found[name] for name in SHARES) == pytest.approx(1.0)
