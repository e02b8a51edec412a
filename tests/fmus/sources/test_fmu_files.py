"""The shipped FMUs: valid, complete, reproducible, and usable by other hosts of FMUs."""

from __future__ import annotations

import hashlib
import importlib.util
import struct
import zipfile
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

from fmus import VehicleFmu, bundled_fmu, describe

needs_compiler = pytest.mark.skipif(
    importlib.util.find_spec("ziglang") is None,
    reason="ziglang is not installed: pip install giveway[build]",
)

ELF_MACHINE = {62: "x86_64", 183: "aarch64"}
PE_MACHINE = {0x8664: "x86_64"}
MACH_CPU = {0x01000007: "x86_64", 0x0100000C: "aarch64"}


def platforms(library: bytes) -> set[str]:
    """What a shared library runs on, from its header."""
    if library[:4] == b"\x7fELF":
        (machine,) = struct.unpack_from("<H", library, 18)
        return {f"{ELF_MACHINE[machine]}-linux"}
    if library[:2] == b"MZ":
        (header,) = struct.unpack_from("<I", library, 0x3C)
        assert library[header : header + 4] == b"PE\0\0"
        (machine,) = struct.unpack_from("<H", library, header + 4)
        return {f"{PE_MACHINE[machine]}-windows"}
    if library[:4] == b"\xca\xfe\xba\xbe":  # several processors in one file
        (count,) = struct.unpack_from(">I", library, 4)
        found = set()
        for i in range(count):
            _, _, offset, size, _ = struct.unpack_from(">IIIII", library, 8 + 20 * i)
            found |= platforms(library[offset : offset + size])
        return found
    magic, cpu = struct.unpack_from("<II", library)
    assert magic == 0xFEEDFACF
    return {f"{MACH_CPU[cpu]}-darwin"}


def test_fmi_2_is_the_default():
    assert bundled_fmu() == bundled_fmu("2.0")


def test_fmpys_validation_has_no_findings(fmu):
    assert validate_fmu(str(fmu)) == []


def test_all_five_platforms_are_there(fmu):
    with zipfile.ZipFile(fmu) as archive:
        libraries = [n for n in archive.namelist() if n.startswith("binaries/")]
        found = set().union(*(platforms(archive.read(n)) for n in libraries))
    assert found == {
        "x86_64-linux",
        "aarch64-linux",
        "x86_64-windows",
        "x86_64-darwin",
        "aarch64-darwin",
    }


def test_every_real_variable_has_a_declared_unit(fmu):
    description = read_model_description(str(fmu))
    declared = {unit.name for unit in description.unitDefinitions}
    units = {v.name: v.unit for v in description.modelVariables if v.type in {"Real", "Float64"}}
    assert set(units.values()) <= declared
    assert units == {
        "time": "s",
        "force": "N",
        "position": "m",
        "speed": "m/s",
        "acceleration": "m/s2",
        "M": "kg",
        "alpha": "N.s/m",
        "s0": "m",
        "v0": "m/s",
    }


def test_the_sources_that_the_description_names_are_inside(fmu):
    with zipfile.ZipFile(fmu) as archive:
        names = set(archive.namelist())
    front_end = "fmi2.c" if bundled_fmu("2.0") == fmu else "fmi3.c"
    assert {f"sources/{n}" for n in ("plant.c", "plant.h", "instance.c", front_end)} <= names


def test_nothing_in_the_archive_depends_on_clock_or_zlib(fmu):
    with zipfile.ZipFile(fmu) as archive:
        assert {m.date_time for m in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert {m.compress_type for m in archive.infolist()} == {zipfile.ZIP_STORED}


@needs_compiler
def test_a_rebuild_gives_the_shipped_bytes(tmp_path, monkeypatch):
    from fmus.sources.fmu_files import build

    monkeypatch.setenv("ZIG_LOCAL_CACHE_DIR", str(tmp_path / "cache"))  # really compile
    rebuilt = build(tmp_path / "elsewhere")
    assert {p.name for p in rebuilt} == {bundled_fmu("2.0").name, bundled_fmu("3.0").name}
    for path in rebuilt:
        assert path.read_bytes() == (bundled_fmu().parent / path.name).read_bytes(), path.name


@pytest.mark.parametrize("exact", [False, True])
def test_fmpys_own_simulation_gives_the_same_numbers(fmu, exact):
    h, n = 0.125, 80  # a power of two: FMPy's grid of times is exact too
    t = h * np.arange(n + 1)
    force = np.where(t < 6.0, 900.0, -2500.0)
    rows = np.array(list(zip(t, force, strict=True)), dtype=[("time", float), ("force", float)])
    theirs = simulate_fmu(
        str(fmu),
        stop_time=h * n,
        step_size=h,
        output_interval=h,
        input=rows,
        start_values={"v0": 3.0, "s0": -7.0, "exact": exact},
    )
    ours = []
    with VehicleFmu(fmu, step_size=h, start_values={"exact": exact}) as vehicle:
        vehicle.start(position=-7.0, speed=3.0)
        for k in range(n + 1):
            ours.append((vehicle.time, vehicle.position, vehicle.speed, vehicle.acceleration))
            # FMPy interpolates its input linearly: the step of the force is one sample wide.
            vehicle.step(force[k])
    assert np.array_equal(ours, [list(row) for row in theirs])


def test_description_names_the_fmu_for_the_record(fmu, fmi_version):
    description = describe(fmu)
    assert description.name == "LongitudinalVehicle"
    assert description.fmi_version == fmi_version
    assert description.guid == read_model_description(str(fmu)).guid
    assert "giveway" in description.generation_tool
    assert description.sha256 == hashlib.sha256(Path(fmu).read_bytes()).hexdigest()
