"""The cache of compiled kernels, by their content and not by place or time of installation.

Numba's own cache knows a kernel by the path of its file, and checks only this file. It would
compile again for every environment, and load stale code where a kernel that is inlined into another
has changed; and it loads damaged files, and others' files. Our cache is one folder for each content
of all kernels. It is in the user's cache and not in the package folder, which may be read-only.
"""

import functools
import hashlib
import os
import pickle
import re
import sys
from pathlib import Path
from typing import Any

import llvmlite
import numba
from llvmlite.binding import get_host_cpu_name
from numba.core import caching, environment
from numba.core.caching import UserProvidedCacheLocator
from numba.core.runtime.nrt import rtsys
from numba.core.serialize import dumps

from giveway._cache_folder import CHOICE, fresh_folder, objection, remark, user_cache
from giveway._kernels import kept_code
from giveway._kernels.kept_code import SUFFIX

FOLDERS = "kernels-*"
MARKERS = "compiled-for-"
_HOUSE = Path(__file__).resolve().parents[2]
_OF_KERNELS = ("controller", "pedestrian_model")  # rooms whose constants go into kernels, too
_KERNEL = re.compile(rb"^@(?:kernel|unlocked|inner|inlined)\b|^def kernel\b", re.MULTILINE)


@functools.cache
def kernel_digest() -> str:
    """Return a text that changes with the content of files that hold kernels, and the compiler.

    The CPU is not part of it: numba checks that itself.
    """
    compiler = (*sys.version_info[:2], numba.__version__, llvmlite.__version__, SUFFIX)
    digest = hashlib.sha256(repr(compiler).encode())
    for room in (*_OF_KERNELS, "giveway"):
        for path in sorted((_HOUSE / room).rglob("*.py")):
            content = path.read_bytes()
            if room in _OF_KERNELS or _KERNEL.search(content):
                digest.update(path.relative_to(_HOUSE).as_posix().encode() + content)
    return digest.hexdigest()[:12]


def kernel_cache() -> Path:
    """Return the folder of the present kernels."""
    return kernel_place()[0]


@functools.cache
def kernel_place() -> tuple[Path, str]:
    """Return the folder of the present kernels, and why it is a fresh one, or "".

    It lies in ``NUMBA_CACHE_DIR`` if the user has set it, else in the user's cache, and if neither
    is safe and can be written, in a fresh folder. A folder that cannot be written serves, too, if
    it holds all kernels for this processor.
    """
    name = FOLDERS.replace("*", kernel_digest())
    chosen = os.environ.get(CHOICE)
    if chosen:
        why = _why_not(Path(chosen) / name, named=True)
        if not why:
            return Path(chosen) / name, ""
        remark(f"{CHOICE}={chosen} is not used: {why}")
    why = _why_not(user_cache() / name)
    folder = (fresh_folder(why) if why else user_cache()) / name
    folder.mkdir(exist_ok=True)
    return folder, why


def _why_not(folder: Path, *, named: bool = False) -> str:
    """Return why a folder does not serve for kernels, or ""."""
    why = objection(folder, named=named)
    if why or os.access(folder, os.W_OK) or (folder / marker()).exists():
        return why
    return f"{folder} cannot be written"


def marker() -> str:
    """Return the name of the file that says that all kernels are there, for this processor."""
    return f"{MARKERS}{get_host_cpu_name()}"


class KernelLocator(UserProvidedCacheLocator):
    """Tells numba the place of a kernel of ours, and nothing about other functions."""

    def __init__(self, py_func: Any, py_file: str) -> None:
        self._lineno = py_func.__code__.co_firstlineno
        self._cache_path = str(kernel_cache())
        self.package = ".".join(_place(py_file).parts[:-1])

    def ensure_cache_path(self) -> None:
        """Do nothing; :func:`kernel_cache` has made the folder."""

    def get_source_stamp(self) -> str:
        """Return the version of the compiled code: that of all kernels, since some are inlined."""
        return kernel_digest()

    @classmethod
    def from_function(cls, py_func: object, py_file: str) -> "KernelLocator | None":
        """Return the locator of a kernel, or None for a function of another package."""
        ours = _place(py_file).parts[0] in (*_OF_KERNELS, "giveway")
        return cls(py_func, py_file) if ours else None


@functools.cache
def _place(py_file: str) -> Path:
    """A module's path as seen from the folder of our packages."""
    path = Path(py_file).resolve()
    return path.relative_to(_HOUSE) if path.is_relative_to(_HOUSE) else path


class _Kernels(caching.FunctionCache):
    """The changes of numba's cache for our kernels; they are put into numba's class below.

    A kernel has one file for each signature, whose name says all that its code depends on.
    """

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
        code = kept_code.read(_file(self, signature, target_context.codegen()))
        if not code:
            return None
        rtsys.initialize(target_context)
        return self._impl.rebuild(target_context, pickle.loads(code))

    def save_overload(self, signature: Any, data: Any) -> None:
        """Save machine code; another process may do so at the same time."""
        if not isinstance(self._impl.locator, KernelLocator):
            _Kernels.save_as_ever(self, signature, data)
        elif self._impl.check_cachable(data):
            code = dumps(self._impl.reduce(data))  # type: ignore[no-untyped-call]
            kept_code.write(_file(self, signature, data.codegen), code)


def _file(cache: Any, signature: Any, codegen: Any) -> Path:
    """Return the file of a kernel for a signature and a processor."""
    depends = repr(cache._index_key(signature, codegen)).encode()
    digest = hashlib.sha256(depends).hexdigest()[:16]
    name = f"{cache._impl.locator.package}.{cache._impl.filename_base}.{digest}"
    return kernel_cache() / f"{name}{SUFFIX}"


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
if hasattr(_numbas, "_index_key"):
    _numbas.load_overload = _Kernels.load_overload
    _numbas.save_overload = _Kernels.save_overload
    environment._rebuild_env = _environment
