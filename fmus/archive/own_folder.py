"""Temporary folders that are locked while they are in use.

A process that is killed leaves its folders behind. The system has released their locks, so that the
next process knows that nobody uses them, also if a container has other process ids.
"""

import contextlib
import os
import shutil
import stat
import sys
import tempfile
import weakref
from collections.abc import Iterator
from pathlib import Path
from typing import Final

_swept: Final[set[tuple[str, Path]]] = set()


class OwnFolder:
    """A temporary folder of this process.

    The first one of a kind removes those that killed processes have left.

    Args:
        prefix: Beginning of its name, which tells its kind.
        place: Folder in which it is made, or None for the system's folder for temporary files.

    Attributes:
        name: Path of the folder.

    Raises:
        OSError: the folder cannot be made.
    """

    name: str

    def __init__(self, prefix: str, place: Path | None = None) -> None:
        place = place or Path(tempfile.gettempdir())
        if (prefix, place) not in _swept:
            _swept.add((prefix, place))
            _sweep(prefix, place)
        path = fresh_name(prefix, place)
        self.name, self._lock = str(path), list[int]()
        self._owner = os.getpid()
        self._gone = weakref.finalize(self, _remove, self.name, self._lock, self._owner)
        _make(path, self._lock)

    def __enter__(self) -> str:
        return self.name

    def __exit__(self, *_: object) -> None:
        self.cleanup()

    def cleanup(self) -> None:
        """Remove the folder; a second call does nothing."""
        if self._gone.alive:
            _remove(self.name, self._lock, self._owner)
            self._gone.detach()


def fresh_name(prefix: str, place: Path) -> Path:
    """Return a path that nobody has used.

    Who names a folder before it is made can remove it, even if a signal comes in between.
    """
    return place / f"{prefix}{os.urandom(6).hex()}"


def _make(folder: Path, lock: list[int]) -> None:
    """Make a folder, and put the handle of its lock into ``lock``; nothing without locks."""
    while True:
        folder.mkdir(mode=0o700)
        handle = _locked(folder)
        if handle is None:
            return
        # another process may have taken it for a folder that was left, just before it was locked
        if os.fstat(handle).st_nlink:
            lock.append(handle)
            return
        os.close(handle)


def _locked(folder: Path, *, wait: bool = True) -> int | None:
    """Return the handle of a folder that is now locked, or None if it cannot be locked."""
    if sys.platform == "win32":
        return None
    import fcntl

    handle = None
    try:
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:  # it is in use, it has gone, or the disk knows no such locks
        if handle is not None:
            os.close(handle)
        return None
    return handle


def _sweep(prefix: str, place: Path) -> None:
    """Remove the folders of a kind whose processes have ended without removing them."""
    for folder in _own_folders(prefix, place):
        lock = _locked(folder, wait=False)
        if lock is not None:
            _remove(str(folder), [lock], os.getpid())


def _own_folders(prefix: str, place: Path) -> Iterator[Path]:
    """Yield the folders of a kind that belong to this user."""
    with contextlib.suppress(OSError):
        for folder in place.glob(f"{prefix}*"):
            about = folder.lstat()
            own = about.st_uid == getattr(os, "getuid", lambda: 0)()
            if own and stat.S_ISDIR(about.st_mode):
                yield folder


def _remove(name: str, lock: list[int], owner: int) -> None:
    """Remove a folder, also if a signal interrupts this, and release its lock."""
    if os.getpid() != owner:  # a fork of the process that uses it
        return
    try:
        shutil.rmtree(name, ignore_errors=True)
    except BaseException:
        shutil.rmtree(name, ignore_errors=True)
        raise
    finally:
        while lock:
            os.close(lock.pop())
