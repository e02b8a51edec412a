"""The benchmark's table: ratios of sums, intervals over seeds, and drives without a result."""

import numpy as np
import pandas as pd
import pytest

from giveway.studies.benchmark import ALL_SCENES, COLUMNS, benchmark_of, benchmark_table, scenes
from giveway.studies.design import design

DEFINITION = benchmark_of(["mine"])
DESIGN = design(DEFINITION, "benchmark")
COMPARISON = DEFINITION.comparison.model_copy(update={"minimum_pairs": 3, "resamples": 999})
NUMBERS = {
    "completed": True, "completion_time": 12.0, "simulated_time": 15.0, "close_passes": 0,
    "tight_passes": 0, "narrow_passes": 0, "people_near": 10, "people_near_moving": 5,
    "mean_people_delay": 0.5, "conflicts": 0, "hard_brakes": 0, "rms_jerk": 1.0,
    "frontal_contacts": 0, "side_contacts": 0,
}  # fmt: skip


def drives(scene, *changes, people="MIXED"):
    """Rows of runs.csv: one drive for each set of changed numbers, with seeds from 701 on."""
    head = {"controller": "mine", "people": people, "scene": scene, "ending": "completed"}
    return [head | {"seed": 701 + k} | NUMBERS | change for k, change in enumerate(changes)]


def table(*rows, comparison=COMPARISON):
    frame = benchmark_table(pd.DataFrame([*rows]), DESIGN, comparison)
    assert list(frame.columns) == [column.name for column in COLUMNS]
    return frame.set_index(["people", "scene"])


def test_a_share_is_that_of_all_people_and_not_a_mean_of_shares():
    rows = drives(
        "stream, 30",
        {"close_passes": 1, "people_near": 1, "people_near_moving": 1},
        {"people_near": 19, "people_near_moving": 4},
    )
    row = table(*rows).loc[("MIXED", "stream, 30")]
    assert row.close_pass_share == pytest.approx(1 / 20)
    assert row.close_pass_share_moving == pytest.approx(1 / 5)
    assert row.close_passes == pytest.approx(1 / 2)
    assert (row.people_near, row.people_near_moving) == (20, 5)


def test_a_drive_that_does_not_arrive_counts_with_its_length():
    rows = drives(
        "stream, 30", {}, {"completed": False, "completion_time": np.nan, "simulated_time": 120.0}
    )
    row = table(*rows).loc[("MIXED", "stream, 30")]
    assert (row.arrived, row.drives, row.time) == (1, 2, pytest.approx(66.0))


def test_a_drive_without_a_result_is_counted_and_left_out():
    lost = dict.fromkeys(NUMBERS, np.nan) | {"ending": "crashed"}
    row = table(*drives("stream, 30", {}, lost, {"rms_jerk": 3.0})).loc[("MIXED", "stream, 30")]
    assert (row.drives, row.failed, row.arrived) == (2, 1, 2)
    assert row.rms_jerk == pytest.approx(2.0)
    row = table(*drives("stream, 30", lost, lost)).loc[("MIXED", "stream, 30")]
    assert (row.drives, row.failed) == (0, 2)
    assert np.isnan(row.close_pass_share)


def test_an_interval_covers_its_number_and_narrows_with_drives():
    rng = np.random.default_rng(1)

    def width(count):
        changes = [{"close_passes": int(n)} for n in rng.poisson(1.0, count)]
        row = table(*drives("stream, 30", *changes)).loc[("MIXED", "stream, 30")]
        assert row.close_pass_share_low < row.close_pass_share < row.close_pass_share_high
        return row.close_pass_share_high - row.close_pass_share_low

    # the half width is 1.96 s / sqrt(n), of a share with s = 1 / 10
    assert width(400) == pytest.approx(2 * 1.96 * 0.1 / 20.0, rel=0.2)
    assert width(25) > 2.0 * width(400)


def test_too_few_drives_have_no_interval():
    row = table(*drives("stream, 30", {}, {})).loc[("MIXED", "stream, 30")]
    assert row.time == 12.0
    assert np.isnan(row.time_low)
    assert np.isnan(row.close_pass_share_high)


def test_nobody_passed_closely_is_no_proof_of_nobody():
    row = table(*drives("stream, 30", {}, {}, {})).loc[("MIXED", "stream, 30")]
    assert (row.close_pass_share, row.close_pass_share_low) == (0.0, 0.0)
    # none of 30 people: that has a probability of 2.5 % if the share is this one
    assert (1.0 - row.close_pass_share_high) ** 30 == pytest.approx(0.025, rel=1e-3)


def test_all_scenes_are_pooled_only_if_none_is_missing():
    rows = [row for scene in scenes() for row in drives(scene, {}, {"close_passes": 7})]
    frame = table(*rows, *drives("stream, 30", {}, people="SIM"))
    assert [scene for people, scene in frame.index if people == "MIXED"] == [*scenes(), ALL_SCENES]
    assert [scene for people, scene in frame.index if people == "SIM"] == ["stream, 30"]
    pooled = frame.loc[("MIXED", ALL_SCENES)]
    assert (pooled.drives, pooled.close_passes) == (2 * len(scenes()), pytest.approx(3.5))


def test_the_table_does_not_depend_on_the_order_of_the_rows():
    rng = np.random.default_rng(2)
    rows = drives("stream, 30", *({"close_passes": int(n)} for n in rng.poisson(1.0, 20)))
    pd.testing.assert_frame_equal(table(*rows), table(*reversed(rows)))
