"""What the judgement by the law of the road needs: kept by the recorder, and by a journal too."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.journal.journal import Journal
from giveway.journal.journal_reader import read_journal
from giveway.journal.recorded import RecordedRows
from giveway.journal.recorder import Recorder
from giveway.run_data.way import CrossingOnWay, EgoWay, Halt, JunctionOnWay, StopLine

if TYPE_CHECKING:
    from pathlib import Path

WAY = EgoWay(
    "égo",
    ((0.0, 0.0), (0.1, 1 / 3), (10.0, 20.0)),
    4.5,
    (CrossingOnWay(":j_c0_0", ((0.0, 1.0), (0.0, 8.0)), 4.0, True, "tls", 3),),
    (StopLine(5.0, "tls", 1),),
    (JunctionOnWay(6.0, 9.0, (7.0, 8.0)), JunctionOnWay(12.0, 15.0, ())),
    (Halt(1.0, 2.0),),
)


def record(folder: Path | None) -> Recorder:
    recorder = Recorder(Journal(folder))
    recorder.name_pedestrians(["a", "b"])
    recorder.way(WAY)
    recorder.signal(9.5, "tls", "rG")
    recorder.instant(10.0)
    recorder.walk(1, 1.25, np.array([[1.0, 2.0], [3.0, 4.0]]))
    recorder.journal.commit()
    recorder.instant(10.05)
    recorder.signal(10.05, "tls", "Gr")
    recorder.walk(0, 1.5, np.array([[5.0, 6.0]]))
    recorder.journal.commit()
    return recorder


def rows_of(folder: Path) -> RecordedRows:
    contents = read_journal(folder)
    return RecordedRows(contents.tables, contents.names)


@pytest.mark.parametrize("journalled", [False, True])
def test_all_of_it_comes_back(tmp_path: Path, journalled: bool) -> None:
    recorder = record(tmp_path if journalled else None)
    rows = rows_of(tmp_path) if journalled else recorder.rows()
    assert rows.ways() == {"égo": WAY}
    signals, people = rows.signal_track(), rows.people_track()
    assert signals.time.tolist() == [9.5, 10.05]
    assert signals.system.tolist() == ["tls", "tls"]
    assert signals.state.tolist() == ["rG", "Gr"]
    assert people.step.tolist() == [0, 0, 1]
    assert people.pedestrian.tolist() == [1, 1, 0]
    assert people.desired_speed.tolist() == [1.25, 1.25, 1.5]
    assert (people.x.tolist(), people.y.tolist()) == ([1.0, 3.0, 5.0], [2.0, 4.0, 6.0])


def test_a_recorder_without_any_of_it_has_empty_tracks() -> None:
    rows = Recorder().rows()
    assert rows.ways() == {}
    assert len(rows.signal_track().state) == len(rows.people_track().step) == 0


def test_what_a_way_is_ruled_by() -> None:
    assert WAY.is_ruled
    assert WAY.systems == {"tls"}
    bare = EgoWay("ego", ((0.0, 0.0), (1.0, 0.0)), halts=(Halt(0.0, 1.0),))
    assert not bare.is_ruled
    assert bare.systems == frozenset()
