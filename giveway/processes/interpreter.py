"""Starting a Python process that imports what this one would."""

import json
import sys
from pathlib import Path
from typing import Final

_PATHS: Final = "import json, sys; sys.path[:], arguments = json.loads(sys.argv[1]); "


def command(code: str, arguments: list[int | str]) -> list[str]:
    """The command line of an interpreter like this one, with its flags and its ``sys.path``.

    Args:
        code: what it runs; ``arguments`` is a name there.
        arguments: Arguments for the code.
    """
    flags = {
        "-E": sys.flags.ignore_environment,
        "-s": sys.flags.no_user_site,
        "-B": sys.flags.dont_write_bytecode,
    }
    given = json.dumps([[_absolute(entry) for entry in sys.path], arguments])
    # -P: nothing is imported from the working directory before our paths are set
    chosen = [flag for flag, on in flags.items() if on]
    return [sys.executable, "-P", *chosen, "-c", _PATHS + code, given]


def _absolute(entry: str) -> str:
    """An entry of sys.path as an absolute path; those of import hooks are returned unchanged."""
    return str(Path(entry).absolute()) if Path(entry).exists() else entry
