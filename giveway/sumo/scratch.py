"""The folder for files that a session writes for SUMO.

A session has a folder of its own, or a worker process keeps one for all its sessions, because some
file systems take longer to remove a folder than SUMO takes to load a small scenario.
"""

import shutil
from pathlib import Path
from typing import Final

from fmus.archive.own_folder import OwnFolder

PREFIX: Final = "giveway-scratch-"
_kept: list["KeptFolder"] = []


class KeptFolder:
    """A folder that one session after the other uses and empties.

    Attributes:
        name: Path of the folder, as in an ``OwnFolder``.
    """

    name: str

    def __init__(self) -> None:
        self._folder = OwnFolder(PREFIX)
        self.name = self._folder.name

    def cleanup(self) -> None:
        """Remove the contents of the folder.

        Raises:
            OSError: some content cannot be removed.
        """
        for path in Path(self.name).iterdir():
            if path.is_dir():
                shutil.rmtree(path)
            else:
                path.unlink()


def keep_scratch() -> None:
    """Let the sessions of this process share one folder from now on, which nobody removes.

    This is for a process whose own folder for temporary files is removed with it.

    Raises:
        OSError: the folder cannot be made.
    """
    if not _kept:
        _kept.append(KeptFolder())


def scratch() -> OwnFolder | KeptFolder:
    """Return an empty folder for a new session; the session calls its ``cleanup`` in the end.

    Raises:
        OSError: the folder cannot be made.
    """
    return _kept[0] if _kept else OwnFolder(PREFIX)
