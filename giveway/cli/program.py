"""The program ``giveway``: it builds and runs one command, whose end becomes an exit code."""

from __future__ import annotations

import io
import sys
from typing import TYPE_CHECKING

from giveway.cli.exit import INTERRUPTED, fail
from giveway.errors import GivewayError

if TYPE_CHECKING:
    from collections.abc import Sequence


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with its code."""
    from giveway.cli.app import build_app

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal may lack our characters
    words = (sys.argv[1:] if arguments is None else list(arguments)) or ["--help"]
    try:
        code = build_app(words)(args=words, standalone_mode=False)
    except GivewayError as error:
        code = fail(str(error), error.exit_code)
    except KeyboardInterrupt:
        code = fail("interrupted", INTERRUPTED)
    except BrokenPipeError:
        code = 1  # the reader of our output has ended
    except OSError as error:
        code = fail(f"output: {error.strerror or error}", 1)
    except Exception as error:
        if not hasattr(error, "format_message"):
            raise  # a fault of giveway: the traceback is wanted
        code = fail(f"{error.format_message()} See giveway --help.", 2)  # a usage error
    sys.exit(code if isinstance(code, int) else 0)
