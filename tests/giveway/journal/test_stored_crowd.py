"""A crowd that is read in pieces is the crowd in memory."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import pytest

from giveway.journal import stored_crowd, stored_rows
from giveway.journal.journal import Journal
from giveway.journal.recorder import Recorder
from giveway.journal.stored_crowd import StoredCrowd
from giveway.metrics.pedestrians import walks_without_ego
from giveway.metrics.waiting import waiting_by_footway
from giveway.results.tables import trajectory_pieces
from giveway.run_data.footways import Footway, Footways
from giveway.run_data.tracks import COORDINATES, BackgroundTrack, CrowdTrack

if TYPE_CHECKING:
    from pathlib import Path

STEPS = 80
COLUMNS = ("step", "pedestrian", *COORDINATES)
NO_TRAFFIC = BackgroundTrack(*(np.empty(0, kind) for kind in ("f8", "U1", "U1", *["f8"] * 6)))


@pytest.fixture
def crowds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[CrowdTrack, CrowdTrack]:
    """The same crowd in memory and in a journal: 30 people who come, stand, walk on and leave."""
    both = []
    for journal in (None, Journal(tmp_path)):
        recorder, random = Recorder(journal), np.random.default_rng(3)
        recorder.name_pedestrians([f"p{i}" for i in range(30)], {"p3": ("child", "p2")})
        recorder.reacting(3, reacts=False)
        for k in range(STEPS):
            recorder.instant(10.0 + 0.1 * k)
            there = np.flatnonzero(abs(np.arange(30) * 2.0 - k) < 25)
            velocity = random.normal(size=(len(there), 2)) * (random.random((len(there), 1)) < 0.5)
            places = np.column_stack([0.1 * k + there, np.sin(0.1 * k + there)])
            recorder.crowd(there, places, velocity, np.empty((0, 2)), np.inf)
            recorder.journal.commit()
        if journal is not None:
            monkeypatch.setattr(stored_rows, "LONG", 50)
            monkeypatch.setattr(stored_rows, "PIECE", 90)
            monkeypatch.setattr(stored_crowd, "_PART", 130)
            monkeypatch.setattr(stored_crowd, "_AT_ONCE", 3)
        both.append(recorder.rows().crowd_track())
    return both[0], both[1]


def test_columns_and_spans_are_the_same(crowds: tuple[CrowdTrack, CrowdTrack]) -> None:
    memory, stored = crowds
    assert isinstance(stored, StoredCrowd)
    assert len(list(stored.pieces())) > 5
    assert len(list(stored.by_people())) > 5
    for a, b in ((memory, stored), (memory.during(20, 17), stored.during(20, 17))):
        for name in COLUMNS:
            assert np.array_equal(getattr(a, name), getattr(b, name)), name
        assert a.reacts_from is not None
        assert a.reacts_from.tolist() == b.reacts_from.tolist()
        assert (a.ids, a.kinds, a.groups) == (b.ids, b.kinds, b.groups)
    assert len(stored.during(STEPS, 5).x) == 0
    with pytest.raises(AttributeError, match="angle"):
        stored.angle  # noqa: B018


def test_walks_and_waiting_are_the_same(crowds: tuple[CrowdTrack, CrowdTrack]) -> None:
    time = 10.0 + 0.1 * np.arange(STEPS)
    edge = Footway("edge", np.array([[0.0, 5.0], [40.0, 5.0]]), 0.0, light=False)
    zebra = Footway(":c", np.array([[8.0, -2.0], [8.0, 2.0]]), 4.0, light=False)
    tables = [walks_without_ego(time, crowd) for crowd in crowds]
    pd.testing.assert_frame_equal(*tables, check_exact=True)
    rows = [waiting_by_footway(time, crowd, Footways((zebra,), (edge,))) for crowd in crowds]
    assert rows[0] == rows[1]
    assert {row.id for row in rows[0]} == {"edge", ":c"}


def test_rows_of_the_table_are_the_same(crowds: tuple[CrowdTrack, CrowdTrack]) -> None:
    time = 10.0 + 0.1 * np.arange(STEPS)
    tables = [list(trajectory_pieces(time, (), crowd, NO_TRAFFIC)) for crowd in crowds]
    assert len(tables[0]) == 1 < len(tables[1])
    whole = pd.concat(tables[1], ignore_index=True)
    pd.testing.assert_frame_equal(tables[0][0], whole, check_exact=True)


def test_thinned_walks_keep_their_slow_time() -> None:
    """One person stands for 2 s and walks for 2 s; recorded every 0.5 s of a step of 0.1 s."""
    step = np.arange(0, 41, 5)
    speed = np.where(step < 20, 0.0, 1.0)
    nothing = np.zeros(len(step))
    crowd = CrowdTrack(step, np.zeros_like(step), nothing, nothing, speed, nothing, ("p",))
    time = 0.1 * np.arange(41)
    (walk,) = walks_without_ego(time, crowd, every=5).to_dict("records")
    assert walk["slow_time"] == pytest.approx(2.0)
    assert np.isnan(walk["peak_acceleration"])
