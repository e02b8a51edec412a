"""The folder for files that a session writes for SUMO: the session's own, or kept in a worker.

Some file systems take longer to remove a folder than SUMO takes to load a small scenario.
"""

import shutil
import tempfile
from pathlib import Path
from typing import Final

PREFIX: Final = "giveway-"
_kept: list["KeptFolder"] = []


class KeptFolder:
    """A folder that one session after the other uses, and leaves empty.

    Attributes:
        name: Its path, as that of a ``tempfile.TemporaryDirectory``.
    """

    name: str

    def __init__(self) -> None:
        self.name = tempfile.mkdtemp(prefix=PREFIX)

    def cleanup(self) -> None:
        """Remove the contents of the folder.

        Raises:
            OSError: something cannot be removed.
        """
        for path in Path(self.name).iterdir():
            if path.is_dir():
                shutil.rmtree(path)
            else:
                path.unlink()


def keep_scratch() -> None:
    """Let this process's sessions share one folder from now on, which nobody removes.

    This is for a process whose folder for temporary files is its own, and is removed with it.

    Raises:
        OSError: the folder cannot be made.
    """
    if not _kept:
        _kept.append(KeptFolder())


def scratch() -> "tempfile.TemporaryDirectory[str] | KeptFolder":
    """Return an empty folder for the session that begins; its ``cleanup`` ends the use.

    Raises:
        OSError: it cannot be made.
    """
    return _kept[0] if _kept else tempfile.TemporaryDirectory(prefix=PREFIX)
