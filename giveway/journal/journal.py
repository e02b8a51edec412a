"""The rows of a run in a file that outlives its process.

Native code (SUMO, the FMU, a solver) can end the process at any instruction. Rows that have been
handed to the operating system by then are kept. Therefore the run's tables live in memory, and once
per control step all new rows are appended to one file by one write. The longest table, the crowd,
leaves the memory with that write:

    magic | record | record | ... ;  record = kind, table, bytes | payload

A ``COMMIT`` record closes each write: a reader gets complete steps only, also if the end of
the file is damaged. The file is written and not memory-mapped, for four reasons. A wild pointer of
native code cannot reach rows that have been written. A full disk is an error number instead of a
SIGBUS. It works on every disk and system. And rows are filled at the speed of plain memory.

A failing journal never ends a run: if it cannot be written, it gives the reason in
:attr:`Journal.failure`, and the run goes on in memory.
"""

import contextlib
import enum
import json
import struct
from collections.abc import Sequence
from io import FileIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from giveway.errors import remedy
from giveway.gate import signed
from giveway.journal.stored_rows import Rows, StoredRows
from giveway.processes.heartbeat import Heartbeat

Array = NDArray[np.float64]
ROWS_FILE = "rows"
META_FILE = "meta.json"
MAGIC = b"giveway4"  # Format number; the columns of a table are in the journal
RECORD = struct.Struct("=IIQ")  # kind, table, bytes of payload; 16 bytes
_FIRST_ROWS = 1024  # Initial number of rows of a table, which then doubles


class Kind(enum.IntEnum):
    """The kind of content that a record holds."""

    ROWS_TABLE = 1  # payload: JSON, name and names of columns
    NAME_TABLE = 2  # payload: JSON, name
    ROWS = 3  # payload: float64
    NAMES = 4  # payload: JSON, the new names in order
    COMMIT = 5  # no payload


_COMMIT = RECORD.pack(Kind.COMMIT, 0, 0)


def row_type(columns: Sequence[str]) -> np.dtype[np.void]:
    """Return the type of a row of float64 with these columns."""
    return np.dtype([(name, np.float64) for name in columns])


class JournalRows:
    """A table of float64 whose memory doubles when it is full.

    Args:
        columns: Names of the columns, in order.
        number: Number of the table in its journal.
        stored: Place of the rows that leave the memory when they are written, or None to keep all.
    """

    def __init__(
        self, columns: Sequence[str], number: int = 0, stored: StoredRows | None = None
    ) -> None:
        self._number, self._stored = number, stored
        self._count = self._journalled = self._record = 0
        self._type = row_type(columns)
        self._row_bytes = self._type.itemsize
        self._fill = struct.Struct(f"={len(columns)}d").pack_into
        self._hold(np.empty((_FIRST_ROWS, len(columns))))

    def _hold(self, buffer: Array) -> None:
        self._buffer, self._room = buffer, len(buffer)
        self._bytes = buffer.data.cast("B")

    def block(self, rows: int) -> Array:
        """Return a view of the next ``rows`` rows, to be filled before the next block or commit."""
        start, self._count = self._count, self._count + rows
        if self._count > self._room:
            self._grow(start)
        return self._buffer[start : self._count]

    def add(self, *values: float) -> None:
        """Fill the next row."""
        start = self._count
        self._count = start + 1
        if start >= self._room:
            self._grow(start)
        self._fill(self._bytes, start * self._row_bytes, *values)

    def _grow(self, filled: int) -> None:
        """Make room for all counted rows, and keep the rows that have been ``filled``."""
        more = np.empty((max(self._count, 2 * self._room), self._buffer.shape[1]))
        more[:filled] = self._buffer[:filled]  # the system allocates the rest when it is filled
        self._hold(more)

    def give_back(self, rows: int) -> None:
        """Take back the last ``rows`` rows of the latest block, which have not been filled."""
        self._count -= rows

    @property
    def filled(self) -> Rows:
        """The rows filled so far that are in memory (a view), with columns by name."""
        return self._buffer[: self._count].view(self._type)[:, 0]

    @property
    def whole(self) -> Rows | StoredRows:
        """All rows filled so far; those that left the memory are read again unless too many."""
        if self._stored is None:
            return self.filled
        return self._stored.with_rest(self.filled).unless_long()

    def append_new(self, records: list[bytes | memoryview]) -> None:
        """Append the rows that the journal does not have yet."""
        start, end = self._journalled * self._row_bytes, self._count * self._row_bytes
        if end > start:
            records.append(RECORD.pack(Kind.ROWS, self._number, end - start))
            self._record = len(records)
            records.append(self._bytes[start:end])
            self._journalled = self._count

    def leave(self, records: Sequence[bytes | memoryview], begin: int) -> None:
        """Let the rows leave the memory: ``records`` begin at ``begin`` in the file."""
        if self._stored is not None and self._count:
            place = begin + sum(map(len, records[: self._record]))
            self._stored.append(place, self._count * self._row_bytes)
            self._count = self._journalled = 0


class NameTable:
    """Names as row entries: each has the index of its first appearance.

    Args:
        number: Number of the table in its journal.
    """

    def __init__(self, number: int = 0) -> None:
        self._number = number
        self._indices: dict[str, int] = {}
        self._new: list[str] = []

    def index(self, name: str) -> int:
        """Return the index of ``name``, which is a new one if the name is new."""
        known = self._indices.get(name)
        if known is not None:
            return known
        self._new.append(name)
        return self._indices.setdefault(name, len(self._indices))

    @property
    def names(self) -> tuple[str, ...]:
        """All names, by index."""
        return tuple(self._indices)

    def append_new(self, records: list[bytes | memoryview]) -> None:
        """Append the names that the journal does not have yet."""
        if self._new:
            records += _json_record(Kind.NAMES, self._number, self._new)
            self._new.clear()


class Journal:
    """The tables of one run.

    Args:
        folder: Folder in which the journal is kept, or None to keep nothing.
        heartbeat: Heartbeat of the run, or None to make one in the folder.

    Attributes:
        heartbeat: Progress of the run.
        failure: Reason why journalling stopped; empty while it works.
    """

    def __init__(self, folder: Path | None, heartbeat: Heartbeat | None = None) -> None:
        self.failure = ""
        self._folder = folder
        self._names: list[NameTable] = []
        self._rows: list[JournalRows] = []
        self._file: FileIO | None = None
        self._leaving: list[JournalRows] = []
        self._size = 0  # bytes in the file
        self._records: list[bytes | memoryview] = [MAGIC]
        try:
            self.heartbeat = heartbeat or Heartbeat(folder)
            if folder is not None:
                self._file = (folder / ROWS_FILE).open("xb", buffering=0)
        except OSError as error:
            self.heartbeat = Heartbeat(None)
            self._give_up(error)

    def rows(self, name: str, columns: Sequence[str], *, stored: bool = False) -> JournalRows:
        """Add a table of rows with these columns; ``stored`` ones leave the memory when written."""
        place = None
        if stored and self._folder is not None:
            place = StoredRows(self._folder / ROWS_FILE, row_type(columns))
        rows = JournalRows(columns, len(self._rows), place)
        declaration = {"name": name, "columns": list(columns), "stored": stored}
        self._records += _json_record(Kind.ROWS_TABLE, len(self._rows), declaration)
        self._rows.append(rows)
        if place is not None:
            self._leaving.append(rows)
        return rows

    def names(self, name: str) -> NameTable:
        """Add a table of names."""
        names = NameTable(len(self._names))
        self._records += _json_record(Kind.NAME_TABLE, len(self._names), name)
        self._names.append(names)
        return names

    def write_meta(self, meta: dict[str, Any]) -> None:
        """Keep the facts about the run as JSON; a later call replaces them."""
        if self._folder is None:
            return
        new = self._folder / f"{META_FILE}.new"
        try:
            new.write_text(json.dumps(signed(meta)), encoding="utf-8")
            new.replace(self._folder / META_FILE)
        except OSError as error:
            self._give_up(error)

    def commit(self) -> None:
        """Hand all new rows to the operating system; called once per control step."""
        if self._file is None:
            return
        records = self._records
        for names in self._names:  # names come before the rows that refer to them
            names.append_new(records)
        for rows in self._rows:
            rows.append_new(records)
        if not records:
            return
        records.append(_COMMIT)
        content = b"".join(records)
        try:
            _write(self._file, content)
        except OSError as error:
            self._give_up(error)
        else:
            for rows in self._leaving:
                rows.leave(records, self._size)
            self._size += len(content)
        records.clear()

    def close(self) -> None:
        """Commit, and close the file."""
        self.commit()
        if self._file is not None:
            self._file.close()
            self._file = None

    def _give_up(self, error: OSError) -> None:
        self.failure = (
            f"{error.filename or self._folder}: the journal cannot be written ({error.strerror}); "
            f"the run goes on, but a crash would lose its rows; {remedy(error)} (TMPDIR)"
        )
        file, self._file = self._file, None
        if file is not None:
            with contextlib.suppress(OSError):
                file.close()


def _json_record(kind: Kind, table: int, content: object) -> list[bytes]:
    payload = json.dumps(content).encode("ascii")
    return [RECORD.pack(kind, table, len(payload)), payload]


def _write(file: FileIO, content: bytes) -> None:
    """Write all of it, since the system may take less at a time."""
    written = file.write(content)
    while written < len(content):
        content = content[written:]
        written = file.write(content)
