"""Rows that leave the memory, and are read again from the journal."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from giveway.journal import stored_rows
from giveway.journal.journal import Journal
from giveway.journal.journal_reader import read_journal
from giveway.journal.stored_rows import StoredRows

STEPS, PEOPLE = 60, 50


def fill(journal: Journal) -> np.ndarray:
    """Write 60 steps of 50 rows beside another table, and return all values (3000, 2)."""
    rows, other = journal.rows("long", ("a", "b"), stored=True), journal.rows("short", ("c",))
    values = np.arange(2.0 * STEPS * PEOPLE).reshape(-1, 2)
    for step in range(STEPS):
        other.add(step)
        rows.block(PEOPLE + 3)[:PEOPLE] = values[step * PEOPLE : (step + 1) * PEOPLE]
        rows.give_back(3)
        journal.commit()
    journal.rows_of_test = rows  # type: ignore[attr-defined]
    return values


def test_memory_does_not_grow_with_the_run(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    values = fill(journal)
    rows = journal.rows_of_test  # type: ignore[attr-defined]
    assert len(rows.filled) == 0
    assert len(rows._buffer) == 1024  # the first room was never left
    assert rows.whole.tolist() == list(map(tuple, values.tolist()))


def test_long_tables_are_read_in_pieces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stored_rows, "LONG", 100)
    monkeypatch.setattr(stored_rows, "PIECE", 120)
    journal = Journal(tmp_path)
    values = fill(journal)
    rows = journal.rows_of_test  # type: ignore[attr-defined]
    rows.add(-1.0, -2.0)  # not written yet
    live = rows.whole
    assert isinstance(live, StoredRows)
    assert [len(piece) for piece in live.pieces()] == [150] * 20 + [1]
    assert live.read().tolist() == [*map(tuple, values.tolist()), (-1.0, -2.0)]
    journal.close()
    contents = read_journal(tmp_path)
    found = contents.tables["long"]
    assert isinstance(found, StoredRows)
    assert (len(found), len(contents.tables["short"])) == (3001, STEPS)
    assert found.read().tolist() == live.read().tolist()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a full disk")
def test_rows_stay_in_memory_once_the_disk_is_full(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    rows = journal.rows("long", ("a",), stored=True)
    rows.add(1.0)
    journal.commit()
    full = os.open("/dev/full", os.O_WRONLY)
    os.dup2(full, journal._file.fileno())  # type: ignore[union-attr]
    os.close(full)
    for value in (2.0, 3.0):
        rows.add(value)
        journal.commit()
    assert "No space left" in journal.failure
    assert rows.whole.tolist() == [(1.0,), (2.0,), (3.0,)]


def test_torn_rows_are_refused() -> None:
    with pytest.raises(ValueError, match="no whole rows"):
        StoredRows(Path("rows"), np.dtype([("a", float)])).append(0, 12)
