"""The shipped vehicle FMU with pieces of its C source replaced, compiled for this platform."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING

import fmpy
import pytest

from fmus.profile.bundled import MODEL, bundled_fmu
from fmus.sources.compiler import COMPILE, TARGETS
from fmus.sources.fmu_files import FRONT_ENDS

if TYPE_CHECKING:
    from collections.abc import Callable

HERE = next(target for target in TARGETS if target.folder == fmpy.platform_tuple)
HEADERS = Path(fmpy.__file__).parent / "c-code"


@pytest.fixture(scope="session")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., bytes]:
    """The library of one FMI version after a replacement, compiled by one call of the compiler."""

    def library(fmi_version: str, file: str, old: str, new: str) -> bytes:
        folder = tmp_path_factory.mktemp("source")
        with zipfile.ZipFile(bundled_fmu(fmi_version)) as archive:
            for name in archive.namelist():
                if name.startswith("sources/"):
                    (folder / name.removeprefix("sources/")).write_bytes(archive.read(name))
        text = (folder / file).read_text(encoding="utf-8")
        assert text.count(old) == 1
        (folder / file).write_text(text.replace(old, new), encoding="utf-8")
        sources = ("plant.c", "instance.c", FRONT_ENDS[fmi_version])
        output = f"{MODEL}{HERE.suffix}"
        subprocess.run(
            [sys.executable, "-m", "ziglang", "cc", "-target", HERE.zig, *COMPILE]
            + ["-I", str(HEADERS), "-shared", "-s", *sources, "-o", output],
            cwd=folder,
            check=True,
        )
        return (folder / output).read_bytes()

    return library


@pytest.fixture
def rebuilt(fmi_version, remake, compiled) -> Callable[..., Path]:
    """Make the shipped FMU with a piece of a C source replaced."""
    if importlib.util.find_spec("ziglang") is None:
        pytest.skip("ziglang is not installed: pip install giveway[build]")

    def make(file: str, old: str, new: str) -> Path:
        library = compiled(fmi_version, file, old, new)
        return remake(replace=lambda name: library if name.startswith("binaries/") else None)

    return make
