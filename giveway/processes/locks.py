"""The lock of a folder for one process, until its end."""

import contextlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path


class FolderInUseError(Exception):
    """Another process has locked the folder."""


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Lock a folder. The lock belongs to the system, leaves no file, and ends with this process.

    On Windows, and on network disks without such locks, nothing is locked.

    Raises:
        FolderInUseError: another process has locked it.
        OSError: the folder cannot be opened.
    """
    if sys.platform == "win32":
        yield
        return
    import fcntl

    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)  # a pipe would not be opened
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise FolderInUseError from None
        except OSError:
            pass  # this disk knows no such locks
        yield
    finally:
        os.close(handle)


def in_use(folder: Path) -> bool:
    """Return whether another process has locked a folder.

    Raises:
        OSError: the folder cannot be opened.
    """
    try:
        with locked(folder):
            return False
    except FolderInUseError:
        return True
