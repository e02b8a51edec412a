"""Table 2 of the paper beside ours."""

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_array_equal

from giveway.studies.statistics import PUBLISHED, TABLE_2_COLUMNS, compare, table2


def ours(study) -> pd.DataFrame:
    return table2(compare(study.runs, study.design, study.comparison))


def paper_study(new_study, **more):
    return new_study(
        {"crowd.pedestrians": [10, 30], "controller": ["mpc-paper", "pid-paper"]}, **more
    )


PRINTED = """
30 & -1.2665 & -1.9457 & -0.9843
20 & -0.5243 & -1.8338 & -0.7630
10 & -0.4153 & N.A.    & -0.5394
"""


def test_nine_numbers_as_printed() -> None:
    numbers = PRINTED.replace("N.A.", "nan").replace("&", " ").split()
    rows = np.array(numbers, dtype=float).reshape(3, 4)
    assert [pedestrians for pedestrians, _ in PUBLISHED] == list(np.repeat(rows[:, 0], 3))
    assert_array_equal(list(PUBLISHED.values()), rows[:, 1:].ravel())


def test_each_number_stands_beside_the_same_one_of_ours(new_study) -> None:
    study = paper_study(new_study)
    for pedestrians, shift in ((30, -1.25), (10, 0.5)):
        noise = np.random.default_rng(pedestrians).normal(0.0, 0.1, 40)
        study.add(pedestrians, "mpc-paper", completion_time=20.0 + shift + noise - noise.mean())
        study.add(pedestrians, "pid-paper", completion_time=np.full(40, 20.0))
    found = ours(study)
    assert list(found.columns) == [column.name for column in TABLE_2_COLUMNS]
    assert list(found["pedestrians"]) == [30] * 3 + [20] * 3 + [10] * 3
    assert list(found["metric"]) == ["completion_time", "longest_wait", "completion_time"] * 3
    general = found[found["situation"] == "general"].set_index("pedestrians")
    assert list(general["agreement"]) == ["inside", "", "below"]
    assert list(general["n"]) == [40, 0, 40]
    assert list(general["verdict"]) == ["better", "N.A.", "worse"]
    assert general.loc[30, "published"] == -1.2665


def test_other_factors_and_egos_have_a_table_each(new_study) -> None:
    factors = {
        "crowd.pedestrians": [30],
        "speed": {"a": {}, "b": {}},
        "controller": ["mpc-paper", "pid-paper"],
    }
    study = new_study(factors)
    for speed in ("a", "b"):
        for controller in ("mpc-paper", "pid-paper"):
            study.add(30, speed, controller, completion_time=[1.0, 2.0, 3.0])
    found = ours(study)
    assert list(found["speed"]) == ["a"] * 9 + ["b"] * 9


def test_of_few_pairs_there_is_a_mean_without_an_interval(new_study) -> None:
    study = paper_study(new_study, comparison={"minimum_pairs": 30})
    study.add(30, "mpc-paper", completion_time=[11.0, 12.0, 13.0])
    study.add(30, "pid-paper", completion_time=[12.0, 13.0, 15.0])
    found = ours(study).set_index(["pedestrians", "situation"]).loc[(30, "general")]
    assert found["mean_difference"] == pytest.approx(-4.0 / 3.0)
    assert np.isnan(found["ci_low"])
    assert (found["n"], found["verdict"], found["agreement"]) == (3, "N.A.", "")


def test_another_study_has_no_such_table(new_study) -> None:
    plain = new_study({"controller": ["mpc-paper", "pid-paper"]})
    plain.add("mpc-paper", stops=[1, 1, 1]).add("pid-paper", stops=[1, 1, 1])
    assert ours(plain).empty
    turned = paper_study(new_study, comparison={"baseline": "mpc-paper"})
    turned.add(30, "mpc-paper", stops=[1, 1, 1]).add(30, "pid-paper", stops=[1, 1, 1])
    assert ours(turned).empty
