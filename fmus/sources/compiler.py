"""One pinned cross-compiler for all platforms: the ``ziglang`` of the extra ``giveway[build]``."""

import importlib.util
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from fmus.archive.packing import without_timestamp
from fmus.errors import FmuBuildError

ZIG_VERSION: Final = "0.16.0"
WINDOWS_RUNTIME: Final = "windows_runtime.c"
COMPILE: Final = (
    "-std=c11",
    "-O2",
    "-g0",
    "-fPIC",
    "-fvisibility=hidden",
    "-ffp-contract=off",  # no fused multiply-add: the same bits on every platform
    "-mcpu=baseline",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-Wno-unused-parameter",  # the front ends' signatures are given by the standard
)
UCRT: Final = tuple(
    f"-lapi-ms-win-crt-{part}-l1-1-0" for part in ("stdio", "heap", "string", "private")
)


@dataclass(frozen=True)
class Target:
    """A platform: zig's name for it, FMI 3's folder, and how a library is linked."""

    zig: str
    folder: str
    suffix: str
    link: tuple[str, ...] = ()
    extra_sources: tuple[str, ...] = ()


LINUX_X86: Final = Target("x86_64-linux-gnu.2.17", "x86_64-linux", ".so")
LINUX_ARM: Final = Target("aarch64-linux-gnu.2.17", "aarch64-linux", ".so")
WINDOWS: Final = Target(
    "x86_64-windows-gnu", "x86_64-windows", ".dll", ("-nostdlib", *UCRT), (WINDOWS_RUNTIME,)
)
MACOS_X86: Final = Target("x86_64-macos.11.0", "x86_64-darwin", ".dylib")
MACOS_ARM: Final = Target("aarch64-macos.11.0", "aarch64-darwin", ".dylib")
TARGETS: Final = (LINUX_X86, LINUX_ARM, WINDOWS, MACOS_X86, MACOS_ARM)


def compile_library(
    folder: Path,
    sources: tuple[str, ...],
    target: Target,
    output: str,
    flags: tuple[str, ...] = (),
) -> bytes:
    """Compile C sources in ``folder`` for a platform and return the shared library's bytes.

    Raises:
        FmuBuildError: zig refuses; the message is the compiler's first line.
    """
    objects = []
    for source in (*sources, *target.extra_sources):
        objects.append(f"{Path(source).stem}.{target.folder}.o")
        options = (*COMPILE, *flags, "-I", str(_fmi_headers()))
        _zig(folder, "cc", "-target", target.zig, *options, "-c", source, "-o", objects[-1])
    name = output + target.suffix
    link = ["-target", target.zig, "-shared", "-s", *objects, *target.link, "-o", name]
    if target.suffix == ".dylib":  # else the build's path would be the library's own name
        link.append(f"-Wl,-install_name,@rpath/{name}")
    _zig(folder, "cc", *link)
    library = (folder / name).read_bytes()
    return without_timestamp(library) if target.suffix == ".dll" else library


def require_compiler() -> None:
    """Refuse to go on without the compiler that the FMUs' bytes depend on.

    Raises:
        FmuBuildError: it is missing, or another version is installed.
    """
    if importlib.util.find_spec("ziglang") is None:
        raise FmuBuildError(
            f"ziglang: not installed; 'pip install ziglang=={ZIG_VERSION}' to build the FMUs"
        )
    version = subprocess.run(
        [sys.executable, "-m", "ziglang", "version"], capture_output=True, text=True, check=False
    ).stdout.strip()
    if version != ZIG_VERSION:
        raise FmuBuildError(
            f"ziglang {version}: the FMUs' bytes depend on the compiler; "
            f"'pip install ziglang=={ZIG_VERSION}'"
        )


def _fmi_headers() -> Path:
    """FMPy's copy of the standard's C headers; found without importing FMPy."""
    spec = importlib.util.find_spec("fmpy")
    folder = Path(spec.origin).parent / "c-code" if spec and spec.origin else None
    if folder is None or not (folder / "fmi3Functions.h").is_file():
        raise FmuBuildError("FMI headers: not found in FMPy's folder 'c-code'; 'pip install fmpy'")
    return folder


def _zig(folder: Path, *arguments: str) -> None:
    command = [sys.executable, "-m", "ziglang", *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        reason = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr)
        raise FmuBuildError(f"zig {' '.join(arguments)}: {reason.strip()}")
