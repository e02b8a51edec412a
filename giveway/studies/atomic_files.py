"""Files of a study: there whole, or not at all."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from giveway.errors import ResultsError

if TYPE_CHECKING:
    from pathlib import Path

_UNFINISHED = ".{}.new"  # what a process that is killed while it writes may leave


def write_whole(path: Path, text: str, *, durable: bool = False) -> None:
    """Write a file beside its place, and rename it: whenever we die, it is the old or the new one.

    Args:
        path: of the file; its folder is made if there is none.
        text: of it; line ends stay as they are.
        durable: also give it to the disk first, lest the machine die.

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
        msg = (
            f"{path}: cannot be written ({error.strerror}); every run finished before is kept: "
            "free the disk and go on with --resume"
        )
        raise ResultsError(msg) from error


def finished_name(name: str) -> str:
    """The name of the file that ``name``, if it is an unfinished one, was to become."""
    before, after = _UNFINISHED.split("{}")
    unfinished = name.startswith(before) and name.endswith(after)
    return name[len(before) : -len(after)] if unfinished else name
