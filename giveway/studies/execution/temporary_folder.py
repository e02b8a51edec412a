"""The workers' temporary folder: heartbeats, outputs and temporary files."""

import itertools
import math
import os
import shutil
import tempfile
import time
import weakref
from contextlib import suppress
from pathlib import Path
from typing import Final

_PREFIX: Final = "giveway-workers-"
# Time [s] for which a folder is kept, since its owner may run in another container
_KEPT: Final = 86400.0


class Scratch:
    """A local temporary folder. Making one removes the folders of processes that were killed.

    Args:
        place: Folder in which it is made, or None for the system's folder for temporary files.

    Raises:
        OSError: the folder cannot be made.
    """

    def __init__(self, place: Path | None = None) -> None:
        place = place or Path(tempfile.gettempdir())
        _sweep(place)
        self._path = Path(tempfile.mkdtemp(prefix=f"{_PREFIX}{os.getpid()}-", dir=place))
        # A signal may come before the caller has the folder, so it is removed when the process
        # ends.
        self._gone = weakref.finalize(self, shutil.rmtree, self._path, ignore_errors=True)
        self._numbers = itertools.count(1)

    def folder(self) -> Path:
        """Return a path in the folder that has not been used before."""
        return self._path / str(next(self._numbers))

    def remove(self) -> None:
        """Remove the folder."""
        self._gone()


def _sweep(place: Path) -> None:
    with suppress(OSError):
        for folder in place.glob(f"{_PREFIX}*"):
            owner = folder.name.removeprefix(_PREFIX).partition("-")[0]
            if _is_gone(owner) and time.time() - _last_change(folder) > _KEPT:
                shutil.rmtree(folder, ignore_errors=True)


def _is_gone(process: str) -> bool:
    """Return whether there is no such process on this machine."""
    if os.name == "nt" or not process.isdigit():
        return True
    try:
        os.kill(int(process), 0)
    except ProcessLookupError:
        return True
    except OSError:
        return False
    return False


def _last_change(folder: Path) -> float:
    return max((entry.stat().st_mtime for entry in (folder, *folder.iterdir())), default=math.inf)
