"""Every level's own means."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.studies.statistics import LEVEL_COLUMNS, METRICS, levels
from giveway.studies.statistics.bootstrap import mean_interval, seed_of


@pytest.fixture
def table(new_study):
    """Two controllers in crowds of 30 and 10; runs that have no number, or no result."""
    made = new_study({"crowd.pedestrians": [30, 10], "controller": ["mpc-paper", "pid-paper"]})
    made.add(30, "mpc-paper", completion_time=[10.0, 12.0, 17.0], stops=[0, 1, 2])
    made.add(30, "pid-paper", completion_time=[11.0, np.nan, 13.0, 12.0])
    made.add(10, "pid-paper", completion_time=[9.0, 9.0], overlaps=[0, 0])
    made.add(10, "pid-paper", completion_time=[99.0], seeds=[3], ending="failed")
    return levels(made.runs, made.design, made.comparison)


def row_of(table, pedestrians, controller, metric):
    wanted = (table["crowd.pedestrians"] == pedestrians) & (table["controller"] == controller)
    rows = table[wanted & (table["metric"] == metric)]
    assert len(rows) == 1
    return rows.iloc[0]


def test_a_row_per_cell_and_metric_in_the_order_of_the_design(table):
    names = [column.name for column in LEVEL_COLUMNS]
    assert list(table.columns) == ["crowd.pedestrians", "controller", *names]
    cells = [(30, "mpc-paper"), (30, "pid-paper"), (10, "pid-paper")]
    expected = [(*cell, metric.name) for cell in cells for metric in METRICS]
    assert list(zip(*(table[c] for c in (*table.columns[:2], "metric")), strict=True)) == expected


def test_mean_extremes_and_the_interval_of_the_bootstrap(table):
    row = row_of(table, 30, "mpc-paper", "completion_time")
    assert (row["runs"], row["n"], row["mean"], row["unit"]) == (3, 3, 13.0, "s")
    assert (row["smallest"], row["largest"]) == (10.0, 17.0)
    names = ("crowd.pedestrians = 30, controller = mpc-paper", "ego", "completion_time")
    found = mean_interval(
        np.array([10.0, 12.0, 17.0]), confidence=0.95, resamples=199, seed=seed_of(names)
    )
    assert (row["ci_low"], row["ci_high"]) == pytest.approx((found.low, found.high), abs=1e-6)
    assert 10.0 <= row["ci_low"] < 13.0 < row["ci_high"] <= 17.0


def test_runs_without_the_number_count_as_runs_only(table):
    row = row_of(table, 30, "pid-paper", "completion_time")
    assert (row["runs"], row["n"], row["mean"]) == (4, 3, 12.0)


def test_runs_without_a_result_do_not_count_few_have_no_interval(table):
    row = row_of(table, 10, "pid-paper", "completion_time")
    assert (row["runs"], row["n"], row["mean"], row["interval"]) == (2, 2, 9.0, "")
    assert np.isnan(row["ci_low"])


def test_what_never_varies_has_an_interval_of_no_width(table):
    row = row_of(table, 30, "mpc-paper", "overlaps")
    assert (row["mean"], row["ci_low"], row["ci_high"], row["interval"]) == (0, 0, 0, "constant")


def test_a_context_that_is_left_out_changes_no_other_row(new_study):
    factors = {"crowd.pedestrians": [30, 10], "controller": ["mpc-paper", "pid-paper"]}
    one, two = new_study(factors), new_study(factors)
    for made in (one, two):
        made.add(10, "pid-paper", completion_time=[9.0, 10.0, 14.0])
    two.add(30, "mpc-paper", completion_time=[1.0, 2.0, 3.0])
    rows = [
        row_of(levels(made.runs, made.design, made.comparison), 10, "pid-paper", "completion_time")
        for made in (one, two)
    ]
    assert rows[0].equals(rows[1])


def test_every_ego_has_its_own_rows(new_study):
    made = new_study({"controller": ["mpc-paper", "pid-paper"]})
    made.add("mpc-paper", completion_time=[1.0, 2.0, 3.0], ego="a")
    made.add("mpc-paper", completion_time=[5.0, 6.0, 7.0], ego="b")
    found = levels(made.runs, made.design, made.comparison)
    means = found[found["metric"] == "completion_time"].set_index("ego")["mean"]
    assert means.to_dict() == {"a": 2.0, "b": 6.0}


def test_without_any_run_the_table_has_its_columns(new_study):
    made = new_study({"controller": ["mpc-paper", "pid-paper"]})
    found = levels(made.runs, made.design, made.comparison)
    assert found.empty
    assert "mean" in found.columns
