"""The reading of a journal, however the process that wrote it ended."""

import json
import mmap
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from giveway.errors import ResultsError
from giveway.gate import LARGEST_TABLE, LARGEST_TEXT, opened, read_json, require_no_link
from giveway.journal.journal import MAGIC, META_FILE, RECORD, ROWS_FILE, Kind, Rows, row_type
from giveway.processes.heartbeat import HEARTBEAT_FILE, Heartbeat, Pulse


@dataclass(frozen=True)
class JournalContents:
    """The contents of a journal.

    Attributes:
        meta: Facts about the run; empty if the run ended before they were written.
        tables: Rows (n,) of each table, by its name.
        names: Strings of each name table, by its name and in the order of their indices.
        commits: Number of whole steps found.
        pulse: Progress of the run when it last reported.
    """

    meta: dict[str, Any]
    tables: dict[str, Rows]
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
    with opened(rows_file, largest=LARGEST_TABLE) as stream:
        content = memoryview(mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ))
    # the process may have died while writing this
    begun = bytes(content[: len(MAGIC)]).rstrip(b"\0")
    if not MAGIC.startswith(begun):
        raise ResultsError(
            f"{rows_file}: is not a journal of giveway, or another version's ({MAGIC.decode()} "
            "expected at its start); the run has to be made again"
        )
    reader = _Reader()
    try:
        for step in _steps(content):
            reader.take(step)
        return JournalContents(meta, *reader.contents(), pulse)
    except (ValueError, LookupError, TypeError):
        raise _broken(rows_file) from None


def _broken(file: Path) -> ResultsError:
    return ResultsError(
        f"{file}: is broken, or another version of giveway wrote it; the run has to be made again"
    )


_Record = tuple[Kind, int, memoryview]


def _steps(content: memoryview) -> Iterator[list[_Record]]:
    """Yield the records of each whole step; a torn end is left out."""
    at, step = len(MAGIC), list[_Record]()
    while at + RECORD.size <= len(content):
        kind, table, size = RECORD.unpack_from(content, at)
        at += RECORD.size
        if kind == Kind.COMMIT:
            yield step
            step = []
            continue
        if kind not in Kind.__members__.values() or at + size > len(content):
            return
        step.append((Kind(kind), table, content[at : at + size]))
        at += size


class _Reader:
    """Puts the tables together from the records."""

    def __init__(self) -> None:
        self._columns: list[tuple[str, list[str]]] = []
        self._blocks: list[list[memoryview]] = []
        self._names: list[tuple[str, list[str]]] = []
        self._commits = 0

    def take(self, step: list[_Record]) -> None:
        self._commits += 1
        for kind, table, payload in step:
            if kind is Kind.ROWS:
                self._blocks[table].append(payload)
                continue
            value = json.loads(bytes(payload))
            if kind is Kind.ROWS_TABLE:
                self._columns.append((value["name"], value["columns"]))
                self._blocks.append([])
            elif kind is Kind.NAME_TABLE:
                self._names.append((value, []))
            else:
                self._names[table][1].extend(value)

    def contents(self) -> tuple[dict[str, Rows], dict[str, tuple[str, ...]], int]:
        tables = {
            name: np.frombuffer(bytearray().join(blocks), row_type(columns))
            for (name, columns), blocks in zip(self._columns, self._blocks, strict=True)
        }
        return tables, {name: tuple(names) for name, names in self._names}, self._commits
