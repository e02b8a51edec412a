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
from giveway.results.recorded_drive import recording_of_run as read_run
from sumo_scenarios import find

if TYPE_CHECKING:
    from pathlib import Path


def test_a_run_reads_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    config = {"crowd.pedestrians": 3, "time_limit": 2.0, "vehicle.length": 4.5}
    giveway.run(config, results=tmp_path / "run", pictures=False)
    words = ["tool", str(tmp_path / "run"), "walk", "--out", str(tmp_path)]
    monkeypatch.setattr(sys, "argv", words)
    recording_of_run.main()
    yard = dataset_of(str(find("recorded").folder / "yard.toml"))
    again = read_recording(tmp_path / "walk_traj_ped_filtered.csv", yard)
    run = read_run(RunFolder.read(tmp_path / "run"))
    assert len(again.people.ids) == len(run.people.ids) == 3
    every = run.people.frame % 2 == 0
    np.testing.assert_allclose(again.people.position, run.people.position[every], atol=6e-4)
    cars = again.vehicles
    assert cars.speed == pytest.approx(run.vehicles.speed[::2], abs=6e-4)
    front = cars.position + 2.25 * np.column_stack([np.cos(cars.heading), np.sin(cars.heading)])
    np.testing.assert_allclose(front, run.vehicles.position[::2], atol=2e-3)
