"""Scenario files as streams of bytes, compressed or not."""

import gzip
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, cast

_CHUNK = 1 << 22  # Size of one read [bytes]
_GZIP = b"\x1f\x8b"  # first bytes of gzip files; SUMO looks at the content, too, not at the name


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
