"""The command of a Python process with the same imports as this one."""

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

_PATHS: Final = (
    "import gc, json, sys; gc.set_threshold(50_000, 20, 100); "  # of imports, most stays
    "sys.path[:], arguments = json.loads(sys.argv[1]); "
)


def command(code: str, arguments: Sequence[float | str]) -> list[str]:
    """Return the command of an interpreter like this one, with its flags and ``sys.path``.

    Args:
        code: Code to run, in which the name ``arguments`` is defined.
        arguments: Arguments for the code; they pass through JSON.
    """
    flags = {
        "-E": sys.flags.ignore_environment,
        "-s": sys.flags.no_user_site,
        "-B": sys.flags.dont_write_bytecode,
    }
    given = json.dumps([[_absolute(entry) for entry in sys.path], arguments])
    # -P: nothing is imported from the working directory before the paths are set
    chosen = [flag for flag, on in flags.items() if on]
    return [sys.executable, "-P", *chosen, "-c", _PATHS + code, given]


def _absolute(entry: str) -> str:
    """Return an entry of sys.path as an absolute path; entries of import hooks stay unchanged."""
    return str(Path(entry).absolute()) if Path(entry).exists() else entry
