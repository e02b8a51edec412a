"""Rebuild the shipped FMUs: ``python -m fmus.build [--out DIR]``.

One C source, two FMI versions, five platforms, one compiler (the pinned ``ziglang`` of the extra
``giveway[build]``), no system compiler. The same bytes come out on every machine: the compiler is
pinned, nothing of the build folder or the clock enters a binary, and the archive is stored (not
compressed, which would depend on the zlib at hand) with fixed dates in a fixed order.
"""

import argparse
import hashlib
import importlib.util
import struct
import subprocess
import sys
import tempfile
import uuid
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Final

from fmus.bundled import FILES, MODEL, FmiVersion
from fmus.errors import FmuBuildError

ZIG_VERSION: Final = "0.16.0"
SOURCE: Final = Path(__file__).parent / "source"
MODEL_FILES: Final = ("plant.h", "plant.c", "instance.h", "instance.c")
FRONT_ENDS: Final[dict[FmiVersion, str]] = {"2.0": "fmi2.c", "3.0": "fmi3.c"}

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
    "x86_64-windows-gnu", "x86_64-windows", ".dll", ("-nostdlib", *UCRT), ("windows_runtime.c",)
)
MACOS_X86: Final = Target("x86_64-macos.11.0", "x86_64-darwin", ".dylib")
MACOS_ARM: Final = Target("aarch64-macos.11.0", "aarch64-darwin", ".dylib")
TARGETS: Final = (LINUX_X86, LINUX_ARM, WINDOWS, MACOS_X86, MACOS_ARM)


def build(out: Path) -> list[Path]:
    """Build both FMUs into the folder ``out`` and return their paths.

    Raises:
        FmuBuildError: the compiler or the FMI headers are missing, or a compilation fails.
    """
    _require_compiler()
    out.mkdir(parents=True, exist_ok=True)
    paths = []
    for version, file in FILES.items():
        members = _members(version)
        path = out / file
        write_archive(path, members)
        paths.append(path)
    return paths


def compile_library(folder: Path, sources: tuple[str, ...], target: Target, output: str) -> bytes:
    """Compile C sources in ``folder`` for a platform and return the shared library's bytes.

    Raises:
        FmuBuildError: zig refuses; the message is the compiler's first line.
    """
    objects = []
    for source in (*sources, *target.extra_sources):
        objects.append(f"{Path(source).stem}.{target.folder}.o")
        headers = ("-I", str(_fmi_headers()))
        _zig(
            folder, "cc", "-target", target.zig, *COMPILE, *headers, "-c", source, "-o", objects[-1]
        )
    name = output + target.suffix
    link = ["-target", target.zig, "-shared", "-s", *objects, *target.link, "-o", name]
    if target.suffix == ".dylib":  # else the build's path would be the library's own name
        link.append(f"-Wl,-install_name,@rpath/{name}")
    _zig(folder, "cc", *link)
    library = (folder / name).read_bytes()
    return without_timestamp(library) if target.suffix == ".dll" else library


def write_archive(path: Path, members: Mapping[str, bytes]) -> None:
    """Write a zip archive whose bytes depend on its members only."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        for name, data in members.items():
            info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            info.create_system = 3  # Unix, wherever we are
            info.external_attr = 0o100644 << 16
            archive.writestr(info, data)


def _members(version: FmiVersion) -> dict[str, bytes]:
    """All files of one FMU, in the order of the archive."""
    front_end = FRONT_ENDS[version]
    sources = {name: _read(name) for name in (*MODEL_FILES, front_end)}
    template = _read(f"modelDescription.fmi{version[0]}.xml")
    token = _token(template, *sources.values())
    sources["token.h"] = f'#define MODEL_TOKEN "{token}"\n'.encode()
    tool = f"giveway, python -m fmus.build with ziglang {ZIG_VERSION}"
    description = Template(template.decode()).substitute(token=token, tool=tool).encode()
    with tempfile.TemporaryDirectory() as folder:
        for name, data in {**sources, "windows_runtime.c": _read("windows_runtime.c")}.items():
            Path(folder, name).write_bytes(data)
        c_files = ("plant.c", "instance.c", front_end)
        binaries = _LAYOUTS[version](
            {t: compile_library(Path(folder), c_files, t, MODEL) for t in TARGETS}
        )
    if version == "3.0":
        sources["buildDescription.xml"] = _read("buildDescription.xml")
    return {
        "modelDescription.xml": description,
        "documentation/index.html": _read("documentation.html"),
        **{f"binaries/{name}": data for name, data in binaries.items()},
        **{f"sources/{name}": data for name, data in sources.items()},
    }


def _fmi2_layout(libraries: Mapping[Target, bytes]) -> dict[str, bytes]:
    """FMI 2's own folder names; one universal library serves both kinds of Mac."""
    return {
        f"linux64/{MODEL}.so": libraries[LINUX_X86],
        f"aarch64-linux/{MODEL}.so": libraries[LINUX_ARM],
        f"win64/{MODEL}.dll": libraries[WINDOWS],
        f"darwin64/{MODEL}.dylib": universal_library(libraries[MACOS_X86], libraries[MACOS_ARM]),
    }


def _fmi3_layout(libraries: Mapping[Target, bytes]) -> dict[str, bytes]:
    return {f"{t.folder}/{MODEL}{t.suffix}": data for t, data in libraries.items()}


_LAYOUTS: Final[dict[FmiVersion, Callable[[Mapping[Target, bytes]], dict[str, bytes]]]] = {
    "2.0": _fmi2_layout,
    "3.0": _fmi3_layout,
}


def without_timestamp(library: bytes) -> bytes:
    """Clear the link time in a Windows library (TimeDateStamp of its COFF header)."""
    (header,) = struct.unpack_from("<I", library, 0x3C)
    return library[: header + 8] + bytes(4) + library[header + 12 :]


def universal_library(*slices: bytes) -> bytes:
    """Join Mach-O libraries of different processors into one (what ``lipo -create`` does).

    The format is ``struct fat_header`` and ``struct fat_arch`` of Apple's <mach-o/fat.h>, big
    endian; each slice repeats its processor's type and starts on a page of 16 KiB.
    """
    page = 1 << 14
    header = struct.pack(">II", 0xCAFEBABE, len(slices))
    body = b""
    for data in slices:
        processor, subtype = struct.unpack_from("<II", data, 4)
        offset = page + len(body)
        header += struct.pack(">IIIII", processor, subtype, offset, len(data), 14)
        body += data + bytes(-len(data) % page)
    return header.ljust(page, b"\0") + body


def _token(*contents: bytes) -> str:
    """An identifier that changes when, and only when, what the model is made of changes."""
    digest = hashlib.sha256()
    for content in contents:
        digest.update(hashlib.sha256(content).digest())
    return f"{{{uuid.uuid5(uuid.NAMESPACE_OID, digest.hexdigest())}}}"


def _read(name: str) -> bytes:
    """A file of the source folder, with the line ends that it has in the repository."""
    return (SOURCE / name).read_bytes().replace(b"\r\n", b"\n")


def _require_compiler() -> None:
    if importlib.util.find_spec("ziglang") is None:
        msg = f"ziglang: not installed; 'pip install ziglang=={ZIG_VERSION}' to build the FMUs"
        raise FmuBuildError(msg)
    version = subprocess.run(
        [sys.executable, "-m", "ziglang", "version"], capture_output=True, text=True, check=False
    ).stdout.strip()
    if version != ZIG_VERSION:
        msg = (
            f"ziglang {version}: the FMUs' bytes depend on the compiler; "
            f"'pip install ziglang=={ZIG_VERSION}'"
        )
        raise FmuBuildError(msg)


def _fmi_headers() -> Path:
    """FMPy's copy of the standard's C headers; found without importing FMPy."""
    spec = importlib.util.find_spec("fmpy")
    folder = Path(spec.origin).parent / "c-code" if spec and spec.origin else None
    if folder is None or not (folder / "fmi3Functions.h").is_file():
        msg = "FMI headers: not found in FMPy's folder 'c-code'; 'pip install fmpy'"
        raise FmuBuildError(msg)
    return folder


def _zig(folder: Path, *arguments: str) -> None:
    command = [sys.executable, "-m", "ziglang", *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        reason = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr)
        msg = f"zig {' '.join(arguments)}: {reason.strip()}"
        raise FmuBuildError(msg)


def main() -> None:
    """Build from the command line."""
    parser = argparse.ArgumentParser(prog="python -m fmus.build", description="Rebuild the FMUs.")
    parser.add_argument(
        "--out", type=Path, default=Path(__file__).parent, help="folder; default: in place"
    )
    try:
        for path in build(parser.parse_args().out):
            digest = hashlib.sha256(path.read_bytes()).hexdigest()
            sys.stdout.write(f"{path}  {path.stat().st_size} bytes  sha256 {digest}\n")
    except FmuBuildError as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()
