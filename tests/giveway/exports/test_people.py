"""PedPy and JuPedSim read what is written, and find everybody where the tables have them."""

from __future__ import annotations

import contextlib
import sqlite3

import numpy as np
import pytest

from giveway.errors import ResultsError
from giveway.exports.people import write_jupedsim, write_pedpy
from giveway.exports.sampling import sampled

pedpy = pytest.importorskip("pedpy")


def matches(data, run):
    """[m] the largest distance between what was read and the tables."""
    samples = sampled(run)
    names = {number: track.id for number, track in enumerate(samples.people(), start=1)}
    data = data.assign(
        id=data["id"].map(names), time=(samples.begin + 0.05 * data["frame"]).round(3)
    )
    rows = run.trajectories[run.trajectories["type"] == "pedestrian"]
    both = rows.assign(time=rows["time"].round(3)).merge(data, on=["id", "time"])
    assert len(both) > 0.95 * len(rows)
    return np.hypot(both["x_x"] - both["x_y"], both["y_x"] - both["y_y"]).max()


def test_pedpy_reads_its_text(run, tmp_path):
    file = tmp_path / "people.txt"
    told = write_pedpy(run, sampled(run), file)
    read = pedpy.load_trajectory(trajectory_file=file)
    assert read.frame_rate == 20.0
    assert matches(read.data, run) < 1e-4
    speed = pedpy.compute_individual_speed(traj_data=read, frame_step=5)
    assert speed["speed"].between(0.0, 2.6).all()
    assert told == f"{read.data['id'].nunique()} people at 20 frames/s, for PedPy"
    head = file.read_text(encoding="utf-8").splitlines()
    assert head[1] == f"# frame 0 is at {run.time[0]:g} s of SUMO's clock"


def test_pedpy_reads_jupedsims_database_too(run, tmp_path):
    file = tmp_path / "people.sqlite"
    for _ in range(2):  # again: it is replaced
        write_jupedsim(run, sampled(run), file)
    read = pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=file)
    assert read.frame_rate == 20.0
    assert matches(read.data, run) < 1e-4
    ground = pedpy.load_walkable_area_from_jupedsim_sqlite(trajectory_file=file)
    assert pedpy.is_trajectory_valid(traj_data=read, walkable_area=ground)
    with contextlib.closing(sqlite3.connect(file)) as database:
        facing = database.execute("SELECT ori_x, ori_y FROM trajectory_data").fetchall()
    assert np.hypot(*np.array(facing).T) == pytest.approx(1.0, abs=1e-5)


def test_jupedsims_own_reader_reads_it(run, tmp_path):
    recording = pytest.importorskip("jupedsim.recording")
    file = tmp_path / "people.sqlite"
    write_jupedsim(run, sampled(run), file)
    read = recording.Recording(str(file))
    assert read.num_frames == sampled(run).count
    assert read.fps == 20.0


def test_where_nobody_walked_there_is_nothing_to_export(run, tmp_path):
    samples = sampled(run)
    alone = type(samples)(samples.begin, samples.step, samples.count, ())
    for write in (write_pedpy, write_jupedsim):
        with pytest.raises(ResultsError, match="nobody walked"):
            write(run, alone, tmp_path / "none")
