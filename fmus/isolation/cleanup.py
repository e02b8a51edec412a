"""The removal of processes and folders that an FMU leaves behind."""

import os
import shutil
import signal
import subprocess
from contextlib import suppress
from pathlib import Path
from time import sleep
from typing import Final

# Name of the file with the messages of the vehicle's watchdog, in the vehicle's folder
LOG: Final = "watchdog.log"
_ROUNDS: Final = 50  # Number of searches for processes, since killed ones may have started others
_PAUSE: Final = 0.02  # [s] time for killed processes to disappear


def scratch_of(folder: Path) -> Path:
    """Return the folder in which an FMU's processes work, which is also their TMPDIR.

    Args:
        folder: Temporary folder of the vehicle.
    """
    return folder / "scratch"


def kill_marked(folder: Path) -> None:
    """Kill the processes that were started with a vehicle's TMPDIR, however they hid (Linux).

    This is the last resort, for a watchdog that is dead and cannot kill them.
    """
    mark = b"TMPDIR=" + os.fsencode(scratch_of(folder)) + b"\0"
    for _round in range(_ROUNDS):
        found = [place for place in Path("/proc").glob("[0-9]*/environ") if _holds(place, mark)]
        if not found:
            return
        for place in found:
            with suppress(OSError):
                os.kill(int(place.parent.name), signal.SIGKILL)
        sleep(_PAUSE)


def _holds(place: Path, mark: bytes) -> bool:
    try:
        return mark in place.read_bytes() + b"\0"
    except OSError:  # the process has ended, or belongs to another user
        return False


def remove(folder: Path) -> None:
    """Remove a folder, whatever an FMU has created in it or put in its place."""
    with suppress(OSError):
        if folder.is_symlink() or not folder.is_dir():
            folder.unlink()
            return
    try:
        _make_accessible(folder)
        shutil.rmtree(folder, ignore_errors=True)
    except RecursionError:  # folders nested so deeply that no path can name them
        with suppress(OSError):
            subprocess.run(["rm", "-rf", "--", folder], stderr=subprocess.DEVNULL, check=False)


def _make_accessible(folder: Path) -> None:
    """Give this process access to all folders inside, which the FMU's umask may have denied."""
    for place, names, _files in os.walk(folder):
        for inner in (Path(place, name) for name in names):
            with suppress(OSError):
                if not inner.is_symlink():
                    inner.chmod(0o700)
