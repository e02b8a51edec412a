"""Trajectories at equal times: nothing is moved, nobody is invented."""

from __future__ import annotations

import dataclasses

import numpy as np
import pandas as pd
import pytest

from giveway.errors import ConfigError, ResultsError
from giveway.exports.sampling import sampled


def with_rows(run, rows):
    columns = ["time", "id", "type", "x", "y", "angle", "speed", "vx", "vy"]
    table = pd.DataFrame([[*row, 0.0, 0.0] for row in rows], columns=columns)
    return dataclasses.replace(run, trajectories=table)


def test_what_is_recorded_is_kept(run):
    samples = sampled(run)
    rows = run.trajectories
    assert samples.step == 0.05
    assert samples.begin == rows["time"].min()
    tracks = {track.id: track for track in samples.tracks}
    assert {track.object for track in samples.tracks} == set(rows["id"])
    worst = 0.0
    for row in rows.itertuples():
        track = tracks[row.id]
        k = round((row.time - samples.begin) / 0.05) - track.first
        if 0 <= k < len(track):
            worst = max(worst, abs(track.x[k] - row.x), abs(track.y[k] - row.y))
    assert worst < 1e-9


def test_in_between_they_move_evenly_and_turn_the_short_way(run):
    rows = [
        (0.0, "a", "pedestrian", 0.0, 0.0, 350.0, 1.0),
        (1.0, "a", "pedestrian", 1.0, 2.0, 10.0, 2.0),
    ]
    (track,) = sampled(with_rows(run, rows), 0.25).tracks
    assert track.x.tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert track.y.tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    assert track.angle == pytest.approx([350.0, 355.0, 0.0, 5.0, 10.0])
    assert track.speed == pytest.approx([1.0, 1.25, 1.5, 1.75, 2.0])


def test_who_was_away_comes_back_under_another_name(run):
    rows = [(t, "a", "pedestrian", t, 0.0, 90.0, 1.0) for t in (0.0, 1.0, 2.0, 9.0, 10.0)]
    first, second = sampled(with_rows(run, rows), 0.5).tracks
    assert (first.id, first.first, len(first)) == ("a", 0, 5)
    assert (second.id, second.object, second.first, len(second)) == ("a#2", "a", 18, 3)
    assert np.concatenate([first.x, second.x]).tolist() == [0, 0.5, 1, 1.5, 2, 9, 9.5, 10]


@pytest.mark.parametrize("step", [0.0, -1.0, 0.0305001, 11.0, float("nan")])
def test_a_step_that_makes_no_sense_is_refused(run, step):
    with pytest.raises(ConfigError, match=r"--step .*: expected 0\.001 to 10 \[s\]"):
        sampled(run, step)


def test_a_run_without_rows_has_nothing_to_export(run):
    with pytest.raises(ResultsError, match=r"the trajectories have no rows"):
        sampled(dataclasses.replace(run, trajectories=run.trajectories[:0]))
