"""The gate through which files of results folders, studies and journals are read and written.

Such folders may come from other people. Whatever they hold, only regular files of a bounded size
are opened, no link is followed or written through, and JSON is neither deep nor has numbers that
giveway does not write. A key of the user tells own results from foreign ones.
"""

import contextlib
import errno
import hashlib
import hmac
import json
import math
import os
import stat
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO, Final

from giveway._cache_folder import user_cache
from giveway.errors import ResultsError

LARGEST_TEXT: Final = 64 * 2**20
"""Largest size [bytes] of a JSON or TOML file; the scene of a large city has a tenth."""
LARGEST_TABLE: Final = 8 * 2**30
"""Largest size [bytes] of a table; an hour with a thousand people has a third."""
LARGEST_JOURNAL: Final = 2**38
"""Largest size [bytes] of a journal's rows, which are read in pieces; such an hour has 3.5 GB."""
DEEPEST: Final = 20
"""Levels of tables and lists in one another; files of giveway have less than half as many."""
UNFINISHED: Final = ".{}.new"
"""Name of a file that is being written; it stays if the process is killed."""
_OPEN: Final = sum(
    getattr(os, name, 0) for name in ("O_NOFOLLOW", "O_NONBLOCK", "O_CLOEXEC", "O_BINARY")
)
_KINDS: Final = (
    (stat.S_ISLNK, "a link, which is not followed"),
    (stat.S_ISFIFO, "a named pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISBLK, "a device"),
    (stat.S_ISCHR, "a device"),
)
_PIECE: Final = 2**20  # Bytes that are hashed at a time
_KEY_FILE: Final = "own_results.key"
_KEY_LENGTH: Final = 32  # Bytes of the user's key, as many as SHA-256 has
MANIFEST: Final = "manifest.json"
DEFINITIONS: Final = {"study": "study.toml", "risk": "risk.toml"}
"""Names of the file with a definition, by the kind of the folder."""
MAKER: Final = "maker"
"""Key of a JSON file with the signature of the user who made it."""


class RefusedFileError(ResultsError):
    """A file that giveway does not open, or whose content it does not use.

    Args:
        file: Path of the file.
        reason: Reason why it is refused.

    Attributes:
        file: Path of the file.
        reason: Reason why it is refused.
    """

    def __init__(self, file: Path, reason: str) -> None:
        self.file, self.reason = file, reason
        super().__init__(
            f"{file}: {reason}; expected a file that giveway wrote; put the file itself there, or "
            "remove this one and make the results again"
        )


@contextlib.contextmanager
def opened(file: Path, *, within: Path | None = None, largest: int) -> Iterator[BinaryIO]:
    """Open a regular file to read it.

    Args:
        file: File to be read.
        within: Folder below which no folder on the way may be a link, or None to look at the file
            alone.
        largest: Largest size [bytes].

    Raises:
        RefusedFileError: it is a link, a pipe or a device, or too large.
        OSError: it cannot be read.
    """
    require_no_link(file, within)
    with os.fdopen(os.open(file, os.O_RDONLY | _OPEN), "rb") as stream:
        found = os.fstat(stream.fileno())
        _require_file(file, found)
        if found.st_size > largest:
            raise RefusedFileError(
                file, f"has {found.st_size:,} bytes; at most {largest:,} are read"
            )
        yield stream


def read_bytes(file: Path, *, within: Path | None = None, largest: int = LARGEST_TEXT) -> bytes:
    """Return the content of a regular file; the arguments and errors are those of ``opened``."""
    with opened(file, within=within, largest=largest) as stream:
        return stream.read(os.fstat(stream.fileno()).st_size)  # for more, memory would be reserved


def read_text(file: Path) -> str:
    """Return the text of a regular file.

    Raises:
        RefusedFileError: it is no such file, or not UTF-8 text.
        OSError: it cannot be read.
    """
    try:
        return read_bytes(file).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise RefusedFileError(file, "is not UTF-8 text") from None


def read_json(file: Path, *, within: Path | None = None) -> dict[str, Any]:
    """Return the object in a JSON file.

    Args:
        file: File to be read.
        within: Folder below which no folder on the way may be a link, or None.

    Raises:
        RefusedFileError: it is no such file, or not JSON as giveway writes it.
        OSError: it cannot be read.
    """
    content = read_bytes(file, within=within)
    try:
        values = json.loads(content, parse_int=_integer, parse_constant=_constant)
    except (ValueError, RecursionError):
        raise RefusedFileError(file, "is not JSON") from None
    if not isinstance(values, dict):
        raise RefusedFileError(file, "is not a JSON object")
    if is_deep(values):
        raise RefusedFileError(
            file, f"has lists or tables in one another, more than {DEEPEST} deep"
        )
    return values


def is_deep(values: Any) -> bool:
    """Return whether the nesting is too deep for recursive functions."""
    level: list[Any] = [values]
    for _ in range(DEEPEST):
        children: list[Any] = []
        for node in level:
            if isinstance(node, dict):
                children += node.values()
            elif isinstance(node, list):
                children += node
        level = children
        if not level:
            return False
    return True


def _integer(text: str) -> int:
    if len(text) > len(str(-(2**63))):
        raise ValueError(text)
    return int(text)


def _constant(name: str) -> float:
    raise ValueError(name)  # giveway writes neither NaN nor infinity


def finite(value: Any) -> float:
    """Return a number of a file.

    Raises:
        ValueError: it is infinite, or no number.
    """
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(value)
    return number


def fingerprint(content: bytes) -> dict[str, Any]:
    """Return length and SHA-256 of a file's content."""
    return {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}


def fingerprint_of(file: Path) -> dict[str, Any]:
    """Return length and SHA-256 of a regular file of any size, with constant memory.

    Raises:
        RefusedFileError: it is no regular file.
        OSError: it cannot be read.
    """
    digest, length = hashlib.sha256(), 0
    with opened(file, largest=2**63) as stream:
        while piece := stream.read(_PIECE):
            digest.update(piece)
            length += len(piece)
    return {"bytes": length, "sha256": digest.hexdigest()}


def write_whole(
    file: Path, content: bytes, *, within: Path | None = None, durable: bool = False
) -> None:
    """Write a file under another name, then rename it: a kill leaves the old or the new file.

    Args:
        file: File to be written.
        content: Content of the file.
        within: Folder below which no folder on the way may be a link, or None.
        durable: True to flush it to the disk, so that it survives a crash of the machine.

    Raises:
        RefusedFileError: a link, a pipe or a device is in its place.
        OSError: the disk is full or not writable.
    """
    require_no_link(file, within)
    new = file.with_name(UNFINISHED.format(file.name))
    with contextlib.suppress(FileNotFoundError):
        new.unlink()
    with new.open("xb") as stream:  # "x" does not follow a link that was put there meanwhile
        stream.write(content)
        if durable:
            stream.flush()
            os.fsync(stream.fileno())
    new.replace(file)


def require_no_link(file: Path, within: Path | None = None) -> None:
    """Make sure that a file is regular or missing, and no folder on the way to it a link.

    Args:
        file: File to be opened.
        within: Folder where the way begins, or None to look at the file alone.

    Raises:
        RefusedFileError: it is a link, a pipe or a device, or below a link.
    """
    above = list(file.parents)
    below = above[: above.index(within)] if within in above else []
    for place in (*reversed(below), file):
        with contextlib.suppress(FileNotFoundError, NotADirectoryError):
            found = place.lstat()
            if not stat.S_ISDIR(found.st_mode):
                _require_file(place, found)


def _require_file(file: Path, found: os.stat_result) -> None:
    if stat.S_ISDIR(found.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(file))
    for is_kind, name in _KINDS:
        if is_kind(found.st_mode):
            raise RefusedFileError(file, f"is {name}")


def signature(content: Mapping[str, Any]) -> str | None:
    """Return the signature of the content of a JSON file by the key of this user.

    Args:
        content: Content of the file; a signature that it has is left out.

    Returns:
        The signature, or None if the user has no folder for a key.
    """
    key = _key()
    if key is None:
        return None
    rest = {name: value for name, value in content.items() if name != MAKER}
    text = json.dumps(rest, sort_keys=True)
    return hmac.new(key, text.encode("ascii"), hashlib.sha256).hexdigest()


def signed(content: dict[str, Any]) -> dict[str, Any]:
    """Return the content of a JSON file with the signature of this user, if there is a key."""
    maker = signature(content)
    return content if maker is None else content | {MAKER: maker}


def is_own(content: Mapping[str, Any]) -> bool:
    """Return whether this user made the content of a JSON file."""
    ours, theirs = signature(content), content.get(MAKER)
    return ours is not None and isinstance(theirs, str) and hmac.compare_digest(ours, theirs)


def _key() -> bytes | None:
    """Return the key of this user, which is made when it is first needed."""
    file = user_cache() / _KEY_FILE
    with contextlib.suppress(OSError, RefusedFileError):
        if not file.exists():
            _make_key(file)
        with opened(file, largest=_KEY_LENGTH) as stream:
            found, key = os.fstat(stream.fileno()), stream.read()
        mine = not hasattr(os, "getuid") or (
            found.st_uid == os.getuid() and not found.st_mode & 0o077
        )
        return key if mine and len(key) == _KEY_LENGTH else None
    return None


def _make_key(file: Path) -> None:
    """Write a new key, unless another process has written one meanwhile."""
    file.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=_KEY_FILE, dir=file.parent)  # mode 600
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(os.urandom(_KEY_LENGTH))
        with contextlib.suppress(FileExistsError):
            os.link(name, file)
    finally:
        Path(name).unlink()


def definition_name(manifest: Mapping[str, Any]) -> str:
    """Return the name of the file with the definition of a study or a risk."""
    return DEFINITIONS.get(str(manifest.get("kind")), DEFINITIONS["study"])
