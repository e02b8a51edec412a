"""comparison.csv: pairs, situations, what a pair needs to count, when something is better."""

import io
import warnings

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose
from pandas.testing import assert_frame_equal

from giveway.errors import ConfigError
from giveway.studies.statistics import COMPARISON_COLUMNS, METRICS, compare

NUMBERS = [column.name for column in COMPARISON_COLUMNS if column.type == "number"]
TESTED = [name for name in NUMBERS if name != "share"]


def rows(study, **chosen) -> pd.DataFrame:
    frame = compare(study.runs, study.design, study.comparison)
    for name, value in chosen.items():
        frame = frame[frame[name] == value]
    return frame.reset_index(drop=True)


def row(study, metric: str = "completion_time", situation: str = "general") -> pd.Series:
    (found,) = rows(study, metric=metric, situation=situation).to_dict("records")
    return pd.Series(found)


def test_difference_is_treatment_minus_baseline_seed_by_seed(new_study) -> None:
    study = new_study({"controller": ["mpc", "pid"]})
    study.add("mpc", completion_time=[10.0, 20.0, 31.0])
    study.add("pid", completion_time=[35.0, 21.0, 12.0], seeds=[3, 2, 1])
    found = row(study)
    assert (found.treatment, found.baseline, found.n, found.unit) == ("mpc", "pid", 3, "s")
    assert found.mean_difference == round(-7 / 3, 6)
    assert found.median_difference == -2.0
    assert found.treatment_mean == round(61 / 3, 6)
    assert found.baseline_mean == round(68 / 3, 6)
    assert found.wilcoxon_statistic == 0.0
    assert found.p_value == 0.25


def test_a_row_for_every_metric_and_situation_in_a_fixed_order(two_controllers) -> None:
    study = two_controllers({"stops": [0, 1, 1]}, {"stops": [0, 1, 0]})
    found = rows(study)
    assert list(found.columns) == [column.name for column in COMPARISON_COLUMNS]
    assert list(found["metric"]) == [metric.name for metric in METRICS] * 4
    situations = ["general", "stop-and-wait", "non-stop", "slowed"]
    assert list(found["situation"].unique()) == situations


def test_situations_are_the_papers(two_controllers) -> None:
    """Stop-and-wait: both stopped; non-stop: neither did; general: all."""
    treated = {"stops": [1, 1, 1, 0, 0, 2], "longest_wait": [4, 5, 6, 0, 0, 7]}
    based = {"stops": [1, 2, 0, 0, 1, 1], "longest_wait": [5, 8, 0, 0, 9, 8]}
    study = two_controllers(treated, based)
    assert row(study, "longest_wait", "stop-and-wait").n == 3
    assert row(study, "longest_wait", "stop-and-wait").mean_difference == round(-5 / 3, 6)
    assert row(study, "longest_wait", "stop-and-wait").share == 0.5
    assert row(study, "longest_wait", "non-stop").n == 1
    assert row(study, "longest_wait").n == 6


def test_slowed_pairs_leave_out_those_that_nobody_slowed(two_controllers) -> None:
    treated = {"slowed": [True, False, False, True], "completion_time": [12.0, 10.0, 10.5, 15.0]}
    based = {"slowed": [True, True, False, False], "completion_time": [13.0, 11.0, 10.0, 10.0]}
    study = two_controllers(treated, based)
    assert row(study, "completion_time").n == 4
    found = row(study, "completion_time", "slowed")
    assert (found.n, found.share) == (3, 0.75)
    assert found.mean_difference == 1.0


def test_slowed_pairs_correct_no_other_test(two_controllers) -> None:
    """What the tests over all pairs come to depends on the first three situations alone."""
    rng = np.random.default_rng(3)
    values = {name: rng.normal(10.0, 1.0, 12) for name in ("completion_time", "rms_jerk")}
    worse = {name: numbers + 0.4 for name, numbers in values.items()}
    all_slowed = {"slowed": [True] * 12}
    with_them = rows(two_controllers(values | all_slowed, worse | all_slowed))
    without = rows(two_controllers(values, worse))
    general = [frame[frame["situation"] != "slowed"] for frame in (with_them, without)]
    assert np.isfinite(general[0]["q_value"]).any()
    assert np.array_equal(general[0]["q_value"], general[1]["q_value"], equal_nan=True)
    slowed = with_them[with_them["situation"] == "slowed"]
    assert np.isfinite(slowed["q_value"]).any()


def test_a_pair_counts_where_both_sides_have_a_number(two_controllers) -> None:
    treated = {"minimum_ttc": [1.0, np.nan, 3.0, 4.0, 5.0]}
    based = {"minimum_ttc": [1.0, 2.0, np.nan, 2.0, 4.0]}
    found = row(two_controllers(treated, based), "minimum_ttc")
    assert (found.n, found.share, found.mean_difference) == (3, 1.0, 1.0)


def test_failed_runs_take_their_pairs_away_for_every_ego(new_study) -> None:
    study = new_study({"controller": ["mpc", "pid"]})
    for ego in ("a", "b"):
        study.add("mpc", completion_time=[1.0] * 5, ego=ego)
        study.add("pid", completion_time=[3.0] * 4, ego=ego)
    study.lose("pid", seeds=[5], ending="failed")
    found = rows(study, metric="completion_time", situation="general")
    assert list(found["ego"]) == ["a", "b"]
    assert list(found["n"]) == [4, 4]


def test_too_few_pairs_are_not_available(two_controllers) -> None:
    study = two_controllers({"stops": [1, 0, 1]}, {"stops": [0, 0, 1]}, minimum_pairs=4)
    found = row(study, "stops")
    assert (found.n, found.share, found.verdict, found.interval) == (3, 1.0, "N.A.", "")
    means = {"treatment_mean", "baseline_mean", "mean_difference", "median_difference"}
    assert found[[name for name in TESTED if name not in means]].isna().all()
    assert found.mean_difference == pytest.approx(1 / 3, abs=1e-6)


def test_controllers_that_do_the_same_show_no_difference(two_controllers) -> None:
    same = {"completion_time": [10.0, 12.5, 11.0]}
    found = row(two_controllers(same, same))
    assert (found.ci_low, found.ci_high, found.interval) == (0.0, 0.0, "constant")
    assert (found.p_value, found.q_value, found.verdict) == (1.0, 1.0, "no difference shown")


def test_equal_differences_share_a_rank_despite_rounding(two_controllers) -> None:
    """0.3 - 0.1 and 0.4 - 0.2 are not the same number in binary; to six decimals they are."""
    treated = {"total_wait": [0.3, 0.4, 1.2, 9.95]}
    based = {"total_wait": [0.1, 0.2, 1.0, 9.75]}
    found = row(two_controllers(treated, based), "total_wait")
    assert (found.interval, found.ci_low, found.median_difference) == ("constant", 0.2, 0.2)


@pytest.mark.parametrize(
    ("metric", "verdict"), [("completion_time", "better"), ("minimum_clearance", "worse")]
)
def test_smaller_is_better_for_times_and_worse_for_distances(
    two_controllers, metric: str, verdict: str
) -> None:
    noise = np.random.default_rng(1).normal(size=100)
    study = two_controllers({metric: noise - 1.0}, {metric: np.zeros(100)})
    assert row(study, metric).verdict == verdict


def test_what_many_tests_find_by_chance_is_not_shown(two_controllers) -> None:
    """p < 0.05 alone is no finding among as many tests as there are rows."""
    noise = np.random.default_rng(5).normal(size=100)
    noise += 0.23 - noise.mean()
    study = two_controllers({"rms_jerk": noise}, {"rms_jerk": np.zeros(100)})
    found = row(study, "rms_jerk")
    assert found.p_value < 0.05 < found.q_value
    assert found.ci_low > 0.0
    assert found.verdict == "no difference shown"


def test_no_verdict_where_most_pairs_and_the_mean_disagree(two_controllers) -> None:
    """Slightly faster in 170 runs, stuck for long in 30: faster? slower? neither is shown."""
    spread = np.linspace(0.0, 1e-3, 200)
    difference = np.where(np.arange(200) < 170, -0.4, 60.0) + spread
    study = two_controllers({"completion_time": difference}, {"completion_time": np.zeros(200)})
    found = row(study)
    assert found.ci_low > 0.0 > found.median_difference
    assert found.q_value < 0.05
    assert found.verdict == "no difference shown"


def test_each_level_is_compared_with_the_baseline_everywhere(new_study) -> None:
    factors = {"crowd.pedestrians": [30, 10], "gains": {"low": {}, "off": {}, "high": {}}}
    comparison = {"factor": "gains", "baseline": "off", "resamples": 99, "minimum_pairs": 3}
    study = new_study(factors, comparison=comparison)
    for pedestrians in (30, 10):
        for name, time in (("low", 11.0), ("off", 10.0), ("high", 10.0 + pedestrians)):
            study.add(pedestrians, name, completion_time=[time] * 3)
    found = rows(study, metric="completion_time", situation="general")
    assert list(found["crowd.pedestrians"]) == [30, 30, 10, 10]
    assert list(found["treatment"]) == ["low", "high"] * 2
    assert list(found["mean_difference"]) == [1.0, 30.0, 1.0, 10.0]


def test_cells_without_a_partner_have_no_row(new_study) -> None:
    cells = [("a", "mpc"), ("a", "pid"), ("b", "mpc"), ("c", "pid")]
    study = new_study(
        {"place": {"a": {}, "b": {}, "c": {}}, "controller": ["mpc", "pid"]},
        cells=[{"place": place, "controller": name} for place, name in cells],
    )
    for place, name in cells:
        study.add(place, name, completion_time=[1.0, 2.0, 3.0])
    assert set(rows(study)["place"]) == {"a"}


def test_seeds_without_a_partner_do_not_count(new_study) -> None:
    study = new_study({"controller": ["mpc", "pid"]})
    study.add("mpc", completion_time=[1.0] * 4, seeds=[1, 2, 3, 4])
    study.add("pid", completion_time=[2.0] * 4, seeds=[3, 4, 5, 6])
    assert row(study).n == 2


@pytest.mark.parametrize("lost", [False, True])
def test_nothing_to_compare(new_study, lost: bool) -> None:
    """No run at all gives a table without rows; runs that all failed give N.A. everywhere."""
    study = new_study({"controller": ["mpc", "pid"]})
    if lost:
        study.lose("mpc", seeds=range(1, 9)).lose("pid", seeds=range(1, 9))
    found = rows(study)
    assert list(found.columns) == [column.name for column in COMPARISON_COLUMNS]
    assert len(found) == (4 * len(METRICS) if lost else 0)
    assert set(found["verdict"]) <= {"N.A."}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("size", [1e-6, 1e12, 1e300, 1.7e308])
def test_no_size_of_numbers_upsets_it(two_controllers, size: float) -> None:
    unit = np.array([1.0, -1.0, 0.5, 0.25, 1.0])
    found = row(
        two_controllers({"peak_jerk": unit * size}, {"peak_jerk": -unit * size}), "peak_jerk"
    )
    assert found.n == (5 if size < 1e308 else 2)  # a difference beyond all numbers is none


@pytest.mark.filterwarnings("error")
def test_one_pair(two_controllers) -> None:
    study = two_controllers({"stops": [1]}, {"stops": [0]})
    assert set(rows(study)["verdict"]) == {"N.A."}


def test_unknown_factor_and_level_are_named(new_study, refused) -> None:
    factors = {"controller": ["mpc", "pid"]}
    study = new_study(factors, comparison={"factor": "gains"})
    with refused(ConfigError, "gains", "controller"):
        rows(study)
    study = new_study(factors, comparison={"baseline": "lqr"})
    with refused(ConfigError, "lqr", "mpc, pid"):
        rows(study)


def test_the_table_is_what_its_file_holds(two_controllers) -> None:
    rng = np.random.default_rng(2)
    study = two_controllers(
        {metric.name: rng.normal(size=40) for metric in METRICS},
        {metric.name: rng.normal(size=40) for metric in METRICS},
    )
    found = rows(study)
    text = found.to_csv(index=False)
    again = pd.read_csv(
        io.StringIO(text), dtype={"ego": str}, keep_default_na=False, na_values={""}
    )
    assert_frame_equal(again[NUMBERS], found[NUMBERS], rtol=0, atol=0)


def test_runs_read_from_a_file_give_the_same_table(new_study) -> None:
    """In a CSV file a lost run's ego and numbers are empty cells."""
    study = new_study({"controller": ["mpc", "pid"]})
    study.add("mpc", completion_time=[1.0, 2.0, 3.0, 4.0]).add("pid", completion_time=[2.0] * 4)
    study.lose("mpc", seeds=[5]).add("pid", completion_time=[2.0], seeds=[5])
    read = pd.read_csv(io.StringIO(study.runs.to_csv(index=False)))
    assert_frame_equal(compare(read, study.design, study.comparison), rows(study))


lists = arrays(
    np.float64,
    (4, 12),
    elements=st.integers(-4000, 4000).map(lambda number: number / 16.0) | st.just(np.nan),
)


def frames(new_study, values: np.ndarray, **swap) -> tuple:
    names = ("completion_time", "minimum_ttc")
    study = new_study({"controller": ["mpc", "pid"]}, comparison=swap)
    study.add("mpc", **dict(zip(names, values[:2], strict=True)))
    study.add("pid", **dict(zip(names, values[2:], strict=True)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = compare(study.runs, study.design, study.comparison)
    return study, found[found["metric"].isin(names)].reset_index(drop=True)


@given(lists, st.randoms(use_true_random=False))
@settings(max_examples=12)
def test_order_of_rows_changes_nothing(new_study, values: np.ndarray, random) -> None:
    study, found = frames(new_study, values)
    random.shuffle(study.rows)
    again = compare(study.runs, study.design, study.comparison)
    names = ("completion_time", "minimum_ttc")
    assert_frame_equal(again[again["metric"].isin(names)].reset_index(drop=True), found)


@given(lists)
@settings(max_examples=12)
def test_swapping_treatment_and_baseline_negates(new_study, values: np.ndarray) -> None:
    _, there = frames(new_study, values, baseline="pid")
    _, back = frames(new_study, values, baseline="mpc")
    for name, mirrored, sign in (
        ("mean_difference", "mean_difference", -1.0),
        ("median_difference", "median_difference", -1.0),
        ("ci_low", "ci_high", -1.0),
        ("treatment_mean", "baseline_mean", 1.0),
        ("p_value", "p_value", 1.0),
        ("q_value", "q_value", 1.0),
    ):
        assert_allclose(back[name], sign * there[mirrored], atol=2e-6)
    opposite = {"better": "worse", "worse": "better"}
    assert list(back["verdict"]) == [opposite.get(said, said) for said in there["verdict"]]


@given(lists, st.sampled_from([0.5, 2.0, 1024.0]))
@settings(max_examples=12)
def test_unit_scales_means_and_intervals_and_nothing_else(
    new_study, values: np.ndarray, factor: float
) -> None:
    _, plain = frames(new_study, values)
    _, scaled = frames(new_study, values * factor)
    sized = ["mean_difference", "median_difference", "ci_low", "ci_high", "baseline_mean"]
    assert_allclose(scaled[sized], plain[sized] * factor, atol=1e-6 * max(1.0, factor))
    same = ["n", "wilcoxon_statistic", "p_value", "q_value", "verdict", "interval"]
    assert_frame_equal(scaled[same], plain[same])


@given(lists, st.integers(-1000, 1000))
@settings(max_examples=12)
def test_what_both_sides_have_in_common_does_not_matter(
    new_study, values: np.ndarray, shift: int
) -> None:
    _, plain = frames(new_study, values)
    _, shifted = frames(new_study, values + shift)
    means = ["treatment_mean", "baseline_mean"]
    assert_frame_equal(shifted.drop(columns=means), plain.drop(columns=means))
