"""The choice of the binary that runs on this platform, by folder and first bytes."""

import platform
import struct
import sys
from dataclasses import dataclass
from typing import Final

from fmus.archive.archive_check import Archive, open_archive, read_start
from fmus.description.model import Interface, Model
from fmus.errors import FmuPlatformError
from fmus.text import printable

SYSTEMS: Final = {"linux": "linux", "win32": "windows", "cygwin": "windows", "darwin": "darwin"}
SUFFIXES: Final = {"linux": ".so", "windows": ".dll", "darwin": ".dylib"}
OLD_SYSTEMS: Final = {"linux": "linux", "windows": "win", "darwin": "darwin"}
PROCESSORS: Final = {"amd64": "x86_64", "x64": "x86_64", "arm64": "aarch64"}
X86: Final = frozenset({"i386", "i486", "i586", "i686", "x86", "x86pc"})
START: Final = 4096  # [bytes] beginning of a library that is examined

ELF_LIBRARY: Final = 3  # ET_DYN
ELF_MACHINES: Final = {3: "x86", 40: "arm", 62: "x86_64", 183: "aarch64", 243: "riscv64"}
PE_MACHINES: Final = {0x14C: "x86", 0x8664: "x86_64", 0xAA64: "aarch64"}
PE_LIBRARY: Final = 0x2000  # IMAGE_FILE_DLL
MACH_MACHINES: Final = {7: "x86", 0x1000007: "x86_64", 0x100000C: "aarch64"}
MACH_LIBRARIES: Final = frozenset({6, 8})  # MH_DYLIB, MH_BUNDLE


@dataclass(frozen=True)
class Platform:
    """An operating system on a processor, in FMI 3's words (``x86_64-linux``)."""

    processor: str  # "x86_64", "aarch64", "x86"
    system: str  # "linux", "windows", "darwin"

    def __str__(self) -> str:
        return f"{self.processor}-{self.system}"

    @property
    def suffix(self) -> str:
        """File suffix of a shared library."""
        return SUFFIXES.get(self.system, ".so")

    def folders(self, fmi_version: str) -> tuple[str, ...]:
        """Return the folders of an FMU's library for this platform, the standard's own name first.

        FMI 1 and 2 know the system and a number of bits; tools use FMI 3's names there too, for
        processors that the older standards do not name.
        """
        bits = "32" if self.processor == "x86" else "64"
        old = OLD_SYSTEMS.get(self.system, self.system) + bits
        named = self.processor in {"x86", "x86_64"} or self.system == "darwin"
        return (old, str(self)) if named and fmi_version != "3.0" else (str(self), old)


def this_platform() -> Platform:
    """The platform of this Python."""
    machine = platform.machine().lower()
    processor = PROCESSORS.get(machine, machine)
    if processor in X86 or (processor == "x86_64" and sys.maxsize <= 1 << 32):
        processor = "x86"
    return Platform(processor, SYSTEMS.get(sys.platform, sys.platform))


def binary_of(model: Model, interface: Interface) -> str:
    """Return the archive's member that is this platform's library for an interface.

    Raises:
        FmuPlatformError: there is no library that can be loaded here.
    """
    archive = open_archive(model.path)
    here = this_platform()
    misfits = []
    folders = here.folders(model.fmi_version)
    named = [f"binaries/{folder}/{interface.identifier}{here.suffix}" for folder in folders]
    present = [member for member in named if member in archive.members]
    for member in present or _only_library(archive, folders, here):
        fault = misfit(read_start(archive, member, START), here)
        if not fault:
            return member
        misfits.append(f"{member} {fault}")
    if misfits:
        what = f"{misfits[0]}; expected a library for {here}; export the FMU for {here}"
        raise FmuPlatformError(f"{model.path}: {what}")
    raise FmuPlatformError(f"{model.path}: {_no_binary(model, interface, archive)}")


def _only_library(archive: Archive, folders: tuple[str, ...], here: Platform) -> list[str]:
    """Return the library of a platform's first folder that has one, if it has only one."""
    for folder in folders:
        found = [
            name
            for name in archive.members
            if name.rpartition("/")[0] == f"binaries/{folder}" and name.endswith(here.suffix)
        ]
        if found:
            return found if len(found) == 1 else []
    return []


def name_note(interface: Interface, binary: str) -> str:
    """Return the remark on a binary that has not the name that it must have, or an empty text."""
    name = binary.rpartition("/")[2]
    if name.rpartition(".")[0] == interface.identifier:
        return ""
    return (
        f"its only library is called {printable(name, 60)}, not by its modelIdentifier "
        f"'{printable(interface.identifier, 60)}'"
    )


def is_platform(folder: str) -> bool:
    """Return whether a folder's name is that of a platform, in the words of FMI 1, 2 or 3."""
    processor, _, system = folder.partition("-")
    known = X86 | {"x86_64", "aarch64", "riscv64", "ppc32", "ppc64"}
    named = processor in known or processor.startswith(("aarch", "arm", "riscv", "ppc"))
    old = folder.removesuffix("32").removesuffix("64")
    return (named and system != "") or (old != folder and old in OLD_SYSTEMS.values())


def is_library(name: str) -> bool:
    """Return whether a file's name is that of a shared library, such as ``libm.so.6``."""
    file = name.rpartition("/")[2]
    return file.endswith(tuple(SUFFIXES.values())) or ".so." in file


def platforms_of(archive: Archive) -> tuple[str, ...]:
    """Return the folders that hold binaries."""
    names = (name.split("/") for name in archive.members if name.startswith("binaries/"))
    return tuple(sorted({parts[1] for parts in names if len(parts) > 2}))


def _no_binary(model: Model, interface: Interface, archive: Archive) -> str:
    """Return the reason why there is no binary, and the advice for the user."""
    here = this_platform()
    folders = here.folders(model.fmi_version)
    what = f"no binaries/{folders[0]}/{interface.identifier}{here.suffix} for this platform"
    places = {f"binaries/{folder}" for folder in folders}
    misnamed = [name for name in archive.members if name.rpartition("/")[0] in places]
    if misnamed:
        return f"{what}, but {printable(misnamed[0], 100)}; export the model again"
    has = printable(", ".join(model.platforms)) or "none"
    what = f"{what}; the FMU has binaries for: {has}"
    if any(name.startswith("sources/") and name.endswith(".c") for name in archive.members):
        return f"{what}, and C sources; compile them: giveway fmu compile {model.path}"
    return f"{what}; export it for {here}"


def misfit(start: bytes, wanted: Platform) -> str:
    """Return why a library cannot be loaded on a platform, as a phrase; empty if it seems to fit.

    Args:
        start: First bytes of the library, up to :data:`START`.
        wanted: Platform on which it has to run.
    """
    try:
        system, processors, library = _header(start)
    except (struct.error, IndexError):
        return "is cut off"
    if not system:
        return "is no library"
    if system != wanted.system:
        return f"is for {system}"
    if wanted.processor not in processors:
        return f"is for {' and '.join(processors) or 'another processor'}"
    return "" if library else "is a program or object file, no shared library"


def _header(start: bytes) -> tuple[str, tuple[str, ...], bool]:
    """Return system, processors and whether it is a shared library, by the file's header."""
    if start[:4] == b"\x7fELF":
        order = "<" if start[5] == 1 else ">"
        kind, machine = struct.unpack_from(f"{order}HH", start, 16)
        return "linux", _known(ELF_MACHINES, machine), kind == ELF_LIBRARY
    if start[:2] == b"MZ":
        (header,) = struct.unpack_from("<I", start, 0x3C)
        if header + 24 > len(start) and len(start) == START:
            return "windows", tuple(PE_MACHINES.values()), True  # header not among the bytes
        signature, machine = struct.unpack_from("<4sH", start, header)
        (flags,) = struct.unpack_from("<H", start, header + 22)
        if signature != b"PE\0\0":
            return "", (), False
        return "windows", _known(PE_MACHINES, machine), bool(flags & PE_LIBRARY)
    if start[:4] in {b"\xcf\xfa\xed\xfe", b"\xce\xfa\xed\xfe"}:
        machine, _subtype, kind = struct.unpack_from("<III", start, 4)
        return "darwin", _known(MACH_MACHINES, machine), kind in MACH_LIBRARIES
    if start[:4] == b"\xca\xfe\xba\xbe":  # universal binary: several Mach-O files in one
        (count,) = struct.unpack_from(">I", start, 4)
        machines = [struct.unpack_from(">I", start, 8 + 20 * n)[0] for n in range(min(count, 8))]
        return "darwin", tuple(name for m in machines for name in _known(MACH_MACHINES, m)), True
    return "", (), False


def _known(names: dict[int, str], machine: int) -> tuple[str, ...]:
    return (names[machine],) if machine in names else ()
