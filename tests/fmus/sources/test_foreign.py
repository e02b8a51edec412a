"""FMUs with sources only, or for another platform: compiled, they drive like any other."""

from __future__ import annotations

import re
import zipfile

import pytest

from fmus import FmuBuildError, FmuPlatformError, VehicleFmu, bundled_fmu, describe
from fmus.description.binaries import this_platform
from fmus.profile.bundled import BUNDLED_PROFILE
from fmus.sources.foreign import compile_fmu

H = 0.05  # [s]


def without_binaries(name):
    return not name.startswith("binaries/")


def driven(path):
    with VehicleFmu(path, step_size=H, profile=BUNDLED_PROFILE) as car:
        car.start(position=1.0, speed=4.0)
        motion = []
        for force in (500.0, 2000.0, 0.0, -3000.0):
            car.step(force)
            motion.append((car.position, car.speed, car.acceleration))
        return motion


def test_a_source_only_fmu_is_compiled_and_drives_as_its_binary(fmu, remake, tmp_path):
    plain = remake(keep=without_binaries)
    with pytest.raises(FmuPlatformError, match=r"C sources; compile them: giveway fmu compile"):
        driven(plain)
    out = tmp_path / "here.fmu"
    (made,) = compile_fmu(plain, out)
    assert this_platform().suffix in made
    assert driven(out) == driven(fmu)
    assert describe(out).guid == describe(fmu).guid
    assert sorted(p.name for p in tmp_path.iterdir()) == ["edited.fmu", "here.fmu"]


def test_an_fmu_for_another_platform_keeps_its_binaries(fmu, remake, tmp_path):
    other = remake(keep=lambda name: without_binaries(name) or ".dll" in name)
    out = tmp_path / "here.fmu"
    compile_fmu(other, out)
    with zipfile.ZipFile(other) as before, zipfile.ZipFile(out) as after:
        added = set(after.namelist()) - set(before.namelist())
        assert all(after.read(name) == before.read(name) for name in before.namelist())
    assert len(added) == 1
    assert driven(out) == driven(fmu)


@pytest.mark.parametrize("fmi_version", ["2.0"], indirect=True)
def test_names_meant_for_static_linking_are_those_of_a_library(remake, tmp_path):
    """FMI2_FUNCTION_PREFIX: without an override each function is called Model_fmi2..."""
    first = b"#define FMI2_FUNCTION_PREFIX LongitudinalVehicle_\n"
    source = zipfile.ZipFile(bundled_fmu("2.0")).read("sources/fmi2.c")
    plain = remake(
        keep=without_binaries,
        replace=lambda name: first + source if name == "sources/fmi2.c" else None,
    )
    out = tmp_path / "here.fmu"
    compile_fmu(plain, out)
    assert driven(out) == driven(bundled_fmu("2.0"))


def test_what_another_file_includes_is_not_compiled_twice(tmp_path):
    """Dymola lists no files: its all.c includes the others, in C that is older than C99."""
    path, out = tmp_path / "dymola.fmu", tmp_path / "here.fmu"
    first = b"static int old() { return getpid(); }\n"
    with zipfile.ZipFile(bundled_fmu("2.0")) as ours, zipfile.ZipFile(path, "w") as theirs:
        names = [name for name in ours.namelist() if without_binaries(name)]
        for name in names:
            data = ours.read(name)
            if name == "modelDescription.xml":
                data = re.sub(rb"<SourceFiles>.*</SourceFiles>", b"", data, flags=re.DOTALL)
            theirs.writestr(name, data)
        included = (n.removeprefix("sources/") for n in names if n.endswith(".c"))
        every = b"".join(b'#include "%s"\n' % name.encode() for name in included)
        theirs.writestr("sources/all.c", first + every)
        tool = zipfile.ZipInfo("resources/tool")
        tool.external_attr = 0o100755 << 16
        theirs.writestr(tool, b"#!/bin/sh\n")
    compile_fmu(path, out)
    assert driven(out) == driven(bundled_fmu("2.0"))
    with zipfile.ZipFile(out) as made:
        assert made.getinfo("resources/tool").external_attr >> 16 == 0o100755


@pytest.mark.parametrize("fmi_version", ["2.0"], indirect=True)
def test_sources_that_do_not_compile_are_one_line_without_traces(remake, tmp_path, refused):
    broken = remake(
        keep=without_binaries,
        replace=lambda name: b"int main( {\n" if name == "sources/plant.c" else None,
    )
    with refused(FmuBuildError, broken, "its sources do not compile", "plant.c", "CC names"):
        compile_fmu(broken, tmp_path / "here.fmu")
    assert [p.name for p in tmp_path.iterdir()] == ["edited.fmu"]


@pytest.mark.parametrize("fmi_version", ["2.0"], indirect=True)
def test_what_is_no_fmu_after_compiling_is_refused(remake, tmp_path, refused):
    empty = remake(
        keep=without_binaries,
        replace=lambda name: b"static int nothing;\n" if name.endswith(".c") else None,
    )
    with refused(FmuBuildError, empty, "defines none of the functions"):
        compile_fmu(empty, tmp_path / "here.fmu")


@pytest.mark.parametrize("fmi_version", ["2.0"], indirect=True)
@pytest.mark.parametrize(
    ("named", "said"),
    [("../modelDescription.c", "not below sources/"), ("/etc/passwd.c", "not below sources/"),
     ("missing.c", "not in the archive")],
)  # fmt: skip
def test_sources_are_taken_from_below_sources_only(remake, tmp_path, refused, named, said):
    odd = remake(
        keep=without_binaries, edit=lambda xml: xml.replace('name="plant.c"', f'name="{named}"')
    )
    with refused(FmuBuildError, odd, named, said):
        compile_fmu(odd, tmp_path / "here.fmu")


@pytest.mark.parametrize("fmi_version", ["2.0"], indirect=True)
def test_without_sources_it_is_said(remake, tmp_path, refused):
    bare = remake(keep=lambda name: not name.startswith("sources/"))
    with refused(FmuBuildError, bare, "no C sources in the archive", "export"):
        compile_fmu(bare, tmp_path / "here.fmu")


@pytest.mark.parametrize("fmi_version", ["2.0"], indirect=True)
def test_a_compiler_that_is_not_there_is_named(remake, tmp_path, refused, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler -O1")
    with refused(FmuBuildError, "no-such-compiler", "CC"):
        compile_fmu(remake(keep=without_binaries), tmp_path / "here.fmu")
