"""The folder of a shipped FMU in a process with many runs, into which it is unpacked once.

Some file systems take longer to remove its four folders than a quarter of a run's steps takes. The
shipped vehicle writes nothing into them, and its instances share nothing.
"""

import tempfile
from pathlib import Path
from typing import Final

from fmus.archive.archive_check import open_archive
from fmus.archive.place import unpacking_place
from fmus.profile.preparation import Prepared, unpack

_PREFIX: Final = "vehicle-fmu-"
_folders: Final[dict[str, Path]] = {}  # folders by the SHA-256 of the FMU
_keeping: Final[set[bool]] = set()


def keep_unpacked() -> None:
    """Unpack each shipped FMU only once from now on, into the folder for temporary files.

    This is for a process whose own folder for temporary files is removed with it.
    """
    _keeping.add(True)


def kept(prepared: Prepared) -> Path | None:
    """Return the folder of a shipped FMU, or None if it must be unpacked for one vehicle.

    Raises:
        FmuArchiveError: a member is damaged.
        FmuFileError: there is no room for it.
    """
    if not (_keeping and prepared.ours):
        return None
    digest = open_archive(prepared.path).sha256
    if digest not in _folders:
        folder = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=unpacking_place()))
        unpack(prepared, folder)
        _folders[digest] = folder
    return _folders[digest]
