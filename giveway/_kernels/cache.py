"""The cache of compiled kernels, by their content and not by place or time of installation.

Numba's own cache knows a kernel by the path of its file, and checks only this file. It would
compile again for every environment, and load stale code where a kernel that is inlined into another
has changed. Our cache is one folder for each content of all kernels. It is in the user's cache and
not in the package folder, which may be read-only.
"""

import functools
import hashlib
import os
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

import llvmlite
import numba
from numba.core import caching, environment
from numba.core.caching import UserProvidedCacheLocator
from numba.core.runtime.nrt import rtsys

from giveway._environment import user_cache

LINKED = numba.version_info.short in {(0, 68)}
"""Whether numba is of a version with which ``compiler`` and ``linking`` were tried.

They save 40 % of the processor time of the first start: 36 s instead of 60 s, measured with an
empty cache on two cores with numba 0.68; ``linking`` alone comes to 45 s. Any other version
compiles as ever, and the compiled code is the same.
"""
if LINKED:
    import giveway._kernels.compiler
    import giveway._kernels.linking  # noqa: F401 - what is compiled is linked as it says

FOLDERS = "kernels-*"
_LOCK = "saving.lock"
_HOUSE = Path(__file__).resolve().parents[2]
_OF_KERNELS = ("controller", "pedestrian_model")  # rooms whose constants go into kernels, too
_KERNEL = re.compile(rb"^@(?:kernel|unlocked|inner|inlined)\b|^def kernel\b", re.MULTILINE)


@functools.cache
def kernel_digest() -> str:
    """Return a text that changes with the content of files that hold kernels, and the compiler.

    The CPU is not part of it: numba checks that itself.
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
    """Tells numba the place of a kernel of ours, and nothing about other functions."""

    def __init__(self, py_func: Any, py_file: str) -> None:
        self._lineno = py_func.__code__.co_firstlineno
        self._cache_path = str(kernel_cache() / ".".join(_place(py_file).parts[:-1]))

    def ensure_cache_path(self) -> None:
        """Make the folder; whether it can be written is tried once for all kernels in it."""
        _ensure_writable(self._cache_path)

    def get_source_stamp(self) -> str:
        """Return the version of the compiled code: that of all kernels, since some are inlined."""
        return kernel_digest()

    @classmethod
    def from_function(cls, py_func: object, py_file: str) -> "KernelLocator | None":
        """Return the locator of a kernel, or None for a function of another package."""
        if _place(py_file).parts[0] not in (*_OF_KERNELS, "giveway"):
            return None
        locator = cls(py_func, py_file)
        try:
            locator.ensure_cache_path()
        except OSError:
            return None
        return locator


@functools.cache
def _ensure_writable(folder: str) -> None:
    Path(folder).mkdir(parents=True, exist_ok=True)
    tempfile.TemporaryFile(dir=folder).close()


@functools.cache
def _place(py_file: str) -> Path:
    """A module's path as seen from the folder of our packages."""
    path = Path(py_file).resolve()
    return path.relative_to(_HOUSE) if path.is_relative_to(_HOUSE) else path


class _Kernels(caching.FunctionCache):
    """The changes of numba's cache for our kernels; they are put into numba's class below."""

    load_as_ever: Any = caching.FunctionCache.load_overload
    save_as_ever: Any = caching.FunctionCache.save_overload

    def load_overload(self, signature: Any, target_context: Any) -> Any:
        """Load machine code without making the compiler ready.

        Numba registers hundreds of typed implementations before it looks into its cache, a third
        of a second. Code that is there needs the runtime of arrays alone; where none is found, the
        compiler makes itself ready.
        """
        if not isinstance(self._impl.locator, KernelLocator):
            return _Kernels.load_as_ever(self, signature, target_context)
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(signature, target_context)  # type: ignore[no-untyped-call]

    def save_overload(self, signature: Any, data: Any) -> None:
        """Save one at a time: numba reads the list of a kernel's signatures and writes it.

        Two processes at once might else give both signatures the same file.
        """
        if not isinstance(self._impl.locator, KernelLocator):
            _Kernels.save_as_ever(self, signature, data)
            return
        from filelock import FileLock

        with FileLock(Path(self.cache_path) / _LOCK):
            _Kernels.save_as_ever(self, signature, data)


_rebuild_as_ever: Any = environment._rebuild_env


@functools.wraps(_rebuild_as_ever)  # numba's pickles call it by this name
def _environment(module: str, constants: list[Any], name: str) -> Any:
    """Rebuild the environment of a compiled function without importing numba's module of it.

    Compiled code reads its constants from there; the globals of the module are for Python's
    objects, which no kernel handles.
    """
    if module in sys.modules or not module.startswith("numba."):
        return _rebuild_as_ever(module, constants, name)
    known = environment.Environment._memo.get(name)
    if known is not None:
        return known
    rebuilt: Any = environment.Environment({"__name__": module})
    rebuilt.consts[:] = constants
    rebuilt.env_name = name
    environment.Environment._memo[name] = rebuilt
    return rebuilt


_numbas: Any = caching.FunctionCache
if hasattr(_numbas, "_load_overload") and hasattr(_numbas, "_guard_against_spurious_io_errors"):
    _numbas.load_overload = _Kernels.load_overload
    _numbas.save_overload = _Kernels.save_overload
    environment._rebuild_env = _environment
