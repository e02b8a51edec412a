"""One pinned cross-compiler for all platforms: the ``ziglang`` of the extra ``giveway[build]``.

The shipped FMUs need exactly this compiler; for FMUs of other origin, any C compiler will do.
"""

import importlib.util
import os
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from fmus.archive.packing import without_timestamp
from fmus.description.binaries import this_platform
from fmus.errors import FmuBuildError
from fmus.text import printable

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
    """A platform: its name in zig, its folder in FMI 3, and how a library is linked."""

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
        options = (*COMPILE, *flags, "-I", str(fmi_headers()))
        _zig(folder, "cc", "-target", target.zig, *options, "-c", source, "-o", objects[-1])
    name = output + target.suffix
    link = ["-target", target.zig, "-shared", "-s", *objects, *target.link, "-o", name]
    if target.suffix == ".dylib":  # otherwise the build's path would be the library's own name
        link.append(f"-Wl,-install_name,@rpath/{name}")
    _zig(folder, "cc", *link)
    library = (folder / name).read_bytes()
    return without_timestamp(library) if target.suffix == ".dll" else library


def require_compiler() -> None:
    """Make sure that the compiler is there on which the FMUs' bytes depend.

    Raises:
        FmuBuildError: the compiler is missing, or another version is installed.
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


def fmi_headers() -> Path:
    """Return the folder of FMPy's copy of the standard's C headers, without importing FMPy."""
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


# ---- any compiler, for FMUs of other origin ----

OLD_C: Final = (  # faults of old C that recent compilers no longer take for warnings
    "implicit-function-declaration", "implicit-int", "int-conversion",
    "incompatible-pointer-types", "incompatible-function-pointer-types",
)  # fmt: skip
FOREIGN: Final = (
    *("-O2", "-g0", "-fPIC", "-w", "-ffp-contract=off"),
    *(f"-Wno-error={fault}" for fault in OLD_C),
)
LONGEST: Final = 600.0  # [s] longest compilation of one file


@dataclass(frozen=True)
class Compiler:
    """A C and C++ compiler for this machine.

    Attributes:
        name: Name for messages.
        c: The command for C.
        cpp: The command for C++.
    """

    name: str
    c: tuple[str, ...]
    cpp: tuple[str, ...]

    def library(
        self, folder: Path, sources: tuple[str, ...], flags: tuple[str, ...], output: str
    ) -> bytes:
        """Compile C and C++ sources in ``folder`` and return the shared library's bytes.

        Raises:
            FmuBuildError: the compiler refuses; the message has its first error.
        """
        objects, linker = [], self.c
        for number, source in enumerate(sources):
            command = self.c if source.endswith(".c") else self.cpp
            linker = self.cpp if command is self.cpp else linker
            standard = ("-std=gnu11",) if source.endswith(".c") else ()
            objects.append(f"source{number}.o")
            self._run(
                folder, *command, *FOREIGN, *standard, *flags, "-c", source, "-o", objects[-1]
            )
        libraries = () if sys.platform == "win32" else ("-lm", "-lpthread")
        self._run(folder, *linker, "-shared", *objects, "-o", output, *libraries)
        return (folder / output).read_bytes()

    def _run(self, folder: Path, *command: str) -> None:
        try:
            done = subprocess.run(
                command, cwd=folder, capture_output=True, text=True, errors="replace",
                timeout=LONGEST, check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            raise FmuBuildError(f"{self.name}: no answer within {LONGEST:g} s") from None
        except OSError as error:
            reason = error.strerror or "cannot be started"
            raise FmuBuildError(f"{self.name}: {reason}; see the variable CC") from None
        if done.returncode != 0:
            lines = done.stderr.splitlines() or ["without a message"]
            reason = next((line for line in lines if "error" in line), lines[0])
            raise FmuBuildError(
                f"its sources do not compile with {self.name}: {printable(reason, 300)}; "
                "the variable CC names another compiler"
            )


def find_compiler() -> Compiler:
    """Return the compiler named by CC, else ziglang, else the system's.

    Raises:
        FmuBuildError: there is no compiler.
    """
    named = shlex.split(os.environ.get("CC", ""))
    if named:
        plus = shlex.split(os.environ.get("CXX", "")) or named
        return Compiler(named[0], tuple(named), tuple(plus))
    if importlib.util.find_spec("ziglang") is not None:
        zig = (sys.executable, "-m", "ziglang")
        known = [target.zig for target in TARGETS if target.folder == str(this_platform())]
        options = ("-target", *known, "-mcpu=baseline") if known else ()
        return Compiler("ziglang", (*zig, "cc", *options), (*zig, "c++", *options))
    for c, plus_plus in (("cc", "c++"), ("gcc", "g++"), ("clang", "clang++")):
        found = shutil.which(c)
        if found:
            return Compiler(c, (found,), (shutil.which(plus_plus) or found,))
    raise FmuBuildError(
        "no C compiler here: 'pip install ziglang', or install one and name it in the variable CC"
    )
