"""Drives of egos beside the recorded vehicle's, by the recording that is bundled."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import giveway
from giveway.errors import ConfigError
from giveway.recordings.measuring import measure
from giveway.replays.run_folder import RunFolder
from giveway.results.recorded_drive import MEASURES, RECORDED_DRIVER, compared, recording_of_run

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recorded") / "mpc"
    giveway.run("recorded", results=folder, pictures=False)
    return folder


def test_a_run_is_measured_as_its_own_tables_say(folder: Path) -> None:
    run = RunFolder.read(folder)
    found = measure([recording_of_run(run)])
    (drive,) = found.drives.to_dict("records")
    assert drive["maximum_speed"] == pytest.approx(run.summary["maximum_speed"], abs=1e-6)
    assert drive["duration"] == pytest.approx(run.summary["simulated_time"], abs=1e-6)
    own = run.pedestrians.set_index("id")["minimum_clearance"]
    for row in found.people.itertuples():
        assert row.clearance == pytest.approx(own[row.person], abs=2e-6)


def test_close_passes_of_a_run_are_those_of_a_recorded_drive(tmp_path: Path) -> None:
    """`giveway data measure` finds in the run's tables what the run's summary says."""
    settings = {"controller": "pid-tuned", "crowd": {"pedestrians": 24}, "seed": 4}
    giveway.run({"scenario": "encounter", **settings}, results=tmp_path / "run", pictures=False)
    run = RunFolder.read(tmp_path / "run")
    (drive,) = measure([recording_of_run(run)]).drives.to_dict("records")
    names = ("people_near", "people_near_moving", "close_passes", "tight_passes")
    counts = [run.summary[name] for name in names]
    assert counts == [drive[name] for name in ("near", "near_moving", "close", "tight")]
    near, moving, close, _ = counts
    assert near >= moving > close > 0
    assert run.summary["close_pass_share"] == close / near
    people = run.pedestrians
    assert (people["clearance_above_2"] < 0.5).sum() == close
    assert run.summary["conflicts"] <= people["time_to_accident"].notna().sum()


def test_a_recorded_driver_has_one_row_for_all_runs(folder: Path) -> None:
    table = compared([folder, folder])
    assert table["driver"].tolist() == [RECORDED_DRIVER, "mpc"]
    assert list(table.columns)[3:] == [name for name, _ in MEASURES]
    assert np.isfinite(table["duration"]).all()


def test_a_run_without_a_recorded_vehicle_is_refused(tmp_path: Path) -> None:
    other = tmp_path / "other"
    giveway.run({"time_limit": 0.5, "crowd.pedestrians": 2}, results=other, pictures=False)
    with pytest.raises(ConfigError, match=r"other: no \[\[crowd.recorded\]\] with a vehicle"):
        compared([other])
    entry = {"name": "yard", "path": str(yard()), "dataset": str(yard().with_name("yard.toml"))}
    crowd = {"recorded": [{**entry, "vehicle": "7"}]}
    nobody = tmp_path / "nobody"
    giveway.run({"scenario": "recorded", "crowd": crowd, "time_limit": 1.0}, results=nobody)
    with pytest.raises(ConfigError, match=r"'yard': vehicle = '7': not in 'yard'; expected one of"):
        compared([nobody])


def yard() -> Path:
    """Return the people's file of the bundled recording."""
    import sumo_scenarios

    return sumo_scenarios.find("recorded").folder / "yard_traj_ped_filtered.csv"
