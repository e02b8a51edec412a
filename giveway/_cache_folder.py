"""The folder in which giveway keeps what it has made: code and numbers that it trusts later.

A folder is used only if it and its parents belong to the user or root, and nobody else may write
there. Others may write in a sticky folder on the way, as /tmp is: they cannot replace what belongs
to somebody else.
"""

import atexit
import contextlib
import functools
import os
import shutil
import stat
import sys
import tempfile
from pathlib import Path
from typing import Final

CHOICE: Final = "NUMBA_CACHE_DIR"  # Environment variable with which a user names a folder
PREFIX: Final = "giveway-cache-"
_SHARED: Final = "GIVEWAY_CACHE"  # Environment variable that names a fresh folder to children
_MANY: Final = 1000  # Number of entries that are kept
LOST: Final = "what is compiled is lost when this process ends"


def objection(folder: Path, *, named: bool = False) -> str:
    """Return why nothing is trusted in a folder, or ""; the folder is made if it is missing.

    Args:
        folder: Folder to examine.
        named: True if the user has named it; it may then belong to another user.
    """
    folder = folder.absolute().resolve()
    private = False
    for place in (*reversed(folder.parents), folder):
        try:
            place.mkdir(0o755 if named else 0o700, exist_ok=True)
            about = place.stat()
        except OSError as error:
            return f"{place} cannot be made ({error.strerror})"
        if not hasattr(os, "getuid"):
            continue
        if about.st_uid not in {0, os.getuid()} and not named:
            return f"{place} belongs to another user"
        private = private or not about.st_mode & (stat.S_IRWXG | stat.S_IRWXO)
        shared = about.st_mode & (stat.S_IWGRP | stat.S_IWOTH) and not private
        if shared and (place == folder or not about.st_mode & stat.S_ISVTX):
            return f"others may write in {place}"
    return ""


def user_cache() -> Path:
    """Return giveway's folder in the user's cache, which may not exist or not be safe."""
    from platformdirs import user_cache_path

    shared = os.environ.get(_SHARED)
    return Path(shared) if shared else user_cache_path("giveway", appauthor=False)


@functools.cache
def cache_folder() -> Path:
    """Return giveway's folder in the user's cache if it is safe, else a fresh one."""
    folder = user_cache()
    why = objection(folder)
    if not why and os.access(folder, os.W_OK):
        return folder
    return fresh_folder(why or f"{folder} cannot be written")


def fresh_folder(why: str) -> Path:
    """Return a private folder for this process and its children, after a note that says ``why``."""
    fresh = _private_folder()
    remark(f"{why}: {LOST}; name a folder of your own in {CHOICE}")
    return fresh


@functools.cache
def _private_folder() -> Path:
    fresh = Path(tempfile.gettempdir()) / f"{PREFIX}{os.urandom(6).hex()}"
    atexit.register(shutil.rmtree, fresh, ignore_errors=True)
    fresh.mkdir(mode=0o700)
    os.environ[_SHARED] = str(fresh)
    return fresh


def forget_oldest(folder: Path) -> None:
    """Remove the entries of a folder that were written first, if there are many."""
    with contextlib.suppress(OSError):  # another process may do the same
        for entry in sorted(folder.iterdir(), key=lambda entry: entry.stat().st_mtime)[:-_MANY]:
            if entry.is_dir():
                shutil.rmtree(entry)
            else:
                entry.unlink()


@functools.cache
def remark(line: str) -> None:
    """Print a note once, on standard error."""
    sys.stderr.write(f"note: {line}\n")
