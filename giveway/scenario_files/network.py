"""The reading of a SUMO network file as a stream, gzipped or not."""

import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from xml.parsers import expat

from giveway.errors import ScenarioError
from giveway.scenario_files.reading import opened


def read_network(net_file: Path, handlers: Mapping[str, Callable[[dict[str, str]], None]]) -> None:
    """Call a handler with the attributes of each element that has one.

    Args:
        net_file: Path of the network.
        handlers: Handlers by the elements' names. They may raise ``KeyError`` for a missing
            attribute and ``ValueError`` for a bad value.

    Raises:
        ScenarioError: the file is unreadable, damaged, or no SUMO network.
    """
    parser, found = expat.ParserCreate(), set[str]()
    parser.buffer_text = True

    def start(tag: str, attributes: dict[str, str]) -> None:
        found.add(tag)
        handler = handlers.get(tag)
        if handler is not None:
            handler(attributes)

    parser.StartElementHandler = start
    try:
        with opened(net_file) as stream:
            parser.ParseFile(stream)
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
        line = parser.CurrentLineNumber
        raise ScenarioError(
            f"{net_file}: line {line}: {reason}; expected a SUMO network, made by netconvert"
        ) from error
    if "net" not in found:
        raise ScenarioError(
            f"{net_file}: no <net> in it; expected a SUMO network, made by netconvert"
        )
