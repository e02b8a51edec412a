"""The compilation of the C sources of an FMU that has no binary for this platform.

The archive is checked as always. The compilation runs nothing of the FMU. The result is an FMU with
one more binary, which runs in a process of its own.
"""

import os
import posixpath
import re
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from fmus.archive.archive_check import (
    EXECUTABLE,
    Archive,
    extract,
    open_archive,
    read_start,
)
from fmus.archive.kinds import DESCRIPTION, ROOT
from fmus.archive.markup import Element, parse
from fmus.archive.packing import write_archive
from fmus.description.binaries import START, Platform, misfit, this_platform
from fmus.description.model import Model
from fmus.description.reading import TAGS, model_of
from fmus.errors import FmuBuildError
from fmus.sources.compiler import Compiler, find_compiler, fmi_headers
from fmus.text import printable

SOURCES: Final = "sources/"
BUILD: Final = "sources/buildDescription.xml"  # FMI 3's build description
C_SUFFIXES: Final = (".c", ".cc", ".cpp", ".cxx")
INCLUDE: Final = re.compile(rb'^[ \t]*#[ \t]*include[ \t]*"([^"\n]+)"', re.MULTILINE)
LARGEST: Final = 1 << 30  # [bytes] largest FMU that is packed again in memory
ENTRIES: Final = {"1.0": "{0}_fmi", "2.0": "fmi2Instantiate", "3.0": "fmi3Instantiate"}


@dataclass(frozen=True)
class Sources:
    """The sources of one library; all paths are within the archive.

    Attributes:
        identifier: Identifier of the model, the library's name.
        files: C and C++ files.
        includes: Folders.
        definitions: Definitions of the preprocessor, ``NAME`` or ``NAME=VALUE``.
    """

    identifier: str
    files: tuple[str, ...]
    includes: tuple[str, ...] = ()
    definitions: tuple[str, ...] = ()


def compile_fmu(path: Path, out: Path) -> list[str]:
    """Write a copy of an FMU that has a binary for this platform, compiled from its sources.

    Args:
        path: Path of the FMU.
        out: File to write; an existing file is replaced when everything has been compiled.

    Returns:
        The names of the binaries that are new or replaced.

    Raises:
        FmuError: the FMU is refused.
        FmuBuildError: the FMU has no sources, there is no compiler, or the sources do not compile.
    """
    archive = open_archive(path)
    model = model_of(archive)
    wanted = list(_sources(archive, model))
    total = sum(info.file_size for info in archive.members.values())
    if total > LARGEST:
        raise FmuBuildError(
            f"{path}: {total >> 20} MB unpacked; expected at most {LARGEST >> 20} MB to compile it"
        )
    compiler, here = find_compiler(), this_platform()
    binaries = {}
    with tempfile.TemporaryDirectory(prefix="fmu-sources-") as folder:
        extract(archive, Path(folder), lambda name: name.startswith(SOURCES))
        for sources in wanted:
            name = f"{sources.identifier}{here.suffix}"
            place = f"binaries/{here.folders(model.fmi_version)[0]}/{name}"
            binaries[place] = _compiled(archive, model, Path(folder), sources, compiler, here)
    with tempfile.TemporaryDirectory(prefix="fmu-packing-", dir=out.absolute().parent) as folder:
        made = Path(folder, out.name)
        kept = {
            name: read_start(archive, name, info.file_size)
            for name, info in archive.members.items()
            if name not in binaries
        }
        programs = {n for n, i in archive.members.items() if i.external_attr >> 16 & EXECUTABLE}
        write_archive(made, kept | binaries, programs)
        made.replace(out)
    return list(binaries)


def _compiled(
    archive: Archive,
    model: Model,
    folder: Path,
    sources: Sources,
    compiler: Compiler,
    here: Platform,
) -> bytes:
    flags = [f"-D{definition}" for definition in (*sources.definitions, *_plain_names(model))]
    for include in (*sources.includes, "sources"):
        flags += ["-I", str(folder / include)]
    flags += ["-I", str(fmi_headers())]
    try:
        library = compiler.library(folder, sources.files, tuple(flags), f"made{here.suffix}")
    except FmuBuildError as error:
        raise FmuBuildError(f"{archive.path}: {error}") from None
    fault = misfit(library[:START], here)
    if not fault and ENTRIES[model.fmi_version].format(sources.identifier).encode() not in library:
        fault = "defines none of the functions that an FMU must have"
    if fault:
        raise FmuBuildError(
            f"{archive.path}: what {compiler.name} made of its sources {fault}; expected a library "
            f"for {here}"
        )
    return library


def _plain_names(model: Model) -> Iterator[str]:
    """Yield definitions that give functions the names of a shared library.

    Sources may be meant to be linked with those of other FMUs. Their names then begin with the
    model's identifier (FMI 2.0.4, section 2.1.1), which a macro of the header adds. The result is
    expanded once more, so that a definition for each name removes the beginning.
    """
    if model.fmi_version == "1.0":
        return
    version = model.fmi_version[0]
    yield f"FMI{version}_OVERRIDE_FUNCTION_PREFIX"
    header = (fmi_headers() / f"fmi{version}Functions.h").read_text(encoding="utf-8")
    names = re.findall(rf"#\s*define\s+(fmi{version}\w+)\s+fmi{version}FullName", header)
    for identifier in {i.identifier for i in model.interfaces.values()}:
        for name in names:
            yield f"{identifier}_{name}={name}"


# ---- the files ----


def _sources(archive: Archive, model: Model) -> Iterator[Sources]:
    """Yield the sources of each library of the FMU.

    Raises:
        FmuBuildError: the FMU does not have them.
    """
    code = [n for n in archive.members if n.startswith(SOURCES) and n.endswith(C_SUFFIXES)]
    if not code:
        raise FmuBuildError(
            f"{archive.path}: no C sources in the archive; expected sources/*.c; export the FMU "
            f"with its sources, or for {this_platform()}"
        )
    described = BUILD in archive.members
    listed = _of_build_description(archive) if described else _of_description(archive, model)
    everything = tuple(name for name in code if name.count("/") == 1)
    for identifier in dict.fromkeys(i.identifier for i in model.interfaces.values()):
        sources = listed.get(identifier) or Sources(identifier, everything or tuple(code))
        yield replace(sources, files=_without_included(archive, sources.files))


def _without_included(archive: Archive, files: tuple[str, ...]) -> tuple[str, ...]:
    """Return the files that no other one includes, as Dymola's all.c includes all others."""
    included: set[str] = set()
    for name in files:
        text = read_start(archive, name, archive.members[name].file_size)
        for line in INCLUDE.findall(text):
            place = posixpath.join(posixpath.dirname(name), line.decode(errors="replace"))
            included.add(posixpath.normpath(place))
    return tuple(name for name in files if name not in included) or files


def _of_description(archive: Archive, model: Model) -> dict[str, Sources]:
    """Return the lists of FMI 2's model description, by the model's identifier."""
    kept = frozenset({*TAGS.values(), "SourceFiles", "File"})
    root = parse(archive.description, f"{archive.path}: {DESCRIPTION}", ROOT, kept)
    found = {}
    for kind in model.interfaces:
        element = root.first(TAGS[kind])
        listed = element.every("SourceFiles", "File") if element else ()
        files = [file.get("name") for file in listed]
        if files:
            identifier = model.interfaces[kind].identifier
            found[identifier] = Sources(identifier, _members(archive, files))
    return found


def _of_build_description(archive: Archive) -> dict[str, Sources]:
    """Return the lists of FMI 3's build description, by the model's identifier."""
    tags = ("BuildConfiguration", "SourceFileSet", "SourceFile", "IncludeDirectory")
    kept = frozenset({*tags, "PreprocessorDefinition"})
    data = read_start(archive, BUILD, archive.members[BUILD].file_size)
    root = parse(data, f"{archive.path}: {BUILD}", "fmiBuildDescription", kept)
    found = {}
    for configuration in root.every("BuildConfiguration"):
        files = [file.get("name") for file in configuration.every("SourceFileSet", "SourceFile")]
        includes = configuration.every("SourceFileSet", "IncludeDirectory")
        entries = configuration.every("SourceFileSet", "PreprocessorDefinition")
        identifier = configuration.get("modelIdentifier")
        if files and identifier not in found:
            found[identifier] = Sources(
                identifier,
                _members(archive, files),
                tuple(_inside(archive, place.get("name")) for place in includes),
                tuple(map(_definition, entries)),
            )
    return found


def _definition(entry: Element) -> str:
    """Return a definition of the preprocessor, ``NAME`` or ``NAME=VALUE``."""
    value = entry.attributes.get("value")
    return entry.get("name") + ("" if value is None else f"={value}")


def _members(archive: Archive, names: list[str]) -> tuple[str, ...]:
    members = tuple(dict.fromkeys(_inside(archive, name) for name in names))
    missing = [name for name in members if name not in archive.members]
    if missing:
        raise FmuBuildError(
            f"{archive.path}: {printable(missing[0], 100)}: named among its sources, but not in "
            "the archive; export the FMU again"
        )
    return tuple(name for name in members if name.endswith(C_SUFFIXES))


def _inside(archive: Archive, name: str) -> str:
    """Return a path below the archive's sources.

    Raises:
        FmuBuildError: the path leads elsewhere.
    """
    path = posixpath.normpath(posixpath.join(SOURCES, name))
    if not f"{path}/".startswith(SOURCES) or (os.sep != "/" and os.sep in name):
        raise FmuBuildError(
            f"{archive.path}: {printable(name, 100)}: named among its sources, but not below "
            "sources/; refused"
        )
    return path
