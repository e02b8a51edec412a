"""The reading of a SUMO network file as a stream, gzipped or not."""

import gzip
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol
from xml.parsers import expat

from giveway.errors import ScenarioError

_GZIP_MAGIC = b"\x1f\x8b"


class _Stream(Protocol):
    """A stream that expat reads from."""

    def read(self, size: int = ..., /) -> bytes: ...


def read_network(net_file: Path, handlers: Mapping[str, Callable[[dict[str, str]], None]]) -> None:
    """Call a handler with the attributes of each element that has one.

    Args:
        net_file: Path of the network.
        handlers: Handlers by the elements' names. They may raise ``KeyError`` for a missing
            attribute and ``ValueError`` for a bad value.

    Raises:
        ScenarioError: the file is unreadable, damaged, or no SUMO network.
    """
    reader = _Reader(handlers)
    try:
        with net_file.open("rb") as raw:
            zipped = raw.read(2) == _GZIP_MAGIC
            raw.seek(0)
            with gzip.GzipFile(fileobj=raw) if zipped else raw as stream:
                reader.read(stream)
    except OSError as error:
        # Errors of gzip are OSErrors without a strerror.
        raise ScenarioError(
            f"{net_file}: the network cannot be read: {error.strerror or error}"
        ) from error
    except (EOFError, zlib.error) as error:
        raise ScenarioError(
            f"{net_file}: the network's gzip is damaged ({error}); write it again"
        ) from error
    except expat.ExpatError as error:
        raise ScenarioError(
            f"{net_file}: not XML ({error}); expected a SUMO network, made by netconvert"
        ) from error
    except (KeyError, ValueError) as error:
        reason = f"attribute {error} is missing" if isinstance(error, KeyError) else str(error)
        raise ScenarioError(
            f"{net_file}: line {reader.line}: {reason}; expected a SUMO network, made by netconvert"
        ) from error
    if not reader.is_network:
        raise ScenarioError(
            f"{net_file}: no <net> in it; expected a SUMO network, made by netconvert"
        )


class _Reader:
    """Passes start tags to handlers."""

    def __init__(self, handlers: Mapping[str, Callable[[dict[str, str]], None]]) -> None:
        self.is_network = False
        self._handlers = handlers
        self._parser = expat.ParserCreate()
        self._parser.buffer_text = True
        self._parser.StartElementHandler = self._start

    def read(self, stream: _Stream) -> None:
        self._parser.ParseFile(stream)

    @property
    def line(self) -> int:
        return self._parser.CurrentLineNumber

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self.is_network = self.is_network or tag == "net"
        handler = self._handlers.get(tag)
        if handler is not None:
            handler(attributes)
