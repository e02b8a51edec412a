"""Where a shipped FMU is unpacked in a process that makes many runs: once for all of them.

To remove its four folders takes some file systems longer than a quarter of a run's steps. Our plant
writes nothing into them, and its instances share nothing.
"""

import tempfile
from pathlib import Path
from typing import Final

from fmus.archive.archive_check import open_archive
from fmus.profile.preparation import Prepared, unpack

PREFIX: Final = "vehicle-fmu-"
_folders: Final[dict[str, Path]] = {}  # by the FMU's content
_keeping: Final[set[bool]] = set()


def keep_unpacked() -> None:
    """From now on, unpack each shipped FMU once and leave it in the folder for temporary files.

    For a process whose folder for temporary files is its own, and is removed with it.
    """
    _keeping.add(True)


def kept(prepared: Prepared) -> Path | None:
    """The folder of a shipped FMU; None where it is to be unpacked for one vehicle.

    Raises:
        FmuArchiveError: a member is damaged.
        FmuFileError: there is no room for it.
    """
    if not (_keeping and prepared.ours):
        return None
    digest = open_archive(prepared.path).sha256
    if digest not in _folders:
        folder = Path(tempfile.mkdtemp(prefix=PREFIX))
        unpack(prepared, folder)
        _folders[digest] = folder
    return _folders[digest]
