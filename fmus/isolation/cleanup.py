"""What an FMU leaves behind, and how it is cleared away: processes and folders."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from contextlib import suppress
from pathlib import Path
from time import sleep
from typing import Final

_ROUNDS: Final = 50  # in which the killed may have had children
_PAUSE: Final = 0.02  # [s] for the killed to go


def scratch_of(folder: Path) -> Path:
    """Where an FMU's processes work, and what they have as TMPDIR.

    Args:
        folder: the vehicle's temporary one.
    """
    return folder / "scratch"


def kill_marked(folder: Path) -> None:
    """Kill the processes that began with a vehicle's TMPDIR, however they hid (Linux).

    It is for where nobody else can: when the process that is to bury them has been killed.
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
    except OSError:  # it has gone, or is somebody else's
        return False


def remove(folder: Path) -> None:
    """Remove a folder, whatever an FMU has made in it or put in its place."""
    with suppress(OSError):
        if folder.is_symlink() or not folder.is_dir():
            folder.unlink()
            return
    try:
        _make_accessible(folder)
        shutil.rmtree(folder, ignore_errors=True)
    except RecursionError:  # folders within each other that no path can name
        with suppress(OSError):
            subprocess.run(["rm", "-rf", "--", folder], stderr=subprocess.DEVNULL, check=False)


def _make_accessible(folder: Path) -> None:
    """What made the folders in it may have had a umask that forbids to enter them."""
    for place, names, _files in os.walk(folder):
        for inner in (Path(place, name) for name in names):
            with suppress(OSError):
                if not inner.is_symlink():
                    inner.chmod(0o700)
