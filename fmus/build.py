"""Rebuild the shipped FMUs: ``python -m fmus.build [--out DIR]``.

The vehicle (``source/``) and the controller (``controller_fmu/source/``): two FMI versions each,
five platforms, one compiler (the pinned ``ziglang`` of the extra
``giveway[build]``), no system compiler. The same bytes come out on every machine: the compiler is
pinned, nothing of the build folder or the clock enters a binary, and the archive is stored (not
compressed, which would depend on the zlib at hand) with fixed dates in a fixed order.
"""

import argparse
import hashlib
import importlib.util
import subprocess
import sys
import tempfile
import uuid
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Final

from fmus.bundled import FILES, MODEL, FmiVersion
from fmus.controller_fmu.description import model_description
from fmus.controller_fmu.parameters import (
    CONTROLLER,
    CONTROLLER_FILES,
    ControllerParameters,
    token_of,
)
from fmus.errors import FmuBuildError
from fmus.packing import universal_library, without_timestamp, write_archive

ZIG_VERSION: Final = "0.16.0"
SOURCE: Final = Path(__file__).parent / "source"
WINDOWS_RUNTIME: Final = "windows_runtime.c"
FRONT_ENDS: Final[dict[FmiVersion, str]] = {"2.0": "fmi2.c", "3.0": "fmi3.c"}
SHARED: Final[dict[FmiVersion, tuple[str, ...]]] = {  # in SOURCE
    "2.0": ("fmi2_begin.h", "fmi2_rest.h"),
    "3.0": ("fmi3_begin.h", "fmi3_rest.h"),
}

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


@dataclass(frozen=True)
class Recipe:
    """What one of our models is made of.

    Attributes:
        model: its name, also that of the libraries.
        folder: of the sources.
        files: headers and C files but for the front end, in the order of the archive.
        archives: the .fmu file per FMI version.
        flags: more of them for the compiler.
    """

    model: str
    folder: Path
    files: tuple[str, ...]
    archives: Mapping[FmiVersion, str]
    flags: tuple[str, ...] = ()

    def read(self, name: str) -> bytes:
        """A source file, with the line ends that it has in the repository."""
        return (self.folder / name).read_bytes().replace(b"\r\n", b"\n")

    def c_files(self, version: FmiVersion) -> tuple[str, ...]:
        """In the order of compilation."""
        return (*(name for name in self.files if name.endswith(".c")), FRONT_ENDS[version])


VEHICLE: Final = Recipe(MODEL, SOURCE, ("plant.h", "plant.c", "instance.h", "instance.c"), FILES)
_UNITS: Final = (
    "parameters",
    "speed_problem",
    "active_set",
    "refinement",
    "mpc",
    "pid",
    "regulator",
    "instance",
)
REGULATOR: Final = Recipe(
    CONTROLLER,
    Path(__file__).parent / "controller_fmu" / "source",
    (*(f"{unit}.{kind}" for unit in _UNITS for kind in "hc"), "variables.c", "snapshot.c"),
    CONTROLLER_FILES,
    ("-fno-math-errno",),  # sqrt is the processor's, and no library's
)


def build(out: Path, recipes: Sequence[Recipe] = (VEHICLE,)) -> list[Path]:
    """Build the FMUs, one per FMI version, into the folder ``out`` and return their paths.

    Raises:
        FmuBuildError: the compiler or the FMI headers are missing, or a compilation fails.
    """
    _require_compiler()
    out.mkdir(parents=True, exist_ok=True)
    paths = []
    for recipe in recipes:
        for version, file in recipe.archives.items():
            path = out / file
            write_archive(path, _members(recipe, version))
            paths.append(path)
    return paths


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


def _members(recipe: Recipe, version: FmiVersion) -> dict[str, bytes]:
    """All files of one FMU, in the order of the archive."""
    sources = {name: recipe.read(name) for name in (*recipe.files, FRONT_ENDS[version])}
    sources |= {name: VEHICLE.read(name) for name in SHARED[version]}
    build_token, description = _describe(recipe, version, sources)
    sources["token.h"] = f'#define MODEL_TOKEN "{build_token}"\n'.encode()
    with tempfile.TemporaryDirectory() as folder:
        for name, data in {**sources, "windows_runtime.c": VEHICLE.read(WINDOWS_RUNTIME)}.items():
            Path(folder, name).write_bytes(data)
        c_files = recipe.c_files(version)
        libraries = {
            t: compile_library(Path(folder), c_files, t, recipe.model, recipe.flags)
            for t in TARGETS
        }
    if version == "3.0":
        sources["buildDescription.xml"] = recipe.read("buildDescription.xml")
    binaries = _LAYOUTS[version](recipe.model, libraries)
    return {
        "modelDescription.xml": description,
        "documentation/index.html": recipe.read("documentation.html"),
        **{f"binaries/{name}": data for name, data in binaries.items()},
        **{f"sources/{name}": data for name, data in sources.items()},
    }


def _describe(
    recipe: Recipe, version: FmiVersion, sources: Mapping[str, bytes]
) -> tuple[str, bytes]:
    """The token that is compiled in, and modelDescription.xml."""
    tool = f"giveway, python -m fmus.build with ziglang {ZIG_VERSION}"
    if recipe is VEHICLE:
        template = recipe.read(f"modelDescription.fmi{version[0]}.xml")
        token = _token(template, *sources.values())
        return token, Template(template.decode()).substitute(token=token, tool=tool).encode()
    token, parameters = _token(*sources.values()), ControllerParameters()
    return token, model_description(
        version,
        parameters,
        token=token_of(token, parameters),
        tool=tool,
        sources=recipe.c_files(version),
    )


def _fmi2_layout(model: str, libraries: Mapping[Target, bytes]) -> dict[str, bytes]:
    """FMI 2's own folder names; one universal library serves both kinds of Mac."""
    return {
        f"linux64/{model}.so": libraries[LINUX_X86],
        f"aarch64-linux/{model}.so": libraries[LINUX_ARM],
        f"win64/{model}.dll": libraries[WINDOWS],
        f"darwin64/{model}.dylib": universal_library(libraries[MACOS_X86], libraries[MACOS_ARM]),
    }


def _fmi3_layout(model: str, libraries: Mapping[Target, bytes]) -> dict[str, bytes]:
    return {f"{t.folder}/{model}{t.suffix}": data for t, data in libraries.items()}


_LAYOUTS: Final[dict[FmiVersion, Callable[[str, Mapping[Target, bytes]], dict[str, bytes]]]] = {
    "2.0": _fmi2_layout,
    "3.0": _fmi3_layout,
}


def _token(*contents: bytes) -> str:
    """An identifier that changes when, and only when, what the model is made of changes."""
    digest = hashlib.sha256()
    for content in contents:
        digest.update(hashlib.sha256(content).digest())
    return f"{{{uuid.uuid5(uuid.NAMESPACE_OID, digest.hexdigest())}}}"


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
        for path in build(parser.parse_args().out, (VEHICLE, REGULATOR)):
            digest = hashlib.sha256(path.read_bytes()).hexdigest()
            sys.stdout.write(f"{path}  {path.stat().st_size} bytes  sha256 {digest}\n")
    except FmuBuildError as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()
