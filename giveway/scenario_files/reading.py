"""Scenario files as streams of bytes, compressed or not."""

import gzip
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, cast

_CHUNK = 1 << 22  # Size of one read [bytes]
_JUDGED = 1 << 28  # Unpacked size [bytes] from which a gzip file is judged
_MOST_USUAL = 100  # Unpacked bytes for each packed one; SUMO's files have 10 to 40
_MOST_PACKED = 1032  # The same, the most that gzip can do
_GZIP = b"\x1f\x8b"  # first bytes of gzip files; SUMO looks at the content, too, not at the name


def is_bomb(path: Path) -> bool:
    """Return whether a gzip file unpacks to far more than its size, as no scenario's file does.

    Raises:
        OSError: the file cannot be read.
    """
    with path.open("rb") as raw:
        if raw.read(2) != _GZIP or path.stat().st_size * _MOST_PACKED < _JUDGED:
            return False
        raw.seek(0)
        unpacked = 0
        with gzip.open(raw) as stream, suppress(EOFError, zlib.error, gzip.BadGzipFile):
            while unpacked < _JUDGED and (piece := stream.read(_CHUNK)):
                unpacked += len(piece)
        return unpacked >= _JUDGED and unpacked > _MOST_USUAL * raw.tell()


@contextmanager
def opened(path: Path) -> Iterator[IO[bytes]]:
    """Open a file; gzip content is decompressed.

    Raises:
        OSError: the file cannot be read.
        EOFError: the compressed content is cut off.
    """
    with path.open("rb") as raw:
        compressed = raw.read(2) == _GZIP
        raw.seek(0)
        if not compressed:
            yield raw
            return
        with gzip.open(raw) as stream:
            yield cast("IO[bytes]", stream)


def pieces(path: Path) -> Iterator[bytes]:
    """Yield the content of a file in large pieces that begin and end between two tags.

    Raises:
        OSError: the file cannot be read.
        EOFError: the compressed content is cut off.
    """
    with opened(path) as stream:
        rest = b""
        while chunk := stream.read(_CHUNK):
            text = rest + chunk
            cut = text.rfind(b"<")  # an element may go on in the next chunk
            whole, rest = (text[:cut], text[cut:]) if cut > 0 else (b"", text)
            yield whole
        yield rest
