"""Rows that stay in a journal's file, since a long run has too many for the memory."""

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from giveway.gate import opened

Rows = NDArray[np.void]
"""Rows (n,) of float64 whose columns have names: ``rows["speed"]`` is one of them."""

LONG = 1_000_000
"""Largest number of rows that are read at once: 48 MB of the crowd's."""
PIECE = 250_000
"""Number of rows from which on a piece is complete."""


class StoredRows:
    """Rows in a file, in blocks that were written at one time, and the rest in memory.

    Args:
        file: File of the journal.
        row: Type of a row.
        rest: Rows behind those in the file.
        blocks: Place and number of rows of each block, in order.

    Attributes:
        row: Type of a row.
    """

    def __init__(
        self,
        file: Path,
        row: np.dtype[np.void],
        rest: Rows | None = None,
        blocks: Sequence[tuple[int, int]] = (),
    ) -> None:
        self._file, self.row = file, row
        self._rest = np.empty(0, row) if rest is None else rest
        self._blocks = list(blocks)
        self._count = sum(rows for _, rows in blocks)

    def __len__(self) -> int:
        return self._count + len(self._rest)

    def append(self, place: int, size: int) -> None:
        """Note a block of ``size`` bytes that begins at ``place`` in the file.

        Raises:
            ValueError: these are no whole rows.
        """
        rows, more = divmod(size, max(self.row.itemsize, 1))
        if more or not self.row.itemsize:
            raise ValueError("no whole rows")
        self._blocks.append((place, rows))
        self._count += rows

    def with_rest(self, rest: Rows) -> "StoredRows":
        """Return these rows, and the ``rest`` behind them."""
        return StoredRows(self._file, self.row, rest, self._blocks)

    def unless_long(self) -> "Rows | StoredRows":
        """Return the rows in memory, or this object if there are too many."""
        return self if len(self) > LONG else self.read()

    def read(self) -> Rows:
        """Return all rows in memory."""
        return np.concatenate([np.empty(0, self.row), *self.pieces()])

    def pieces(self) -> Iterator[Rows]:
        """Yield all rows in order, whole blocks at a time.

        Raises:
            OSError: the file cannot be read.
        """
        if self._blocks:
            with opened(self._file, largest=sys.maxsize) as file:
                begin = rows = 0
                for end, (_, more) in enumerate(self._blocks, start=1):
                    rows += more
                    if rows >= PIECE or end == len(self._blocks):
                        yield self._read(file, self._blocks[begin:end], rows)
                        begin, rows = end, 0
        if len(self._rest):
            yield self._rest

    def _read(self, file: BinaryIO, blocks: Sequence[tuple[int, int]], rows: int) -> Rows:
        piece, at = np.empty(rows, self.row), 0
        content = memoryview(piece.view(np.uint8).data)
        for place, more in blocks:
            size = more * self.row.itemsize
            file.seek(place)
            file.readinto(content[at : at + size])  # type: ignore[attr-defined]
            at += size
        return piece
