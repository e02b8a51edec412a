"""The archive check: what could do harm is refused with its reason, before anything is unpacked."""

from __future__ import annotations

import os
import random
import stat
import struct
import zipfile

import pytest

from fmus import bundled_fmu
from fmus.archive.archive_check import extract, open_archive
from fmus.errors import FmuArchiveError, FmuFileError

DESCRIPTION = b'<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0"/>'
MEGABYTE = 1 << 20


def with_mode(name, mode):
    info = zipfile.ZipInfo(name)
    info.create_system = 3
    info.external_attr = mode << 16
    return info


def test_a_sound_fmu_passes():
    fmu = bundled_fmu("2.0")
    archive = open_archive(fmu)
    assert archive.path == fmu
    assert archive.description.startswith(b"<?xml")
    assert "binaries/linux64/LongitudinalVehicle.so" in archive.members
    assert len(archive.sha256) == 64


# ---- no archive at all ----


def test_missing(tmp_path, refused):
    with refused(FmuFileError, tmp_path / "no.fmu", "no such file"):
        open_archive(tmp_path / "no.fmu")


def test_a_folder(tmp_path, refused):
    with refused(FmuFileError, tmp_path, "a folder"):
        open_archive(tmp_path)


def test_empty(tmp_path, refused):
    path = tmp_path / "car.fmu"
    path.touch()
    with refused(FmuFileError, path, "empty"):
        open_archive(path)


def test_a_pipe_is_not_waited_for(tmp_path, refused):
    path = tmp_path / "car.fmu"
    os.mkfifo(path)
    with refused(FmuFileError, path, "not a regular file"):
        open_archive(path)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read all")
def test_unreadable(archive, refused):
    path = archive()
    path.chmod(0)
    with refused(FmuFileError, path, "Permission denied"):
        open_archive(path)


@pytest.mark.parametrize("data", [b"I am no FMU\n", b"PK\x03\x04", b"\x7fELF" + bytes(100)])
def test_not_a_zip_archive(tmp_path, data, refused):
    path = tmp_path / "car.fmu"
    path.write_bytes(data)
    with refused(FmuFileError, path, "not a zip archive"):
        open_archive(path)


@pytest.mark.parametrize("part", [0.1, 0.5, 0.9, 0.999])
def test_cut_off(tmp_path, part, refused):
    data = bundled_fmu("2.0").read_bytes()
    path = tmp_path / "car.fmu"
    path.write_bytes(data[: int(len(data) * part)])
    with refused(FmuFileError, path, "copy or export it again"):
        open_archive(path)


def test_damaged_inside(tmp_path, refused):
    data = bytearray(bundled_fmu("2.0").read_bytes())
    first = data.index(b"\x7fELF")
    data[first + 4000 : first + 4016] = b"damaged bytes..."
    path = tmp_path / "car.fmu"
    path.write_bytes(data)
    with refused(FmuArchiveError, path, "damaged", "linux64"):
        open_archive(path)


@pytest.mark.parametrize("seed", range(40))
def test_whatever_byte_is_wrong_the_answer_is_a_line(archive, tmp_path, seed):
    """Ten wrong bytes in the archive's own structure: either refused, or it did not matter."""
    data = bytearray(
        archive(("resources/a.txt", b"a" * 50), ("resources/b.txt", b"b" * 50)).read_bytes()
    )
    state = seed + 1
    for _ in range(10):
        state = state * 6364136223846793005 + 1442695040888963407 & (1 << 64) - 1
        data[(state >> 33) % len(data)] = state >> 56
    path = tmp_path / "bent.fmu"
    path.write_bytes(data)
    try:
        open_archive(path)
        answer = f"{path}: passed"
    except FmuFileError as error:
        answer = str(error)
    assert answer.startswith(str(path))
    assert answer.isprintable()


# ---- no FMU inside ----


def test_without_a_model_description(archive, refused):
    path = archive(("readme.txt", b""), description=None)
    with refused(FmuFileError, path, "no modelDescription.xml"):
        open_archive(path)


def test_zipped_with_its_folder(archive, refused):
    path = archive(("car/modelDescription.xml", DESCRIPTION), description=None)
    with refused(FmuFileError, path, "in its folder car/", "zip the contents"):
        open_archive(path)


def test_an_fmu_in_an_archive(archive, refused):
    path = archive(("delivery/car.fmu", b""), description=None)
    with refused(FmuFileError, path, "delivery/car.fmu", "unpack it"):
        open_archive(path)


# ---- names ----


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("../evil.txt", "leads out"),
        ("resources/../../evil.txt", "leads out"),
        ("binaries/..", "leads out"),
        ("/etc/evil", "absolute"),
        ("C:/evil.txt", "absolute"),
        ("c:evil.txt", "absolute"),
        ("resources/D:/evil.txt", "absolute"),
        ("..\\evil.txt", "leads out"),
        (".\\resources\\..\\..\\evil.txt", "leads out"),
        ("./../evil.txt", "leads out"),
        ("\\\\server\\evil.txt", "absolute"),
        (".//etc/evil", "absolute"),
        ("D:\\evil.txt", "absolute"),
        ("./C:evil.txt", "absolute"),
        ("resources\\ .\\data.txt", "plain path"),
        (".", "plain path"),
        ("resources//data.txt", "plain path"),
        ("resources/\x1b[2J.txt", "control characters"),
        ("resources/two\nlines.txt", "control characters"),
        ("resources/" + "n" * 2000, "too long"),
    ],
)
def test_a_name_that_no_fmu_needs(archive, name, reason, refused):
    path = archive((name, b"evil"))
    with refused(FmuArchiveError, path, reason):
        open_archive(path)


def test_names_are_judged_as_they_are_unpacked(archive, tmp_path, refused):
    folder = ("./", b""), (".\\", b""), ("./resources\\", b"")
    written = (*folder, ("./binaries\\linux64/.\\a.so", b"one"), ("resources\\a.txt", b"two"))
    path = archive(*written)
    opened = open_archive(path)
    (tmp_path / "out").mkdir()
    names = {"modelDescription.xml", "binaries/linux64/a.so", "resources/a.txt"}
    assert set(opened.members) == names
    extract(opened, tmp_path / "out", lambda _name: True)
    found = (p for p in (tmp_path / "out").rglob("*") if p.is_file())
    assert {p.relative_to(tmp_path / "out").as_posix() for p in found} == names
    other = archive(("resources/a.txt", b"one"), (".\\resources\\a.txt", b"two"), name="two.fmu")
    with refused(FmuArchiveError, other, "with different contents"):
        open_archive(other)
    for twice in ("RESOURCES\\a.txt", "./modelDescription.XML"):
        with refused(FmuArchiveError, "twice"):
            open_archive(archive(("resources/a.txt", b""), (twice, b""), name="case.fmu"))
    with refused(FmuArchiveError, "also a file"):
        open_archive(archive(("resources", b""), ("./resources\\a.txt", b""), name="f.fmu"))


def test_a_name_that_hides_its_end_behind_a_nul(archive, refused):
    path = archive(("resources/a.txtXevil", b""))
    path.write_bytes(path.read_bytes().replace(b"a.txtXevil", b"a.txt\0evil"))
    with refused(FmuArchiveError, path, "control characters"):
        open_archive(path)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("resources/a.txt", "resources/A.txt"),
        ("modelDescription.xml", "MODELDESCRIPTION.XML"),
        ("resources/stra\N{LATIN SMALL LETTER SHARP S}e", "resources/STRASSE"),
    ],
)
def test_two_names_that_are_one_on_some_systems(archive, one, other, refused):
    members = [(name, b"") for name in (one, other) if name != "modelDescription.xml"]
    with refused(FmuArchiveError, "twice"):
        open_archive(archive(*members))


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_the_same_name_twice(archive, refused):
    path = archive(("modelDescription.xml", b"<other/>"))
    with refused(FmuArchiveError, path, "modelDescription.xml", "twice"):
        open_archive(path)


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_the_same_file_twice_is_that_file(archive, tmp_path):
    members = [("resources/a.txt", b"one"), ("resources/a.txt", b"one")]
    opened = open_archive(archive(*members, ("modelDescription.xml", DESCRIPTION)))
    (tmp_path / "out").mkdir()
    extract(opened, tmp_path / "out", lambda name: name.startswith("resources/"))
    assert (tmp_path / "out/resources/a.txt").read_bytes() == b"one"


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize("other", [b"two", b"one\0", b"", b"o" * 3_000_000])
def test_one_name_for_two_contents(archive, refused, other):
    path = archive(("resources/a.txt", b"one"), ("resources/a.txt", other))
    with refused(FmuArchiveError, path, "resources/a.txt", "different contents"):
        open_archive(path)


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_a_bomb_of_equal_files(archive, refused):
    part = b"\0" * (4 << 20)
    with refused(FmuArchiveError, "zip bomb"):
        open_archive(archive(*(("resources/same", part) for _ in range(8))))


def test_a_file_that_is_also_a_folder(archive, refused):
    path = archive(("resources", b"a file"), ("resources/a.txt", b""))
    with refused(FmuArchiveError, path, "resources/a.txt", "also a file"):
        open_archive(path)


# ---- kinds of members ----


@pytest.mark.parametrize(
    ("kind", "reason"),
    [
        (stat.S_IFLNK, "symbolic link"),
        (stat.S_IFIFO, "special file"),
        (stat.S_IFCHR, "special file"),
        (stat.S_IFSOCK, "special file"),
    ],
)
def test_only_files_and_folders(archive, kind, reason, refused):
    path = archive((with_mode("resources/link", kind | 0o777), b"/etc/passwd"))
    with refused(FmuArchiveError, path, "resources/link", reason):
        open_archive(path)


def test_encrypted(archive, refused):
    path = archive(("resources/secret", b"x" * 100))
    data = bytearray(path.read_bytes())
    last = data.rindex(b"PK\x01\x02")
    data[last + 8] |= 1
    path.write_bytes(data)
    with refused(FmuArchiveError, path, "resources/secret", "encrypted"):
        open_archive(path)


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_a_compression_that_fmi_does_not_allow(archive, method, refused):
    info = zipfile.ZipInfo("resources/data")
    info.compress_type = method
    path = archive((info, b"x" * 100))
    with refused(FmuArchiveError, path, "resources/data", f"method {method}"):
        open_archive(path)


# ---- bombs ----


def test_a_bomb(archive, refused):
    path = archive(("resources/zeros", bytes(64 * MEGABYTE)))
    with refused(FmuArchiveError, path, "resources/zeros", "zip bomb", "64 MB"):
        open_archive(path)


def test_a_bomb_of_many_small_parts(archive, refused):
    part = bytes(MEGABYTE)
    path = archive(*((f"resources/{n}", part) for n in range(40)))
    with refused(FmuArchiveError, path, "zip bomb", "40 MB"):
        open_archive(path)


def test_what_is_honestly_large_passes_without_compression(archive):
    info = zipfile.ZipInfo("resources/zeros")  # stored
    path = archive((info, bytes(20 * MEGABYTE)))
    assert "resources/zeros" in open_archive(path).members


def test_large_resources_that_do_not_compress_much(archive):
    noise = random.Random(0).randbytes(4 * MEGABYTE) * 4
    path = archive(("resources/map", noise), ("resources/again", noise[::-1]))
    assert len(noise) == 16 * MEGABYTE
    assert open_archive(path).members["resources/map"].file_size == 16 * MEGABYTE


def test_members_that_share_their_bytes(archive, tmp_path, refused):
    """A zip bomb without a high ratio per member: many entries of the list, one body."""
    path = archive(*((f"resources/{n}", b"x" * 1000) for n in range(3)))
    data = path.read_bytes()
    start = data.index(b"PK\x01\x02")
    place = data.index(b"PK\x01\x02", data.index(b"resources/0", start))
    first = struct.unpack_from("<I", data, data.rindex(b"PK\x01\x02", 0, place) + 42)
    bent = bytearray(data)
    struct.pack_into("<I", bent, place + 42, *first)
    path.write_bytes(bent)
    with refused(FmuArchiveError, path, "overlaps"):
        open_archive(path)


def test_a_list_of_members_that_is_a_bomb_itself(archive, refused):
    path = archive()
    data = bytearray(path.read_bytes())
    end = data.rindex(b"PK\x05\x06")
    struct.pack_into("<I", data, end + 12, 1 << 30)  # its length, so it claims
    struct.pack_into("<I", data, end + 16, 0)
    path.write_bytes(bytes(1 << 16) + data)
    with refused(FmuFileError, path):
        open_archive(path)


def test_very_many_members(archive, refused):
    path = archive(*((str(n), b"") for n in range(50_000)))
    with refused(FmuArchiveError, path, "50001 members"):
        open_archive(path)
