"""The start of Python interpreters that run a module of this package, and their end."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from fmus.errors import FmuCrashError
from fmus.isolation.cleanup import scratch_of
from fmus.isolation.exit_report import PrintedTail

IMPORT_TIMEOUT: Final = 120.0  # [s] time for the imports on the busiest machine
END_TIMEOUT: Final = 10.0  # [s] time for a killed process to end, on any sound system
_BOOT: Final = (
    "import gc, json, sys; gc.disable(); sys.path[:], arguments = json.loads(sys.argv[1]); "
    "from fmus.isolation.{module} import main; main(*arguments)"
)


def spawn(
    path: Path,
    module: str,
    *arguments: object,
    folder: Path,
    output: Any,
    pass_fds: Sequence[int] = (),
) -> subprocess.Popen[bytes]:
    """Start an interpreter like this one that runs ``main`` of a module of this package.

    Args:
        path: Path of the FMU, for errors.
        module: Name of the module in this package.
        arguments: Arguments of its ``main``: numbers and texts.
        folder: Temporary folder of the vehicle.
        output: File for the output of the interpreter.
        pass_fds: File descriptors that it inherits.

    Raises:
        FmuCrashError: the interpreter cannot be started.
    """
    scratch = str(scratch_of(folder))
    values = [a if isinstance(a, int) else str(a) for a in arguments]
    flags = {
        "-E": sys.flags.ignore_environment,
        "-s": sys.flags.no_user_site,
        "-B": sys.flags.dont_write_bytecode,
    }
    given = json.dumps([[_absolute(entry) for entry in sys.path], values])
    # -P: nothing is imported from the working directory before our paths are set
    try:
        return subprocess.Popen(
            [sys.executable, "-P", *(flag for flag, on in flags.items() if on)]
            + ["-c", _BOOT.format(module=module), given],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            cwd=scratch,
            env=os.environ | {"TMPDIR": scratch},
            pass_fds=pass_fds,
            start_new_session=True,  # Ctrl-C in the terminal must not reach it
            creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),  # the same on Windows
        )
    except OSError as error:
        raise no_process(path, str(error).encode()) from None


def _absolute(entry: str) -> str:
    """Return an entry of sys.path as an absolute path; other entries (import hooks) stay."""
    return str(Path(entry).absolute()) if Path(entry).exists() else entry


def kill_group(process: subprocess.Popen[bytes]) -> None:
    """Kill a process, and its group where there are groups, and wait for its end."""
    with suppress(OSError):
        if sys.platform == "win32":
            process.kill()
        else:
            os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def no_process(path: Path, printed: bytes) -> FmuCrashError:
    """Return the error that no process can be started, with the last line of its output."""
    tail = PrintedTail()
    tail.add(printed)
    reason = tail.last_line() or "it ended at once"
    return FmuCrashError(f"{path}: no process of its own can be started for the FMU: {reason}")
