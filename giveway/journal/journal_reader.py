"""The reading of a journal, however the process that wrote it ended."""

import json
import os
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

from giveway.errors import ResultsError
from giveway.gate import LARGEST_JOURNAL, LARGEST_TEXT, opened, read_json, require_no_link
from giveway.journal.journal import MAGIC, META_FILE, RECORD, ROWS_FILE, Kind, row_type
from giveway.journal.stored_rows import Rows, StoredRows
from giveway.processes.heartbeat import HEARTBEAT_FILE, Heartbeat, Pulse


@dataclass(frozen=True)
class JournalContents:
    """The contents of a journal.

    Attributes:
        meta: Facts about the run; empty if the run ended before they were written.
        tables: Rows (n,) of each table, by its name; a long one stays in the file.
        names: Strings of each name table, by its name and in the order of their indices.
        commits: Number of whole steps found.
        pulse: Progress of the run when it last reported.
    """

    meta: dict[str, Any]
    tables: dict[str, Rows | StoredRows]
    names: dict[str, tuple[str, ...]]
    commits: int
    pulse: Pulse


def read_journal(folder: Path) -> JournalContents:
    """Read a journal up to its last whole step, however its process ended.

    Raises:
        ResultsError: the folder holds something else.
        OSError: the file cannot be read.
    """
    meta_file, rows_file = folder / META_FILE, folder / ROWS_FILE
    try:
        meta = read_json(meta_file)
    except FileNotFoundError:
        meta = {}
    require_no_link(rows_file)
    with suppress(FileNotFoundError), opened(folder / HEARTBEAT_FILE, largest=LARGEST_TEXT):
        pass
    pulse = Heartbeat(folder).read()
    if not rows_file.exists() or not rows_file.stat().st_size:
        return JournalContents(meta, {}, {}, 0, pulse)
    with opened(rows_file, largest=LARGEST_JOURNAL) as stream:
        # the process may have died while writing this
        begun = stream.read(len(MAGIC)).rstrip(b"\0")
        if not MAGIC.startswith(begun):
            raise ResultsError(
                f"{rows_file}: is not a journal of giveway, or another version's "
                f"({MAGIC.decode()} expected at its start); the run has to be made again"
            )
        reader = _Reader(rows_file)
        try:
            for step in _steps(stream):
                reader.take(step)
            return JournalContents(meta, *reader.contents(), pulse)
        except (ValueError, LookupError, TypeError):
            raise _broken(rows_file) from None


def _broken(file: Path) -> ResultsError:
    return ResultsError(
        f"{file}: is broken, or another version of giveway wrote it; the run has to be made again"
    )


_Record = tuple[Kind, int, bytes, int, int]
"""Kind, table, payload unless it is rows, place and size of the payload in the file."""


def _steps(file: BinaryIO) -> Iterator[list[_Record]]:
    """Yield the records of each whole step; a torn end is left out."""
    length = file.seek(0, os.SEEK_END)
    at, step = file.seek(len(MAGIC)), list[_Record]()
    while at + RECORD.size <= length:
        kind, table, size = RECORD.unpack(file.read(RECORD.size))
        at += RECORD.size
        if kind == Kind.COMMIT:
            yield step
            step = []
            continue
        if kind not in Kind.__members__.values() or at + size > length:
            return
        payload = b"" if kind == Kind.ROWS else file.read(size)
        step.append((Kind(kind), table, payload, at, size))
        at = file.seek(at + size)


class _Reader:
    """Puts the tables together from the records.

    Args:
        file: File of the journal.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        self._tables: list[tuple[str, bool, StoredRows]] = []
        self._names: list[tuple[str, list[str]]] = []
        self._commits = 0

    def take(self, step: list[_Record]) -> None:
        self._commits += 1
        for kind, table, payload, place, size in step:
            if kind is Kind.ROWS:
                self._tables[table][-1].append(place, size)
                continue
            value = json.loads(payload)
            if kind is Kind.ROWS_TABLE:
                rows = StoredRows(self._file, row_type(value["columns"]))
                self._tables.append((value["name"], value["stored"], rows))
            elif kind is Kind.NAME_TABLE:
                self._names.append((value, []))
            else:
                self._names[table][1].extend(value)

    def contents(self) -> tuple[dict[str, Rows | StoredRows], dict[str, tuple[str, ...]], int]:
        tables = {
            name: rows.unless_long() if stored else rows.read()
            for name, stored, rows in self._tables
        }
        return tables, {name: tuple(names) for name, names in self._names}, self._commits
