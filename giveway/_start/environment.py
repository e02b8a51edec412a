"""The checks and settings that must come before all other imports."""

import errno
import importlib.util
import sys
from pathlib import Path
from typing import Any

from giveway.errors import InstallationError

ROOMS = ("controller", "pedestrian_model", "fmus", "sumo_scenarios")
# Names of numba's cache locators, in order
_NUMBAS = ("UserProvided", "InTree", "UserWide", "IPython", "Zip")
_NO_MEMORY = ("failed to map segment", "Cannot allocate memory")  # messages of the dynamic linker


def check_rooms() -> None:
    """Make sure that the four packages giveway imports are its own.

    ``controller`` is a common name: a robotics simulator has a package of that name, too.

    Raises:
        InstallationError: a package is missing, or another package of that name comes first.
    """
    house = Path(__file__).resolve().parents[2]
    for room in ROOMS:
        spec = importlib.util.find_spec(room)
        origin = None if spec is None or spec.origin is None else Path(spec.origin).resolve()
        if origin is None or origin.parent.parent != house:
            raise InstallationError(
                f"package '{room}': found {origin or 'nothing'}; expected giveway's own in "
                f"{house}; take the other off the path, or use a virtual environment of its own"
            )


def out_of_memory(error: BaseException | None) -> bool:
    """Return whether an error, or its cause, means that the system has no more memory.

    A library that does not fit in memory gives an ImportError or an OSError; only its text shows
    the cause.
    """
    while error is not None:
        if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
            return True
        if any(words in str(error) for words in _NO_MEMORY):
            return True
        error = error.__cause__ or error.__context__
    return False


def keep_kernels() -> None:
    """Let numba keep giveway's kernels in the folder of ``_kernels``, even if it is imported first.

    Numba documents the setting (``NUMBA_CACHE_LOCATOR_CLASSES``). It is made in this process and
    not in the environment, since child processes need not be giveway's.
    """
    if "numba.core.caching" in sys.modules:
        _name_locator()
    else:
        sys.meta_path.insert(0, _BeforeNumba())


class _BeforeNumba:
    """Makes the setting when any module imports numba.

    It is an entry of ``sys.meta_path``, which Python asks for every module; it never finds one
    itself.
    """

    def find_spec(self, fullname: str, _path: object, _target: object = None) -> None:
        if fullname == "numba.core.caching":
            _name_locator()


def _name_locator() -> None:
    config: Any = sys.modules["numba.core.config"]
    others = config.CACHE_LOCATOR_CLASSES or ",".join(f"{name}CacheLocator" for name in _NUMBAS)
    config.CACHE_LOCATOR_CLASSES = f"giveway._kernels.cache.KernelLocator,{others}"
