"""Files of a study, which are written whole or not at all."""

from pathlib import Path

from giveway.errors import ResultsError, remedy
from giveway.gate import UNFINISHED, write_whole


def write_atomically(
    path: Path, text: str, *, within: Path | None = None, durable: bool = False
) -> None:
    """Write a file whole or not at all; a link is not written through.

    Args:
        path: Path of the file; its folder is made if it does not exist.
        text: Its content; line ends are kept.
        within: Folder of the study, below which no folder may be a link, or None.
        durable: True to flush it to the disk, so that it survives a crash of the machine.

    Raises:
        ResultsError: the disk is full or not writable.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, text.encode("utf-8"), within=within, durable=durable)
    except OSError as error:
        raise ResultsError(
            f"{path}: cannot be written ({error.strerror}); every run finished before is kept: "
            f"{remedy(error)}, and go on with --resume"
        ) from error


def finished_name(name: str) -> str:
    """Return the final name of a file that was being written, other names unchanged."""
    before, after = UNFINISHED.split("{}")
    unfinished = name.startswith(before) and name.endswith(after)
    return name[len(before) : -len(after)] if unfinished else name
