"""Loading an FMU's binary."""

from __future__ import annotations

import importlib.util
import subprocess
import sys

import fmpy
import pytest

from fmus import FmuPlatformError
from fmus.fmi.library import Library
from fmus.sources.compiler import TARGETS

HERE = next(target for target in TARGETS if target.folder == fmpy.platform_tuple)

needs_compiler = pytest.mark.skipif(
    importlib.util.find_spec("ziglang") is None or HERE.suffix != ".so",
    reason="for Linux, with ziglang: pip install giveway[build]",
)


def compiled(folder, name, source, *more):
    (folder / "source.c").write_text(source)
    subprocess.run(
        [sys.executable, "-m", "ziglang", "cc", "-target", HERE.zig, "-O1", "-shared", "-fPIC"]
        + [f"-Wl,-soname,{name}", "-o", name, "source.c", *more],
        cwd=folder,
        check=True,
    )
    return folder / name


@needs_compiler
def test_what_lies_beside_a_binary_is_found(tmp_path):
    """The system does not look there: export tools forget to say so in the binary."""
    compiled(tmp_path, "libtyre.so", "int tyre(void) { return 3; }")
    axle = "int tyre(void); int axle(void) { return tyre() + 1; }"
    compiled(tmp_path, "libaxle.so", axle, "-L.", "-ltyre")
    car = "int axle(void); int car(void) { return axle() + 1; }"
    path = compiled(tmp_path, "car.so", car, "-L.", "-laxle")
    library = Library(path, tmp_path / "car.fmu")
    assert library.function("car")() == 5
    assert library.optional("boat") is None
    with pytest.raises(FmuPlatformError, match=r"car\.fmu: its binary has no function boat"):
        library.function("boat")
    library.close()


@needs_compiler
def test_what_lies_elsewhere_in_the_archive_is_found(tmp_path):
    binaries, deep = tmp_path / "binaries/linux64", tmp_path / "resources/lib/deep"
    binaries.mkdir(parents=True)
    deep.mkdir(parents=True)
    compiled(deep, "libwing.so", "int wing(void) { return 3; }")
    car = "int wing(void); int car(void) { return wing() + 1; }"
    path = compiled(binaries, "car.so", car, f"-L{deep}", "-lwing")
    with pytest.raises(FmuPlatformError, match=r"libwing\.so"):
        Library(path, tmp_path / "car.fmu")
    library = Library(path, tmp_path / "car.fmu", tmp_path)
    assert library.function("car")() == 4
    library.close()


@needs_compiler
def test_what_a_binary_needs_and_nobody_has_is_named(tmp_path):
    compiled(tmp_path, "libdoor.so", "int door(void) { return 3; }")
    car = "int door(void); int car(void) { return door(); }"
    path = compiled(tmp_path, "car.so", car, "-L.", "-ldoor")
    (tmp_path / "libdoor.so").unlink()
    with pytest.raises(FmuPlatformError, match=r"car\.so cannot be loaded: libdoor\.so: cannot"):
        Library(path, tmp_path / "car.fmu")


def test_a_file_that_is_no_library(tmp_path):
    path = tmp_path / f"car{HERE.suffix}"
    path.write_bytes(b"\x7fELF and no more")
    with pytest.raises(FmuPlatformError, match=r"its binary car\.\w+ cannot be loaded: "):
        Library(path, tmp_path / "car.fmu")
