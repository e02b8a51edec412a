"""Archives and libraries whose bytes depend on their contents only."""

import struct
import zipfile
from collections.abc import Collection, Mapping
from pathlib import Path


def write_archive(
    path: Path, members: Mapping[str, bytes], executables: Collection[str] = ()
) -> None:
    """Write a zip archive whose bytes depend on its members only.

    Args:
        path: File to write.
        members: Contents by name.
        executables: Names of the members that may be executed.
    """
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        for name, data in members.items():
            info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            info.create_system = 3  # Unix, on every platform
            info.external_attr = (0o100755 if name in executables else 0o100644) << 16
            archive.writestr(info, data)


def without_timestamp(library: bytes) -> bytes:
    """Clear the link time in a Windows library (TimeDateStamp of its COFF header)."""
    (header,) = struct.unpack_from("<I", library, 0x3C)
    return library[: header + 8] + bytes(4) + library[header + 12 :]


def universal_library(*slices: bytes) -> bytes:
    """Join Mach-O libraries of different processors into one (what ``lipo -create`` does).

    The format is ``struct fat_header`` and ``struct fat_arch`` of Apple's <mach-o/fat.h>, big
    endian. Each slice repeats its processor's type and starts on a page of 16 KiB.
    """
    page = 1 << 14
    header = struct.pack(">II", 0xCAFEBABE, len(slices))
    body = b""
    for data in slices:
        processor, subtype = struct.unpack_from("<II", data, 4)
        offset = page + len(body)
        header += struct.pack(">IIIII", processor, subtype, offset, len(data), 14)
        body += data + bytes(-len(data) % page)
    return header.ljust(page, b"\0") + body
