"""A row of ``ego.csv`` keeps each value under its own name, from the recorder to the table."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING

import pytest

from giveway.geometry.bodies import VehicleShape
from giveway.journal.journal import Journal
from giveway.journal.journal_reader import read_journal
from giveway.journal.layout import EGO_COUNTS, EGO_TEXTS
from giveway.journal.recorded import RecordedRows
from giveway.journal.recorder import Recorder
from giveway.results.tables import ego_table
from giveway.run_data.tracks import EGO_COLUMNS, EgoRow

if TYPE_CHECKING:
    from pathlib import Path

VALUES = {
    field.name: field.name
    if field.name in EGO_TEXTS
    else k
    if field.name in EGO_COUNTS
    else k + 0.5
    for k, field in enumerate(fields(EgoRow))
}


def test_each_value_comes_back_under_its_name(tmp_path: Path) -> None:
    recorder = Recorder(Journal(tmp_path))
    recorder.drive("car", VehicleShape(), 40.0)
    recorder.instant(0.5)
    recorder.ego("car", EgoRow(**VALUES))
    recorder.journal.close()
    contents = read_journal(tmp_path)
    for rows in (recorder.rows(), RecordedRows(contents.tables, contents.names)):
        (ego,) = rows.egos()
        assert {name: getattr(ego.track, name).item() for name in VALUES} == VALUES
    table = ego_table(ego.track, "car")
    assert list(table) == [column.name for column in EGO_COLUMNS]
    assert table["id"].item() == "car"
    assert (table["x"].item(), table["y"].item()) == (VALUES["front_x"], VALUES["front_y"])
    assert table["controller"].item() == "controller"


def test_a_journal_without_a_column_is_not_read() -> None:
    recorder = Recorder()
    recorder.drive("car", VehicleShape(), 40.0)
    recorder.instant(0.5)
    recorder.ego("car", EgoRow(**VALUES))
    tables = dict(recorder.rows()._rows)
    names = [name for name in tables["ego"].dtype.names or () if name != "stop_gap"]
    tables["ego"] = tables["ego"][names]
    with pytest.raises(ValueError, match="stop_gap"):
        list(RecordedRows(tables, recorder.rows()._names).egos())
