"""The folder into which FMUs are unpacked: one from which libraries can be loaded."""

import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

from fmus.errors import FmuFileError


def unpacking_place() -> Path:
    """Return the folder for temporary files, or another one if nothing may be executed in it.

    Raises:
        FmuFileError: there is no such folder.
    """
    usual = Path(tempfile.gettempdir())
    for place in (usual, *_others()):
        if not _forbids_libraries(place) and os.access(place, os.W_OK | os.X_OK):
            return place
    raise FmuFileError(
        f"{usual}: mounted with noexec, so that no FMU's library can be loaded from it; name "
        "another folder in TMPDIR"
    )


def place_note() -> str:
    """Return the remark that the folder for temporary files is not used, or an empty text."""
    usual = Path(tempfile.gettempdir())
    if not _forbids_libraries(usual):
        return ""
    return f"TMPDIR {usual} is mounted with noexec: the FMU was unpacked in {unpacking_place()}"


def _others() -> Iterator[Path]:
    yield from map(Path, ("/var/tmp", "/tmp"))
    yield Path.home() / ".cache"
    yield Path.cwd()


def _forbids_libraries(place: Path) -> bool:
    """Return whether a folder is mounted so that no program of it may be executed."""
    if not hasattr(os, "ST_NOEXEC"):
        return False
    try:
        return bool(os.statvfs(place).f_flag & os.ST_NOEXEC)
    except OSError:
        return True
