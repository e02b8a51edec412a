"""One library per FMI version, compiled for this platform, kept between sessions."""

from __future__ import annotations

import hashlib
import importlib.util
import platform
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Final

from fmus.sources import compiler

SOURCE: Final = Path(__file__).parent / "source"
COMMON: Final = ("car.c", "instance.c", "faults.c")
FLAGS: Final = (
    "-std=gnu11",
    "-O1",
    "-g0",
    "-fPIC",
    "-fvisibility=hidden",
    "-ffp-contract=off",
    "-Wall",
    "-Werror",
)


def here() -> compiler.Target:
    """The platform that the tests run on."""
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(
        platform.machine().lower(), platform.machine().lower()
    )
    folder = f"{machine}-{platform.system().lower()}"
    return next(target for target in compiler.TARGETS if target.folder == folder)


def library(fmi: str, cache: Path) -> bytes:
    """The bytes of the shared library for an FMI version.

    Args:
        fmi: "1.0", "2.0" or "3.0".
        cache: a folder that processes may share; the name of a file in it tells its sources.
    """
    target = here()
    digest = hashlib.sha256(f"{compiler.ZIG_VERSION} {target} {FLAGS}".encode())
    for path in sorted(SOURCE.iterdir()):
        digest.update(path.read_bytes())
    file = cache / f"car-fmi{fmi[0]}-{digest.hexdigest()[:16]}{target.suffix}"
    if not file.is_file():
        cache.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=cache) as folder:
            made = Path(folder, file.name)
            _compile(fmi, target, made)
            made.replace(file)  # at once, also for others that compile it at this moment
    return file.read_bytes()


def without(library_: bytes, function: str) -> bytes:
    """The library without one of its functions: its name in the symbol table is another."""
    name = f"\0{function}\0".encode()
    if library_.count(name) != 1:
        msg = f"{function}: not among the library's functions"
        raise ValueError(msg)
    return library_.replace(name, f"\0{function[:-1]}_\0".encode())


def _compile(fmi: str, target: compiler.Target, output: Path) -> None:
    spec = importlib.util.find_spec("fmpy")
    if spec is None or spec.origin is None:
        msg = "FMPy is not installed: the zoo needs its copy of the standard's headers"
        raise RuntimeError(msg)
    headers = Path(spec.origin).parent / "c-code"
    libraries = () if target.suffix == ".dll" else ("-lm", "-lpthread")
    subprocess.run(
        [sys.executable, "-m", "ziglang", "cc", "-target", target.zig, *FLAGS]
        + ["-I", str(headers), "-shared", "-s", "-o", str(output)]
        + [*COMMON, f"fmi{fmi[0]}.c", *libraries],
        cwd=SOURCE,
        check=True,
    )
