"""The archive check: an FMU's archive is examined before anything is unpacked or loaded.

An FMU is a zip file of unknown origin. It is refused if unpacking it could write outside its
folder, fill the memory or the disk, or read other files. Everything else passes, including FMUs of
several hundred megabytes.
"""

import hashlib
import io
import os
import re
import stat
import struct
import unicodedata
import zipfile
import zlib
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import zip_longest
from pathlib import Path
from types import MappingProxyType
from typing import Final

from fmus.archive.kinds import DESCRIPTION, ROOT, SYSTEM, SYSTEM_ROOT, is_system
from fmus.archive.markup import check_xml
from fmus.errors import FmuArchiveError, FmuFileError
from fmus.text import printable

MAX_MEMBERS: Final = 50_000
MAX_DIRECTORY: Final = 5 << 20  # [bytes] largest list of members of an archive
MAX_TOTAL: Final = 4 << 30  # [bytes] largest sum of unpacked sizes
MAX_DESCRIPTION: Final = 64 << 20  # [bytes] largest description; 50,000 variables take 15 MB
MAX_RATIO: Final = 100  # largest size ratio unpacked to packed; tables reach 10, program text 5
RATIO_COUNTS_FROM: Final = 16 << 20  # [bytes] unpacked size from which the ratio counts
CHECKED_AT_ONCE: Final = 64 << 20  # [bytes] unpacked size up to which check sums are compared
MAX_NAME: Final = 1024
CHUNK: Final = 1 << 20  # [bytes] size of one read
READABLE: Final = frozenset({zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED})
DRIVE: Final = re.compile(r"[A-Za-z]:")
TWICE: Final = "twice in the archive (capitals and how accents are coded do not count)"
EXECUTABLE: Final = 0o111  # bits of a file's mode
FOLDER: Final = ("/", "\\")  # end of a folder's name
LOCAL_HEADER: Final = 30  # [bytes] size of the header before the name of a member


@dataclass(frozen=True, eq=False)
class Archive:
    """An FMU's archive that has passed the check; an unchanged file may give the same object.

    The archive of a system of several FMUs (``.ssp``) has the description of the system.
    """

    path: Path
    members: Mapping[str, zipfile.ZipInfo]  # files only, by their plain name
    description: bytes = field(repr=False)  # modelDescription.xml
    sha256: str  # SHA-256 of the whole file


def open_archive(path: Path) -> Archive:
    """Examine an FMU's archive, and read its model description into memory.

    Recent results are kept until the file changes, because preparing a vehicle needs them
    repeatedly.

    Raises:
        FmuArchiveError: the archive is hostile, damaged or too large.
        FmuFileError: the file is missing, unreadable, no zip archive or without a model
            description.
    """
    status = _require_file(path)
    return _open(path, (status.st_ino, status.st_size, status.st_mtime_ns))


@lru_cache(maxsize=2)
def _open(path: Path, _state: tuple[int, int, int]) -> Archive:
    system = is_system(path)
    name, root = (SYSTEM, SYSTEM_ROOT) if system else (DESCRIPTION, ROOT)
    with _reading(path) as archive:
        members, copies = _examined(path, archive.infolist())
        _require_same(path, archive, members, copies)
        info = members.get(name)
        if info is None:
            raise FmuFileError(_no_description(path, name, members))
        if info.file_size > MAX_DESCRIPTION:
            msg = f"{path}: {name} of {_megabytes(info.file_size)}"
            raise _beyond(msg, _megabytes(MAX_DESCRIPTION))
        description = b"".join(_chunks(archive, info))  # read() would inflate beyond that size
        check_xml(description, f"{path}: {name}", root, namespaces=system)
        if sum(member.file_size for member in members.values()) <= CHECKED_AT_ONCE:
            for member in members.values():
                deque(_chunks(archive, member), maxlen=0)  # the check sum is compared at the end
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return Archive(path, MappingProxyType(members), description, digest)


def extract(archive: Archive, folder: Path, wanted: Callable[[str], bool]) -> None:
    """Unpack members; a file that may be executed in the archive may be executed in the folder.

    Args:
        archive: Archive from :func:`open_archive`.
        folder: Existing folder. Nothing is written outside it, and nothing in it is replaced.
        wanted: Function that says by its name whether a member is unpacked.

    Raises:
        FmuArchiveError: a member is damaged.
        FmuFileError: the file has changed since, or cannot be read or written.
    """
    with _reading(archive.path) as source:
        for name, info in archive.members.items():
            if not wanted(name):
                continue
            target = folder.joinpath(*name.split("/"))
            try:
                target.parent.mkdir(parents=True, exist_ok=True)
                with target.open("xb") as out:
                    for chunk in _chunks(source, info):
                        out.write(chunk)
                    if info.external_attr >> 16 & EXECUTABLE and os.name == "posix":
                        mode = os.fstat(out.fileno()).st_mode
                        os.fchmod(out.fileno(), mode | (mode & 0o444) >> 2)
            except OSError as error:
                reason = error.strerror or printable(error)
                msg = f"{archive.path}: {printable(name)} cannot be unpacked: {reason}"
                raise FmuFileError(f"{msg}; make room in, or name another, TMPDIR") from error


@lru_cache(maxsize=4)
def read_start(archive: Archive, name: str, size: int) -> bytes:
    """Return the first bytes of a member.

    Raises:
        FmuArchiveError: the member is damaged there.
    """
    with _reading(archive.path) as source, source.open(archive.members[name]) as member:
        return member.read(size)


# ---- opening ----


class _CautiousFile(io.FileIO):
    """A file whose reads are bounded: an archive may claim that its list of members is huge."""

    def read(self, size: int | None = -1, /) -> bytes:
        wanted = MAX_DIRECTORY if size is None or size < 0 else size
        if wanted > MAX_DIRECTORY:
            msg = f"{self.name}: a list of members of {_megabytes(wanted)}"
            raise _beyond(msg, _megabytes(MAX_DIRECTORY))
        return super().read(wanted) or b""


@contextmanager
def _reading(path: Path) -> Iterator[zipfile.ZipFile]:
    """Open the zip file, and turn the exceptions of zipfile into this package's errors."""
    try:
        with _CautiousFile(path) as file, zipfile.ZipFile(file) as archive:
            yield archive
    except (zipfile.BadZipFile, EOFError, zlib.error) as error:
        what = printable(error)
        if what == "File is not a zip file":
            raise FmuFileError(
                f"{path}: not a zip archive, or cut off; expected an FMU; copy or export it again"
            ) from None
        raise FmuArchiveError(
            f"{path}: the zip archive is damaged: {what}; copy or export it again"
        ) from None
    except (NotImplementedError, RuntimeError, ValueError, OverflowError, struct.error) as error:
        raise FmuArchiveError(
            f"{path}: the zip archive cannot be read: {printable(error)}; export the FMU again"
        ) from None
    except OSError as error:
        reason = error.strerror or printable(error)
        raise FmuFileError(f"{path}: cannot be read: {reason}; expected an FMU (.fmu)") from None


def _require_file(path: Path) -> os.stat_result:
    try:
        status = path.stat()
    except (OSError, ValueError) as error:
        missing = isinstance(error, (FileNotFoundError, NotADirectoryError, ValueError))
        reason = "no such file" if missing else getattr(error, "strerror", "") or "cannot be read"
        raise FmuFileError(f"{path}: {reason}; expected an FMU (.fmu)") from None
    if stat.S_ISDIR(status.st_mode):
        msg = f"{path}: a folder; expected an FMU: a zip archive of its contents (.fmu)"
    elif not stat.S_ISREG(status.st_mode):
        msg = f"{path}: not a regular file; expected an FMU (.fmu)"
    elif status.st_size == 0:
        msg = f"{path}: empty; expected an FMU; copy or export it again"
    else:
        return status
    raise FmuFileError(msg)


# ---- examining ----


def _examined(
    path: Path, infos: Sequence[zipfile.ZipInfo]
) -> tuple[dict[str, zipfile.ZipInfo], list[zipfile.ZipInfo]]:
    """Return the members that are files, by name, and further members of the same names.

    Raises:
        FmuArchiveError: for the first bad member.
    """
    if len(infos) > MAX_MEMBERS:
        raise _beyond(f"{path}: {len(infos)} members", str(MAX_MEMBERS))
    members: dict[str, zipfile.ZipInfo] = {}
    copies: list[zipfile.ZipInfo] = []
    folded: dict[str, str] = {}
    for info in infos:
        name = _plain(info)
        fault = _fault(info, name)
        if fault:
            raise _refused(path, info, fault)
        if info.orig_filename.endswith(FOLDER):
            continue
        plain = unicodedata.normalize("NFC", name).casefold()
        if folded.setdefault(plain, name) != name:
            raise _refused(path, info, TWICE)
        if members.setdefault(name, info) is not info:
            copies.append(info)
    for name, info in members.items():
        parents = unicodedata.normalize("NFC", name).casefold().split("/")[:-1]
        if any("/".join(parents[: n + 1]) in folded for n in range(len(parents))):
            raise _refused(path, info, "lies in a folder that is also a file")
    _require_sane_sizes(path, [*members.values(), *copies])
    _require_separate_places(path, infos)
    return members, copies


def _require_same(
    path: Path,
    archive: zipfile.ZipFile,
    members: Mapping[str, zipfile.ZipInfo],
    copies: Sequence[zipfile.ZipInfo],
) -> None:
    """Refuse a name with two different contents (some tools write the same file twice).

    Raises:
        FmuArchiveError: the archive's reader would decide which content counts.
    """
    for info in copies:
        pairs = zip_longest(_chunks(archive, members[_plain(info)]), _chunks(archive, info))
        if any(one != other for one, other in pairs):
            raise _refused(path, info, f"{TWICE}, with different contents")


def _plain(info: zipfile.ZipInfo) -> str:
    """Return the name that is judged and unpacked: that without ``./``, and with ``/`` only."""
    parts = info.orig_filename.replace("\\", "/").split("/")  # zipfile cuts its own at a NUL
    return "/".join(part for part in parts if part != ".")


def _fault(info: zipfile.ZipInfo, name: str) -> str:
    """Return the fault of a member with a plain name as a phrase, or an empty text."""
    file_type = stat.S_IFMT(info.external_attr >> 16)
    parts = name.removesuffix("/").split("/")
    if not name.isprintable() or len(info.orig_filename) > MAX_NAME:
        return "a name with control characters, or too long"
    if name.startswith("/") or any(DRIVE.match(part) for part in parts):
        return "an absolute path"
    if ".." in parts:
        return "a path that leads out of the archive"
    whole = not name and info.orig_filename.endswith(FOLDER)  # "./", the archive itself
    if not whole and not all(part.strip(". ") for part in parts):  # ".. " is ".." on Windows
        return "not a plain path"
    if file_type not in (0, stat.S_IFREG, stat.S_IFDIR):
        return "a symbolic link" if file_type == stat.S_IFLNK else "a special file"
    if info.flag_bits & 0x41:
        return "encrypted"
    if info.compress_type not in READABLE:
        return f"packed with method {info.compress_type}; FMI allows stored and deflated only"
    return ""


def _require_sane_sizes(path: Path, members: Sequence[zipfile.ZipInfo]) -> None:
    total = sum(info.file_size for info in members)
    packed = sum(info.compress_size for info in members)
    if total > MAX_TOTAL:
        raise _beyond(f"{path}: {_megabytes(total)} unpacked", _megabytes(MAX_TOTAL))
    for info in members:
        if _inflated(info.file_size, info.compress_size):
            raise _bomb(f"{path}: member {_quoted(info)}", info.file_size, info.compress_size)
    if _inflated(total, packed):
        raise _bomb(f"{path}: its members together", total, packed)


def _inflated(size: int, packed: int) -> bool:
    return size > RATIO_COUNTS_FROM and size > MAX_RATIO * packed


def _require_separate_places(path: Path, infos: Sequence[zipfile.ZipInfo]) -> None:
    """Refuse members that share bytes of the archive, as zip bombs and disguised files do."""
    end = 0
    for info in sorted(infos, key=lambda info: info.header_offset):
        if info.header_offset < end:
            raise _refused(path, info, "overlaps another member")
        end = info.header_offset + LOCAL_HEADER + info.compress_size


def _chunks(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> Iterator[bytes]:
    with archive.open(info) as member:
        left = info.file_size
        while chunk := member.read(CHUNK):
            left -= len(chunk)
            yield chunk
    if left:
        raise zipfile.BadZipFile(f"{printable(info.filename)} is cut off")


# ---- words ----


def _refused(path: Path, info: zipfile.ZipInfo, fault: str) -> FmuArchiveError:
    msg = f"{path}: member {_quoted(info)}: {fault}; refused; export the FMU again"
    return FmuArchiveError(msg)


def _bomb(where: str, size: int, packed: int) -> FmuArchiveError:
    what = f"a zip bomb: {_megabytes(packed)} unpacks to {_megabytes(size)}"
    return FmuArchiveError(f"{where}: {what}; if meant so, pack it without compression (zip -0)")


def _quoted(info: zipfile.ZipInfo) -> str:
    return printable(repr(info.orig_filename), 100)


def _beyond(what: str, limit: str) -> FmuArchiveError:
    return FmuArchiveError(f"{what}: beyond all measure; expected at most {limit}")


def _no_description(path: Path, wanted: str, members: Mapping[str, zipfile.ZipInfo]) -> str:
    msg = f"{path}: no {wanted} in the archive"
    inside = [name for name in members if name.endswith(f"/{wanted}")]
    fmus = [name for name in members if name.endswith(".fmu")]
    if inside:
        folder = printable(inside[0].removesuffix(wanted), 100)
        return f"{msg}, but in its folder {folder}; zip the contents of that folder instead"
    if fmus and wanted == DESCRIPTION:
        return f"{msg}, but {printable(fmus[0], 100)}; unpack it and use that FMU"
    return f"{msg}; expected an FMU; export the model again"


def _megabytes(size: int) -> str:
    return f"{size / (1 << 20):.4g} MB"
