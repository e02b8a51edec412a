"""The program ``giveway``: it builds and runs one command, whose end becomes an exit code."""

import io
import os
import sys
from collections.abc import Sequence

from giveway._environment import out_of_memory
from giveway.cli.exit import fail
from giveway.errors import GivewayError
from giveway.processes.interrupts import RaisedSignals, exit_code_of, who_ended

_NO_THREAD = "can't start new thread"  # Python's message, which has no exception class of its own


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with its code."""
    words = (sys.argv[1:] if arguments is None else list(arguments)) or ["--help"]
    try:
        with RaisedSignals():
            code = _run(words)
    except GivewayError as error:
        code = fail(str(error), error.exit_code)
    except KeyboardInterrupt as error:
        code = fail(who_ended(error), exit_code_of(error))
    except BrokenPipeError:  # the reader of the output has ended
        # the remaining output is dropped
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = 1
    except (MemoryError, OSError, ImportError) as error:
        if out_of_memory(error):
            code = fail("out of memory; free memory, or raise the limit (ulimit -v)", 1)
        elif isinstance(error, OSError):
            code = fail(_named(error), 1)
        else:
            raise
    except Exception as error:
        if hasattr(error, "format_message"):
            said = _renamed(words) or f"{error.format_message()} See giveway --help."
            code = fail(said, 2)  # a usage error
        elif str(error) == _NO_THREAD:
            code = fail(
                "the system gives no more threads; end other processes, or raise the limit "
                "(ulimit -u)",
                1,
            )
        else:
            raise  # a defect of giveway: its traceback is shown
    sys.exit(code)


def _renamed(words: Sequence[str]) -> str | None:
    """Return the message about the first flag that no longer exists, or None."""
    from giveway.config.renamed import renamed_flag

    for word in words:
        instead = renamed_flag(word) if word.startswith("--") else None
        if instead is not None:
            return f"{word.partition('=')[0]}: no longer exists; {instead}"
    return None


def _named(error: OSError) -> str:
    """Return an error of the system with the file that it concerns, or the output."""
    where = "output" if error.filename is None else error.filename
    return f"{where}: {error.strerror or error}"


def _run(words: list[str]) -> int:
    """Run the command and return its exit code."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal may lack some characters
    from giveway.cli.app import invoke

    return invoke(words)
