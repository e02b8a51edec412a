"""A run says how long SUMO's own driver takes for the same trip, and is whole without that."""

import math
from pathlib import Path

import pytest

import giveway
from giveway.api import baseline
from giveway.metrics.baseline import BASELINE_FIELDS
from giveway.sumo.plain_drive import PlainDrives

CAR = {"scenario": "junction", "ego": {"take_over": ["westbound.0"]}, "time_limit": 60.0}
COLUMNS = [column.name for column in BASELINE_FIELDS]


def test_the_summary_has_the_time_of_sumo(tmp_path: Path) -> None:
    result = giveway.run(CAR, results=tmp_path / "run", pictures=False)
    summary = result.summary
    assert 25.0 < summary["sumo_time"] < 50.0
    ratio = summary["completion_time"] / summary["sumo_time"]
    assert summary["time_over_sumo"] == pytest.approx(ratio)
    assert summary["sumo_time_at_limit"] != summary["sumo_time"]
    header = (tmp_path / "run" / "summary.csv").read_text().splitlines()[0].split(",")
    assert header[-len(COLUMNS) :] == COLUMNS


def test_it_can_be_left_out_and_changes_nothing_else() -> None:
    short = CAR | {"time_limit": 2.0}
    without = giveway.run(short | {"sumo": {"baseline": False}}).summary
    assert not set(COLUMNS) & set(without)
    with_it = giveway.run(short).summary
    assert {name: with_it[name] for name in without} == pytest.approx(without, nan_ok=True)
    assert math.isnan(with_it["time_over_sumo"])  # it has not arrived


def test_an_inserted_ego_is_timed_beside_sumo_on_its_route() -> None:
    summary = giveway.run({"scenario": "junction"}).summary
    assert summary["sumo_time"] == summary["sumo_time_at_limit"]  # its type's speed factor is 1
    assert summary["sumo_time"] > 150.0 / 13.9  # 150 m at the limit


def test_a_scenario_without_traffic_has_no_such_time() -> None:
    assert "sumo_time" not in giveway.run({"time_limit": 0.5}).summary


@pytest.mark.parametrize("fault", [None, OSError("disk full"), giveway.GivewayError("gone")])
def test_a_drive_that_does_not_come_about_is_told(monkeypatch, fault) -> None:
    def fails(*_: object, **__: object) -> PlainDrives:
        if fault is not None:
            raise fault
        return PlainDrives(None, None)

    monkeypatch.setattr(baseline, "plain_drives", fails)
    result = giveway.run(CAR | {"time_limit": 0.5})
    assert math.isnan(result.summary["sumo_time"])
    (remark,) = (text for text in result.remarks if "SUMO's own drive" in text)
    assert remark.startswith("ego 'westbound.0': SUMO's own drive of this trip did not come about")
