"""The search for the class that a name means, only in installed distributions.

A name is that of an entry point, or ``module:attribute``. The imported file has to belong to an
installed distribution: by its RECORD, or, if installed for development (``pip install -e``), below
the project's folder. A file that merely lies in the working folder is never imported.
"""

import contextlib
import functools
import hashlib
import importlib
import importlib.util
import json
import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit
from urllib.request import url2pathname

from giveway.errors import ControlError
from giveway.plug_ins.options import read_options
from giveway.plug_ins.sockets import CONTROLLER, Socket

_REFERENCE = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*:[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")

OURS = "giveway"
"""The distribution whose code is giveway's own."""


@dataclass(frozen=True)
class Found:
    """A plug-in and its distribution, as in manifests.

    Attributes:
        socket: Socket for which it is used.
        name: Name as the user wrote it.
        reference: ``module:attribute``.
        distribution: Name of the installed distribution that has it.
        version: Version of the distribution.
        sha256: SHA-256 of all files of its package.
    """

    socket: Socket
    name: str
    reference: str
    distribution: str
    version: str
    sha256: str

    def described(self) -> dict[str, Any]:
        """Return the entries for the manifest."""
        return {key: value for key, value in asdict(self).items() if key != "socket"}


def is_reference(name: str) -> bool:
    """Return whether a name is ``module:attribute`` and not that of an entry point."""
    return _REFERENCE.fullmatch(name) is not None


def is_fmu(name: str) -> bool:
    """Return whether a name is that of a file with an FMU."""
    return name.lower().endswith(".fmu")


def same_name(name: Any) -> Any:
    """Return a name for comparison; a file's name may be written in several ways."""
    return os.path.abspath(name) if isinstance(name, str) and is_fmu(name) else name  # noqa: PTH100


def shown(name: str) -> str:
    """Return a name without the folder of a file."""
    return Path(name).name if is_fmu(name) else name


def declared_names(socket: Socket = CONTROLLER) -> list[str]:
    """Return the names that installed distributions declare for a socket."""
    return sorted({point.name for point in metadata.entry_points(group=socket.group)})


def find(name: str, socket: Socket = CONTROLLER) -> Found:
    """Return the plug-in that a name means, without importing it.

    Raises:
        ControlError: no installed distribution has it.
    """
    reference = name if is_reference(name) else _declared(name, socket)
    module = reference.partition(":")[0]
    owner, files = _owner(f"{socket.setting} = '{name}'", module.partition(".")[0])
    return Found(socket, name, reference, owner.metadata["Name"], owner.version, _digest(files))


def load(found: Found) -> Any:
    """Import a plug-in that was found.

    Raises:
        ControlError: the plug-in cannot be imported.
    """
    module, _, attribute = found.reference.partition(":")
    try:
        with _without_working_folder():
            value: Any = importlib.import_module(module)
        for part in attribute.split("."):
            value = getattr(value, part)
    except (Exception, SystemExit) as error:
        said = " ".join(str(error).split())
        raise ControlError(
            f"{found.socket.setting} = '{found.name}': {found.reference} of {found.distribution} "
            f"{found.version} cannot be imported ({type(error).__name__}: {said}); repair or "
            "reinstall that package"
        ) from error
    return value


def load_class(name: str, socket: Socket, settings: Mapping[str, Any]) -> tuple[Any, Any]:
    """Return the class that a name means, and its options, or None if it has no options.

    Args:
        name: Name of the plug-in.
        socket: Socket for which it is used.
        settings: Options as the user has set them.

    Raises:
        ConfigError: the options cannot be used.
        ControlError: the plug-in is not installed, cannot be imported, or is no class.
    """
    kind = load(find(name, socket))
    if not callable(kind):
        raise ControlError(
            f"{socket.setting} = '{name}': {kind!r} is not a class; expected one with a method "
            f"{socket.method} (docs/plugins.md)"
        )
    return kind, read_options(name, getattr(kind, "Options", None), settings, socket)


def maker_of(make: Any, options: Any) -> Callable[[Any], object]:
    """Return the function that makes a plug-in for a setup, its options filled in.

    Args:
        make: Class of the plug-in, or another factory.
        options: Instance of its ``Options``, or None if it has none.
    """
    return lambda setup: make(setup) if options is None else make(setup, options)


def load_maker(name: str, socket: Socket, settings: Mapping[str, Any]) -> Callable[[Any], object]:
    """Return the function that makes the plug-in of a name, as :func:`load_class` finds it.

    Args:
        name: Name of the plug-in.
        socket: Socket that it is for.
        settings: Settings of its options, as the user has set them.

    Raises:
        ConfigError: its options cannot be used.
        ControlError: it is not installed, cannot be imported, or is no class.
    """
    return maker_of(*load_class(name, socket, settings))


def _declared(name: str, socket: Socket) -> str:
    """Return the ``module:attribute`` of an entry point."""
    group = socket.group
    values = {point.value for point in metadata.entry_points(group=group, name=name)}
    if len(values) == 1:
        return values.pop().partition("[")[0].strip()
    if values:
        both = " and ".join(sorted(values))
        raise ControlError(
            f"{socket.setting} = '{name}': {both} both have this name; choose one as module:Class"
        )
    known = ", ".join(declared_names(socket)) or "none"
    raise ControlError(
        f"{socket.setting} = '{name}': no installed package declares it (entry points {group}: "
        f"{known})"
    )


def _owner(setting: str, package: str) -> tuple[metadata.Distribution, list[Path]]:
    """Return the distribution of a top-level package or module, and the package's files."""
    with _without_working_folder():
        try:
            spec = importlib.util.find_spec(package)
        except (ImportError, ValueError):
            spec = None
    origins = [] if spec is None else _places(spec.origin, spec.submodule_search_locations)
    for origin in origins:
        for distribution in metadata.distributions():
            if _has(distribution, origin):
                return distribution, _files(origins)
    place = f"; {origins[0]} is not installed" if origins else ""
    raise ControlError(
        f"{setting}: no installed package has the module '{package}'{place}; code "
        "from other places is not imported, install it with: pip install FOLDER (or -e FOLDER)"
    )


def _places(origin: str | None, folders: Any) -> list[Path]:
    """Return the file, or the folders of a package without one, that a module is imported from."""
    if origin is not None and os.path.isfile(origin):  # noqa: PTH113 - "built-in" is a name, too
        return [Path(origin).absolute()]
    return [Path(folder).absolute() for folder in folders or ()]


def _has(distribution: metadata.Distribution, place: Path) -> bool:
    """Return whether a file or folder belongs to a distribution or to its project's folder."""
    root = Path(str(distribution.locate_file(""))).absolute()
    record = distribution.read_text("RECORD")
    if record is not None and place.is_relative_to(root):
        inside = place.relative_to(root).as_posix()
        starts = f"{inside}/" if place.is_dir() else f"{inside},"
        if any(line.removeprefix('"').startswith(starts) for line in record.splitlines()):
            return True
    project = _project(distribution)
    return project is not None and place.resolve().is_relative_to(project)


def _project(distribution: metadata.Distribution) -> Path | None:
    """Return the folder of a distribution installed for development, or None."""
    with contextlib.suppress(ValueError, TypeError, AttributeError):
        direct = json.loads(distribution.read_text("direct_url.json") or "{}")
        if direct.get("dir_info", {}).get("editable"):
            return Path(url2pathname(unquote(urlsplit(direct["url"]).path))).resolve()
    return None


def _files(origins: list[Path]) -> list[Path]:
    """Return all files of a package, or the one of a module."""
    folders = [place.parent if place.name == "__init__.py" else place for place in origins]
    found: list[Path] = []
    for place in folders:
        found += [place] if place.is_file() else sorted(place.rglob("*"))
    return [file for file in found if file.is_file() and "__pycache__" not in file.parts]


def _digest(files: list[Path]) -> str:
    """Return the SHA-256 of names and contents; files are read again only after a change."""
    stamps = tuple((str(f), f.stat().st_mtime_ns, f.stat().st_size) for f in files)
    return _digest_of(stamps)


@functools.lru_cache(maxsize=64)
def _digest_of(stamps: tuple[tuple[str, int, int], ...]) -> str:
    digest = hashlib.sha256()
    top = os.path.commonpath([file for file, *_ in stamps]) if len(stamps) > 1 else ""
    for file, *_ in stamps:
        name = os.path.relpath(file, top) if top else os.path.basename(file)  # noqa: PTH119
        content = Path(file).read_bytes()
        digest.update(f"{Path(name).as_posix()} {len(content)} ".encode() + content)
    return digest.hexdigest()


@contextlib.contextmanager
def _without_working_folder() -> Iterator[None]:
    """Import in this context as with Python's ``-P``: not from the working folder."""
    kept = sys.path[:]
    if not sys.flags.safe_path and sys.path and sys.path[0] in {"", str(Path.cwd())}:
        del sys.path[0]
    try:
        yield
    finally:
        sys.path[:] = kept
