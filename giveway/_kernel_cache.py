"""Where compiled kernels are kept: by what they are, not by where or when they were installed.

Numba's own cache knows a kernel by the path of its file, and looks at this file alone: it would
compile again for every environment, and load stale code where a kernel that is inlined into
another has changed. Ours is one folder for each content of all kernels, in the user's cache and not
in the package folder, which may be read-only.
"""

import functools
import hashlib
import os
import re
import sys
import tempfile
from pathlib import Path

import llvmlite
import numba
from numba.core.caching import UserProvidedCacheLocator

from giveway._environment import user_cache

FOLDERS = "kernels-*"
_HOUSE = Path(__file__).resolve().parent.parent
_OF_KERNELS = ("controller", "pedestrian_model")  # rooms whose constants go into kernels, too
_KERNEL = re.compile(rb"^@kernel|^def kernel\b", re.MULTILINE)


@functools.cache
def kernel_digest() -> str:
    """A text that changes with the content of any file that holds kernels, and with the compiler.

    The CPU is not in it: numba looks at that itself.
    """
    compiler = (*sys.version_info[:2], numba.__version__, llvmlite.__version__)
    digest = hashlib.sha256(repr(compiler).encode())
    for room in (*_OF_KERNELS, "giveway"):
        for path in sorted((_HOUSE / room).rglob("*.py")):
            content = path.read_bytes()
            if room in _OF_KERNELS or _KERNEL.search(content):
                digest.update(path.relative_to(_HOUSE).as_posix().encode() + content)
    return digest.hexdigest()[:12]


@functools.cache
def kernel_cache() -> Path:
    """The folder of the present kernels.

    It lies in ``NUMBA_CACHE_DIR`` if the user has set it, else in the user's cache, and if that
    cannot be written, in the folder for temporary files.
    """
    name = FOLDERS.replace("*", kernel_digest())
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    if chosen:
        return Path(chosen) / name
    folder = user_cache() / name
    existing = next(parent for parent in (folder, *folder.parents) if parent.exists())
    if os.access(existing, os.W_OK | os.X_OK):
        return folder
    user = os.getuid() if hasattr(os, "getuid") else "user"
    return Path(tempfile.gettempdir()) / f"giveway-{user}" / name


class KernelLocator(UserProvidedCacheLocator):
    """Tells numba where it finds and keeps a kernel of ours; of other functions it says nothing."""

    def __init__(self, py_func: object, py_file: str) -> None:
        super().__init__(py_func, py_file)  # type: ignore[no-untyped-call]
        self._cache_path = str(kernel_cache() / ".".join(_place(py_file).parts[:-1]))

    def get_source_stamp(self) -> str:
        """What the compiled code was made from: all kernels, since some are inlined into others."""
        return kernel_digest()

    @classmethod
    def from_function(cls, py_func: object, py_file: str) -> "KernelLocator | None":
        """The locator of a kernel; None for somebody else's function."""
        if _place(py_file).parts[0] not in (*_OF_KERNELS, "giveway"):
            return None
        locator = cls(py_func, py_file)
        try:
            locator.ensure_cache_path()  # type: ignore[no-untyped-call]
        except OSError:
            return None
        return locator


def _place(py_file: str) -> Path:
    """A module's path as seen from the folder of our packages."""
    path = Path(py_file).resolve()
    return path.relative_to(_HOUSE) if path.is_relative_to(_HOUSE) else path
