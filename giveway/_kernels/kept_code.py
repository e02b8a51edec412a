"""Files of compiled code; each begins with a digest, which is checked before the code is used."""

import hashlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from giveway._cache_folder import LOST, remark

SUFFIX: Final = ".kernel"
_DIGEST: Final = 32  # Length [bytes] of a SHA-256


def write(file: Path, code: bytes) -> None:
    """Keep compiled code; a note says if that is impossible."""
    beside = file.with_name(f"{file.name}.{os.getpid()}")
    try:
        beside.touch(0o644)  # others may read it, and not write, whatever the umask
        beside.write_bytes(_digest(file, code) + code)
        beside.replace(file)
    except OSError as error:
        remark(f"{file.parent}: compiled code cannot be kept ({error.strerror}); {LOST}")
    finally:
        beside.unlink(missing_ok=True)


def read(file: Path) -> bytes:
    """Return compiled code, or nothing if it is missing or damaged; a note says the latter."""
    try:
        return _checked(file)
    except FileNotFoundError:
        return b""
    except OSError:
        remark(f"{file.parent}: compiled code is damaged; what is needed is compiled anew")
        return b""


def damaged(folder: Path) -> Iterator[Path]:
    """Yield the files of compiled code in a folder that are not as they were written."""
    for file in sorted(folder.glob(f"*{SUFFIX}")):
        try:
            _checked(file)
        except OSError:
            yield file


def _checked(file: Path) -> bytes:
    """Return the code in a file.

    Raises:
        OSError: it is missing, or not what was written into a file of this name.
    """
    if file.exists() and not file.is_file():
        raise OSError(f"{file} is no file")
    content = file.read_bytes()
    if content[:_DIGEST] != _digest(file, content[_DIGEST:]):
        raise OSError(f"{file} is damaged")
    return content[_DIGEST:]


def _digest(file: Path, code: bytes) -> bytes:
    return hashlib.sha256(file.name.encode() + code).digest()
