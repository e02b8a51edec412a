"""Archives and libraries whose bytes depend on their contents only."""

import struct
import time
import zipfile
from pathlib import Path

import pytest

from fmus.archive.packing import universal_library, without_timestamp, write_archive

MEMBERS = {"modelDescription.xml": b"<a/>", "binaries/linux64/a.so": bytes(range(256))}


def test_an_archive_has_the_same_bytes_at_another_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_archive(tmp_path / "one.fmu", MEMBERS)
    now = time.time()
    monkeypatch.setattr(time, "time", lambda: now + 1e8)
    write_archive(tmp_path / "two.fmu", MEMBERS)
    assert (tmp_path / "one.fmu").read_bytes() == (tmp_path / "two.fmu").read_bytes()
    with zipfile.ZipFile(tmp_path / "one.fmu") as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == MEMBERS


def test_only_the_link_time_of_a_windows_library_is_cleared() -> None:
    header = 0x80
    library = bytearray(range(256))
    struct.pack_into("<I", library, 0x3C, header)
    cleared = without_timestamp(bytes(library))
    assert cleared[header + 8 : header + 12] == bytes(4)
    assert cleared[: header + 8] == library[: header + 8]
    assert cleared[header + 12 :] == library[header + 12 :]


def test_each_slice_is_where_the_header_of_the_library_says() -> None:
    slices = [struct.pack("<III", 0xFEEDFACF, cpu, 3) + bytes([cpu]) * 20_000 for cpu in (7, 12)]
    joined = universal_library(*slices)
    magic, count = struct.unpack_from(">II", joined)
    assert (magic, count) == (0xCAFEBABE, 2)
    for number, data in enumerate(slices):
        cpu, _, offset, size, align = struct.unpack_from(">IIIII", joined, 8 + 20 * number)
        assert cpu == (7, 12)[number]
        assert offset % (1 << align) == 0
        assert joined[offset : offset + size] == data
