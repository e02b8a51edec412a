"""What has to be right before anything else is imported."""

import errno
import importlib.util
import os
import sys
from pathlib import Path

from giveway.errors import InstallationError

ROOMS = ("controller", "pedestrian_model", "fmus", "sumo_scenarios")
_NO_MEMORY = ("failed to map segment", "Cannot allocate memory")  # the dynamic linker's
_WITH_KERNELS = ("giveway", "controller", "pedestrian_model")


def check_rooms() -> None:
    """Make sure that the four packages giveway imports are its own.

    ``controller`` is a common name: a robotics simulator ships one too.

    Raises:
        InstallationError: a room is missing, or another package of that name comes first.
    """
    house = Path(__file__).resolve().parent.parent
    for room in ROOMS:
        spec = importlib.util.find_spec(room)
        origin = None if spec is None or spec.origin is None else Path(spec.origin).resolve()
        if origin is None or origin.parent.parent != house:
            raise InstallationError(
                f"package '{room}': found {origin or 'nothing'}; expected giveway's own in "
                f"{house}; take the other off the path, or use a virtual environment of its own"
            )


def out_of_memory(error: BaseException | None) -> bool:
    """Whether an error, or what it was raised from, says that the system gives no more memory.

    A library that does not fit is an ImportError or an OSError; only its words tell.
    """
    while error is not None:
        if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
            return True
        if any(words in str(error) for words in _NO_MEMORY):
            return True
        error = error.__cause__ or error.__context__
    return False


def user_cache() -> Path:
    """The folder in the user's cache that is ours; it may not exist, or not be writable."""
    from platformdirs import user_cache_path

    return user_cache_path("giveway", appauthor=False)


def kernel_cache() -> Path:
    """Where compiled kernels are kept.

    The user's choice comes first, then a folder in the user's cache, then a temporary one.
    """
    import tempfile  # none of these is needed before numba is

    chosen = os.environ.get("NUMBA_CACHE_DIR")
    if chosen:
        return Path(chosen)
    folder = user_cache() / f"kernels-{_fingerprint()}"
    existing = next(parent for parent in (folder, *folder.parents) if parent.exists())
    if os.access(existing, os.W_OK | os.X_OK):
        return folder
    user = os.getuid() if hasattr(os, "getuid") else "user"
    return Path(tempfile.gettempdir()) / f"giveway-{user}" / folder.name


def _fingerprint() -> str:
    """A text that changes with any file that may hold kernels.

    Numba looks at the file of a kernel alone, and not at those of the kernels inlined into it.
    """
    import hashlib

    house = Path(__file__).resolve().parent.parent
    stamps = [
        (str(path), status.st_mtime_ns, status.st_size)
        for room in _WITH_KERNELS
        for path in sorted((house / room).rglob("*.py"))
        for status in [path.stat()]
    ]
    return hashlib.sha256(repr(stamps).encode()).hexdigest()[:12]


def choose_kernel_cache() -> None:
    """Keep numba's cache out of the package folder, which may be read-only and is not ours.

    Numba reads the choice once, when it is imported, and only then is it made: it costs a look at
    every file of three packages, which most of what one can do with giveway does not need.
    """
    if "numba" in sys.modules:  # imported before us: it has read the environment already
        _name_kernel_cache()
        sys.modules["numba"].config.CACHE_DIR = os.environ["NUMBA_CACHE_DIR"]
    else:
        sys.meta_path.insert(0, _BeforeNumba())


class _BeforeNumba:
    """Makes the choice when numba is about to be imported, whoever imports it.

    An entry of ``sys.meta_path``, where Python asks for every module; it never finds one itself.
    """

    def find_spec(self, fullname: str, _path: object, _target: object = None) -> None:
        if fullname == "numba":
            _name_kernel_cache()


def _name_kernel_cache() -> None:
    os.environ.setdefault("NUMBA_CACHE_DIR", str(kernel_cache()))
