"""An FMU's shared library: loading it, finding its functions, unloading it."""

import _ctypes
import ctypes
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fmus.description.binaries import is_library
from fmus.errors import FmuPlatformError
from fmus.text import printable

Function = Callable[..., int]
"""Type of a C function that takes ready-made ctypes objects and returns an int."""

_ALTERED_SEARCH_PATH = 0x8  # Windows looks for dependencies in the library's folder


class Library:
    """A loaded shared library.

    Args:
        path: Path of the library.
        fmu: Name of the FMU in errors.
        folder: Folder with the libraries that it may need; by default its own.

    Raises:
        FmuPlatformError: the library cannot be loaded.
    """

    def __init__(self, path: Path, fmu: Path, folder: Path | None = None) -> None:
        self._fmu = fmu
        try:
            neighbours = [file for file in path.parent.iterdir() if file != path]
            if folder is not None:
                found = (file for file in folder.rglob("*") if is_library(file.name))
                neighbours += [file for file in found if file.parent != path.parent]
            self._library = _load_with(path, neighbours, ctypes.DEFAULT_MODE)
        except OSError as error:
            reason = printable(str(error).replace(str(path.parent), "").lstrip("/\\"))
            remedy = "install what it needs, or export the FMU again for this platform"
            if "failed to map segment" in reason:
                remedy = f"nothing may be executed in {path.parent}: name another folder in TMPDIR"
            raise FmuPlatformError(
                f"{fmu}: its binary {printable(path.name)} cannot be loaded: {reason}; {remedy}"
            ) from error

    def function(self, name: str) -> Function:
        """Return a function that the FMU must have.

        Raises:
            FmuPlatformError: the FMU has no such function.
        """
        found = self.optional(name)
        if found is None:
            raise FmuPlatformError(
                f"{self._fmu}: its binary has no function {printable(name)}, which the FMI "
                "standard demands; export the FMU again"
            )
        return found

    def optional(self, name: str) -> Function | None:
        """Return a function that the FMU may have, or None."""
        try:
            return self._library[name]
        except (AttributeError, ValueError):
            return None

    def instantiator(self, name: str) -> Callable[..., int | None]:
        """Return a function that returns a pointer.

        Raises:
            FmuPlatformError: the FMU has no such function.
        """
        found: Any = self.function(name)
        found.restype = ctypes.c_void_p
        return found  # type: ignore[no-any-return]

    def close(self) -> None:
        """Unload the library."""
        handle = self._library._handle
        if sys.platform == "win32":
            _ctypes.FreeLibrary(handle)
        else:
            _ctypes.dlclose(handle)


def _load_with(path: Path, neighbours: list[Path], mode: int) -> ctypes.CDLL:
    """Load a library; missing dependencies are loaded from its own folder first."""
    while True:
        try:
            return ctypes.CDLL(str(path), mode=mode, winmode=_ALTERED_SEARCH_PATH)
        except OSError as error:
            missing = next((file for file in neighbours if file.name in str(error)), None)
            if missing is None:
                raise
            neighbours.remove(missing)
            _load_with(missing, neighbours, ctypes.RTLD_GLOBAL)
