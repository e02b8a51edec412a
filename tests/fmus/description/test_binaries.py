"""Which binary runs here, told by its first bytes."""

from __future__ import annotations

import struct
import zipfile

import pytest

from fmus import bundled_fmu
from fmus.description.binaries import (
    Platform,
    binary_of,
    is_library,
    is_platform,
    misfit,
    name_note,
    this_platform,
)
from fmus.description.model import Kind
from fmus.description.reading import read_model
from fmus.errors import FmuPlatformError

# ---- binaries ----


def elf(machine, kind=3):
    return b"\x7fELF\x02\x01\x01" + bytes(9) + struct.pack("<HH", kind, machine) + bytes(100)


def pe(machine, flags=0x2000):
    head = b"MZ" + bytes(58) + struct.pack("<I", 64)
    return head + b"PE\0\0" + struct.pack("<H", machine) + bytes(16) + struct.pack("<H", flags)


def mach(machine):
    return struct.pack("<IIII", 0xFEEDFACF, machine, 0, 6) + bytes(100)


LINUX, ARM = Platform("x86_64", "linux"), Platform("aarch64", "linux")
WINDOWS, MAC = Platform("x86_64", "windows"), Platform("aarch64", "darwin")


@pytest.mark.parametrize(
    ("start", "platform", "reason"),
    [
        (elf(62), LINUX, ""),
        (elf(183), ARM, ""),
        (pe(0x8664), WINDOWS, ""),
        (mach(0x100000C), MAC, ""),
        (elf(183), LINUX, "is for aarch64"),
        (elf(3), LINUX, "is for x86"),
        (elf(9999), LINUX, "another processor"),
        (elf(62, kind=2), LINUX, "no shared library"),
        (elf(62)[:17], LINUX, "cut off"),
        (pe(0x8664), LINUX, "is for windows"),
        (mach(0x1000007), MAC, "is for x86_64"),
        (pe(0x8664, flags=0), WINDOWS, "no shared library"),
        (b"#!/bin/sh\n", LINUX, "no library"),
        (b"", LINUX, "no library"),
    ],
)
def test_a_library_tells_by_its_first_bytes_where_it_runs(start, platform, reason):
    assert reason in misfit(start, platform)
    assert bool(misfit(start, platform)) == bool(reason)


@pytest.mark.parametrize(
    ("platform", "fmi2", "fmi3"),
    [
        (LINUX, "linux64", "x86_64-linux"),
        (ARM, "aarch64-linux", "aarch64-linux"),  # FMI 2 has no name of its own for it
        (WINDOWS, "win64", "x86_64-windows"),
        (MAC, "darwin64", "aarch64-darwin"),
        (Platform("x86", "windows"), "win32", "x86-windows"),
    ],
)
def test_folders_of_the_standards(platform, fmi2, fmi3):
    assert platform.folders("2.0")[0] == fmi2
    assert platform.folders("3.0")[0] == fmi3
    assert fmi3 in platform.folders("2.0")  # tools use these names there, too


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_the_shipped_fmus_run_on_every_platform(version):
    model = read_model(bundled_fmu(version))
    (interface,) = model.interfaces.values()
    assert binary_of(model, interface).endswith(this_platform().suffix)
    with zipfile.ZipFile(model.path) as archive:
        for platform in (LINUX, ARM, WINDOWS, MAC):
            folders = [f for f in platform.folders(version) if f in model.platforms]
            name = f"binaries/{folders[0]}/{interface.identifier}{platform.suffix}"
            assert misfit(archive.read(name)[:4096], platform) == ""


@pytest.mark.skipif(str(this_platform()) != "x86_64-linux", reason="names this platform")
@pytest.mark.parametrize(
    ("members", "said"),
    [
        ({}, "binaries for: none"),
        ({"binaries/win64/car_cs.dll": b""}, "binaries for: win64; export it for x86_64-linux"),
        ({"sources/car.c": b""}, "and C sources; compile them: giveway fmu compile"),
        ({"binaries/linux64/car.so": elf(183)}, "car.so is for aarch64"),
        (
            {"binaries/linux64/car.so": elf(62), "binaries/linux64/tyre.so": elf(62)},
            "but binaries/linux64/car.so",
        ),
        ({"binaries/linux64/car_cs.so": elf(183)}, "car_cs.so is for aarch64"),
        ({"binaries/linux64/car_cs.so": pe(0x8664)}, "car_cs.so is for windows"),
        ({"binaries/linux64/car_cs.so": b"no library"}, "car_cs.so is no library"),
    ],
)
def test_no_binary_for_this_platform(fmi2, members, said, refused):
    model = read_model(fmi2(**members))
    with refused(FmuPlatformError, model.path, said):
        binary_of(model, model.interfaces[Kind.CO_SIMULATION])


@pytest.mark.skipif(str(this_platform()) != "x86_64-linux", reason="names this platform")
def test_the_only_library_counts_whatever_its_name(fmi2):
    model = read_model(fmi2(**{"binaries/linux64/car.so": elf(62), "binaries/linux64/x.txt": b""}))
    interface = model.interfaces[Kind.CO_SIMULATION]
    assert binary_of(model, interface) == "binaries/linux64/car.so"
    assert "called car.so" in name_note(interface, "binaries/linux64/car.so")
    assert not name_note(interface, f"binaries/linux64/{interface.identifier}.so")


def test_folders_of_platforms_and_names_of_libraries():
    platforms = ("linux64", "win32", "darwin64", "x86_64-linux", "aarch64-darwin", "armv7a-linux")
    assert all(map(is_platform, platforms))
    assert not any(map(is_platform, ("common", "lib", "linux", "lib64", "libs-x86", "64")))
    assert all(map(is_library, ("a/libm.so.6", "car.so", "b/x.dll", "x.dylib")))
    assert not any(map(is_library, ("a.so/readme", "sources/so.c", "x.dll.txt")))
