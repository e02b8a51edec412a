"""The four shipped .fmu files, built from the C sources in ``vehicle/`` and ``controller/``.

Each model has two FMI versions, for five platforms. The bytes are the same on every machine: the
compiler is pinned, neither the build folder nor the clock affects a binary, and the archive is
stored (compression would depend on the zlib version) with fixed dates in a fixed order.
"""

import hashlib
import tempfile
import uuid
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Final

from fmus.archive.packing import universal_library, write_archive
from fmus.profile.bundled import FILES, MODEL, FmiVersion
from fmus.sources.compiler import (
    LINUX_ARM,
    LINUX_X86,
    MACOS_ARM,
    MACOS_X86,
    TARGETS,
    WINDOWS,
    WINDOWS_RUNTIME,
    ZIG_VERSION,
    Target,
    compile_library,
    require_compiler,
)
from fmus.sources.controller_description import model_description
from fmus.sources.parameters import (
    CONTROLLER,
    CONTROLLER_FILES,
    ControllerParameters,
    token_of,
)

SOURCE: Final = Path(__file__).parent / "vehicle"
FRONT_ENDS: Final[dict[FmiVersion, str]] = {"2.0": "fmi2.c", "3.0": "fmi3.c"}
SHARED: Final[dict[FmiVersion, tuple[str, ...]]] = {  # shared files, in SOURCE
    "2.0": ("fmi2_begin.h", "fmi2_rest.h"),
    "3.0": ("fmi3_begin.h", "fmi3_rest.h"),
}


@dataclass(frozen=True)
class Recipe:
    """The files from which one of the shipped models is built.

    Attributes:
        model: Name of the model, also of the libraries.
        folder: Folder of the sources.
        files: Headers and C files except the front end, in the order of the archive.
        archives: The .fmu file per FMI version.
        flags: Further flags for the compiler.
    """

    model: str
    folder: Path
    files: tuple[str, ...]
    archives: Mapping[FmiVersion, str]
    flags: tuple[str, ...] = ()

    def read(self, name: str) -> bytes:
        """Return a source file, with the line ends of the repository."""
        return (self.folder / name).read_bytes().replace(b"\r\n", b"\n")

    def c_files(self, version: FmiVersion) -> tuple[str, ...]:
        """Return the C files in the order of compilation."""
        return (*(name for name in self.files if name.endswith(".c")), FRONT_ENDS[version])


VEHICLE_RECIPE: Final = Recipe(
    MODEL, SOURCE, ("plant.h", "plant.c", "instance.h", "instance.c"), FILES
)
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
CONTROLLER_RECIPE: Final = Recipe(
    CONTROLLER,
    Path(__file__).parent / "controller",
    (*(f"{unit}.{kind}" for unit in _UNITS for kind in "hc"), "variables.c", "snapshot.c"),
    CONTROLLER_FILES,
    ("-fno-math-errno",),  # sqrt is the processor's, and no library's
)


def build(out: Path, recipes: Sequence[Recipe] = (VEHICLE_RECIPE,)) -> list[Path]:
    """Build the FMUs, one per FMI version, into the folder ``out`` and return their paths.

    Raises:
        FmuBuildError: the compiler or the FMI headers are missing, or a compilation fails.
    """
    require_compiler()
    out.mkdir(parents=True, exist_ok=True)
    paths = []
    for recipe in recipes:
        for version, file in recipe.archives.items():
            path = out / file
            write_archive(path, _members(recipe, version))
            paths.append(path)
    return paths


def _members(recipe: Recipe, version: FmiVersion) -> dict[str, bytes]:
    """Return all files of one FMU, in the order of the archive."""
    sources = {name: recipe.read(name) for name in (*recipe.files, FRONT_ENDS[version])}
    sources |= {name: VEHICLE_RECIPE.read(name) for name in SHARED[version]}
    build_token, description = _describe(recipe, version, sources)
    sources["token.h"] = f'#define MODEL_TOKEN "{build_token}"\n'.encode()
    with tempfile.TemporaryDirectory() as folder:
        for name, data in {
            **sources,
            "windows_runtime.c": VEHICLE_RECIPE.read(WINDOWS_RUNTIME),
        }.items():
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
    """Return the token that is compiled in, and modelDescription.xml."""
    tool = f"giveway, python -m fmus.build with ziglang {ZIG_VERSION}"
    if recipe is VEHICLE_RECIPE:
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
    """Return files under FMI 2's folder names; one universal library serves both Macs."""
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
    """Return an identifier that changes exactly when the model's sources change."""
    digest = hashlib.sha256()
    for content in contents:
        digest.update(hashlib.sha256(content).digest())
    return f"{{{uuid.uuid5(uuid.NAMESPACE_OID, digest.hexdigest())}}}"
