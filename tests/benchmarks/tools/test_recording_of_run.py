"""A run as a recording: read back, it is the run again."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import numpy as np
import pytest
import recording_of_run

import giveway
from giveway.recordings import dataset_of, read_recording
from giveway.replays.run_folder import RunFolder
from giveway.results.recorded_drive import RECORDED_DRIVER, compared
from giveway.results.recorded_drive import recording_of_run as read_run
from sumo_scenarios import find

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


YARD = find("recorded").folder / "yard.toml"
COUNTS = ("near", "close", "short_ttc", "short_pet", "person_first", "vehicle_first", "touched")


@pytest.fixture
def write(monkeypatch: pytest.MonkeyPatch) -> Callable[[Path], RunFolder]:
    """Write the run in a folder as the recording "walk" beside it."""

    def write(folder: Path) -> RunFolder:
        words = ["tool", str(folder), "walk", "--out", str(folder.parent)]
        monkeypatch.setattr(sys, "argv", words)
        recording_of_run.main()
        return RunFolder.read(folder)

    return write


def test_a_run_reads_as_it_was(tmp_path: Path, write: Callable[[Path], RunFolder]) -> None:
    config = {"crowd.pedestrians": 3, "time_limit": 2.0, "vehicle.length": 4.5}
    giveway.run(config, results=tmp_path / "run", pictures=False)
    run = read_run(write(tmp_path / "run"))
    again = read_recording(tmp_path / "walk_traj_ped_filtered.csv", dataset_of(str(YARD)))
    assert len(again.people.ids) == len(run.people.ids) == 3
    every = run.people.frame % 2 == 0
    np.testing.assert_allclose(again.people.position, run.people.position[every], atol=6e-4)
    cars = again.vehicles
    assert cars.speed == pytest.approx(run.vehicles.speed[::2], abs=6e-4)
    front = cars.position + 2.25 * np.column_stack([np.cos(cars.heading), np.sin(cars.heading)])
    np.testing.assert_allclose(front, run.vehicles.position[::2], atol=2e-3)


def test_the_same_controller_drives_as_recorded(
    tmp_path: Path, write: Callable[[Path], RunFolder]
) -> None:
    """A drive among people who are handed over near it meets the same people in the same way."""
    drive = {"controller": "pid-tuned", "vehicle": {"length": 4.5, "width": 1.8}}
    crowd = {"crowd.pedestrians": 10, "seed": 6, "record.near": 500.0, "time_limit": 15.0}
    giveway.run(
        {"scenario": "encounter", **drive, **crowd}, results=tmp_path / "run", pictures=False
    )
    run = write(tmp_path / "run")
    entry = {"name": "yard", "path": str(tmp_path / "walk_traj_ped_filtered.csv")}
    entry |= {"dataset": str(YARD), "vehicle": "1", "walk_on": 20.0}
    way = {"ego.travel_distance": run.summary["travelled_distance"]}
    again = {"scenario": "recorded", "crowd.recorded": [entry], **drive, **way}
    giveway.run(again, results=tmp_path / "again", pictures=False)
    recorded, own = compared([tmp_path / "again"]).to_dict("records")
    assert (recorded["driver"], own["driver"]) == (RECORDED_DRIVER, "again")
    assert recorded["recording"] == own["recording"] == "walk"
    assert all(recorded[name] > 0 for name in COUNTS[:-1]), "a crowd in which much happens"
    assert [own[name] for name in COUNTS] == [recorded[name] for name in COUNTS]
    for name, tolerance in (("duration", 0.1), ("mean_speed", 0.02), ("clearance", 0.1)):
        assert own[name] == pytest.approx(recorded[name], abs=tolerance)
