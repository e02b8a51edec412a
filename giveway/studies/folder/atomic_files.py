"""Files of a study, which are written whole or not at all."""

import os
from pathlib import Path

from giveway.errors import ResultsError

_UNFINISHED = ".{}.new"  # Name of a file that is being written; it stays if the process is killed


def write_atomically(path: Path, text: str, *, durable: bool = False) -> None:
    """Write a file under another name, then rename it: a kill leaves the old or the new file.

    Args:
        path: Path of the file; its folder is made if it does not exist.
        text: Its content; line ends are kept.
        durable: True to flush it to the disk, so that it survives a crash of the machine.

    Raises:
        ResultsError: the disk is full or not writable.
    """
    new = path.with_name(_UNFINISHED.format(path.name))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with new.open("w", encoding="utf-8", newline="") as file:
            file.write(text)
            if durable:
                file.flush()
                os.fsync(file.fileno())
        new.replace(path)
    except OSError as error:
        raise ResultsError(
            f"{path}: cannot be written ({error.strerror}); every run finished before is kept: "
            "free the disk and go on with --resume"
        ) from error


def finished_name(name: str) -> str:
    """Return the final name of a file that was being written, other names unchanged."""
    before, after = _UNFINISHED.split("{}")
    unfinished = name.startswith(before) and name.endswith(after)
    return name[len(before) : -len(after)] if unfinished else name
