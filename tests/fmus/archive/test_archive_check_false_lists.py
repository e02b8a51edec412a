"""The archive check again: archives that say one thing in their list of members and are another."""

from __future__ import annotations

import struct
import sys
import unicodedata
import zipfile
import zlib
from pathlib import Path

import pytest

from fmus.archive.archive_check import open_archive
from fmus.errors import FmuArchiveError

DESCRIPTION = b'<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0"/>'
MEGABYTE = 1 << 20
CLAIMED = 1000  # [bytes]


def write(path, *members):
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("modelDescription.xml", DESCRIPTION)
        for name in members:
            file.writestr(name, b"")
    return path


def inflating(path, data):
    """An archive whose only member, the model description, claims to be small."""
    name = b"modelDescription.xml"
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    packed = packer.compress(data) + packer.flush()
    what = struct.pack("<IIIHH", zlib.crc32(data), len(packed), CLAIMED, len(name), 0)
    local = struct.pack("<4sHHHHH", b"PK\3\4", 20, 0, zlib.DEFLATED, 0, 33) + what + name + packed
    entry = struct.pack("<4sHHHHHH", b"PK\1\2", 20, 20, 0, zlib.DEFLATED, 0, 33) + what
    entry += struct.pack("<HHHII", 0, 0, 0, 0, 0) + name
    end = struct.pack("<4sHHHHIIH", b"PK\5\6", 0, 0, 1, 1, len(entry), len(local), 0)
    path.write_bytes(local + entry + end)
    return path


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_a_description_larger_than_declared_is_not_inflated(tmp_path):
    path = inflating(tmp_path / "car.fmu", DESCRIPTION + bytes(300 * MEGABYTE))
    most_memory()
    before = most_memory()
    with pytest.raises(FmuArchiveError, match=r"damaged: .*modelDescription\.xml"):
        open_archive(path)
    assert most_memory() - before < 20 * MEGABYTE


def most_memory():
    """What this process had of the memory at most [bytes], since the last call."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    return int(status.partition("VmHWM:")[2].split()[0]) * 1024


def test_two_codings_of_one_name(tmp_path):
    name = "resources/caf\N{LATIN SMALL LETTER E WITH ACUTE}.txt"
    path = write(tmp_path / "car.fmu", name, unicodedata.normalize("NFD", name))
    with pytest.raises(FmuArchiveError, match="twice in the archive"):
        open_archive(path)


@pytest.mark.parametrize("part", [".. ", "...", " ", ". ."])
def test_a_folder_that_windows_takes_for_another(tmp_path, part):
    path = write(tmp_path / "car.fmu", f"resources/{part}/x")
    with pytest.raises(FmuArchiveError, match="not a plain path"):
        open_archive(path)
