"""What the MPC expected of the crowd is a table, if it was asked for; nothing else changes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest

from giveway import run
from giveway.api import run_checked
from giveway.config.files.loading import as_layer, load
from giveway.cosimulation.preflight import preflight
from giveway.cosimulation.recording_instants import looks_ahead
from giveway.journal.journal_reader import read_journal
from giveway.journal.recorded import RecordedRows

if TYPE_CHECKING:
    from pathlib import Path

SETTINGS: dict[str, Any] = {
    "scenario": "shared_space",
    "seed": 3,
    "controller": "mpc-paper",
    "time_limit": 7.0,
}


def test_without_the_option_its_table_is_absent_others_equal(
    recorded: Path, tmp_path: Path
) -> None:
    run(SETTINGS, results=tmp_path / "plain", pictures=False)
    assert not (tmp_path / "plain" / "predictions.csv").exists()
    for name in ("ego", "trajectories", "pedestrians", "summary"):
        plain = (tmp_path / "plain" / f"{name}.csv").read_bytes()
        assert plain == (recorded / f"{name}.csv").read_bytes()


def test_it_looks_as_far_as_the_horizon_in_equal_steps(recorded: Path) -> None:
    rows = pd.read_csv(recorded / "predictions.csv", dtype={"id": str, "ego": str})
    assert list(rows) == ["time", "ego", "id", "look_ahead", "x", "y"]
    assert sorted(rows["look_ahead"].unique()) == [0.25, 0.5, 0.75]
    assert set(rows["ego"]) == {"ego"}
    per_instant = rows.groupby("time")["id"].agg(["size", "nunique"])
    assert (per_instant["size"] == 3 * per_instant["nunique"]).all()
    ego = pd.read_csv(recorded / "ego.csv")
    assert 0 < len(per_instant) < len(ego)  # at the beginning nobody could reach the corridor


def test_it_is_about_where_people_are_then(recorded: Path) -> None:
    rows = pd.read_csv(recorded / "predictions.csv", dtype={"id": str, "ego": str})
    was = pd.read_csv(recorded / "trajectories.csv", dtype={"id": str})
    was = was[was["type"] == "pedestrian"]
    rows["then"] = (rows["time"] + rows["look_ahead"]).round(6)
    both = rows.merge(was, left_on=["then", "id"], right_on=["time", "id"], suffixes=("", "_was"))
    off = np.hypot(both["x"] - both["x_was"], both["y"] - both["y_was"])
    assert len(both) > 1000
    # The ego is taken to keep its speed: whom it does not concern goes exactly as predicted.
    assert np.quantile(off, 0.25) < 1e-3
    assert np.quantile(off, 0.9) < 0.2


def test_the_data_package_describes_it(recorded: Path) -> None:
    package = pd.read_json(recorded / "datapackage.json", typ="series")
    resource = next(one for one in package["resources"] if one["name"] == "predictions")
    assert [field["name"] for field in resource["schema"]["fields"]][-3:] == [
        "look_ahead",
        "x",
        "y",
    ]


@pytest.mark.parametrize(
    ("period", "steps"), [(None, 0), (0.25, 5), (0.01, 1), (0.12, 2), (99.0, 1980)]
)
def test_a_period_is_whole_control_steps(period: float | None, steps: int) -> None:
    assert looks_ahead(period, 0.05) == steps


@pytest.mark.parametrize(("controller", "horizon"), [("mpc-paper", 0.75), ("mpc", 2.5)])
def test_of_a_period_beyond_the_horizon_its_end_is_kept(controller: str, horizon: float) -> None:
    settings = {**SETTINGS, "time_limit": 6.0, "controller": controller}
    result = run({**settings, "record": {"predictions": 99.0}})
    assert result.predictions["look_ahead"].unique() == pytest.approx([horizon])


def test_the_pid_alone_predicts_nothing() -> None:
    settings = {**SETTINGS, "time_limit": 6.0, "controller": "pid"}
    result = run({**settings, "record": {"predictions": 0.25}})
    assert result.predictions.empty
    assert list(result.predictions) == ["time", "ego", "id", "look_ahead", "x", "y"]


def test_a_journal_has_it_too(tmp_path: Path) -> None:
    layer = as_layer({**SETTINGS, "time_limit": 6.0, "record": {"predictions": 0.25}})
    result = run_checked(preflight(*load([layer])), journal=tmp_path)
    contents = read_journal(tmp_path)
    (drive,) = RecordedRows(contents.tables, contents.names).egos()
    mine = result.egos[0].predictions
    assert drive.predictions.x.size > 0
    for name in ("time", "pedestrian", "look_ahead", "x", "y"):
        assert np.array_equal(getattr(drive.predictions, name), getattr(mine, name))


def test_what_counts_as_a_stop_is_an_option() -> None:
    stops = [
        run({**SETTINGS, "record": {"stop_speed": limit}}).summary["longest_wait"]
        for limit in (0.2, 1.0)
    ]
    assert stops[0] < stops[1]
