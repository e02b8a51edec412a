"""The rules for running code that only a results folder names.

The results of other people are data. The code that they name runs only if the user names it, too,
and if its content is the one that the folder records. Results are the user's own if the user's key
has signed them. What these name runs as long as its content is the same. ``module:Class`` could
name any installed code, and has to be named by the user even then.
"""

import os
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from fmus import is_bundled
from giveway.config.files.foreign_code import Named, foreign_code
from giveway.config.files.layers import Layer
from giveway.config.run_config import RunConfig
from giveway.config.tables.basics import BUNDLED_VEHICLES
from giveway.errors import ConfigError
from giveway.gate import (
    MANIFEST,
    RefusedFileError,
    definition_name,
    fingerprint_of,
    is_own,
    read_json,
)
from giveway.plug_ins.finding import OURS, find, is_fmu, is_reference, same_name, shown
from giveway.plug_ins.sockets import VEHICLE, Socket


def require_trusted(
    config: RunConfig, layers: Sequence[Layer], trusted: Collection[str] = ()
) -> None:
    """Make sure that no results folder alone decides which code runs.

    Args:
        config: Configuration that the layers amount to.
        layers: Layers of settings.
        trusted: Code that the user has named, apart from the layers.

    Raises:
        ConfigError: a folder alone names code, or names code that has changed since.
        ControlError: a plug-in is not installed.
    """
    words = {_name(one) for one in trusted} | set(trusted)
    for code in sorted(code_of(config), key=lambda code: code.key):
        socket, name = code.socket, _name(code.name)
        naming = [layer for layer in layers if name in _named_in(layer.values, socket)]
        told = [(layer.origin, layer.results) for layer in naming if layer.results is not None]
        by_user = any(layer.results is None for layer in naming)
        if not told or (by_user and (socket is VEHICLE or not is_fmu(name))) or _is_ours(code):
            continue
        origin, folder = told[0]
        own = is_own_folder(folder)
        said = by_user or name in words or Path(name).name in words
        if not said and not (own and (socket is VEHICLE or _is_declared(name))):
            whose = "a results folder" if own else "somebody else's results folder"
            raise ConfigError(
                f"{origin}: {socket.setting} = '{code.name}': {whose} names code, which runs only "
                f"if you say so: with {socket.flag} {code.name} (rerun, report and replay with "
                f"--trust {code.name})"
            )
        _require_same(code, origin, folder, own=own)
    _require_no_options(config, layers)


def _require_no_options(config: RunConfig, layers: Sequence[Layer]) -> None:
    """Make sure that somebody else's results pass no options to SUMO, which may write any file.

    Raises:
        ConfigError: they do.
    """
    naming = [layer for layer in layers if layer.holds(("sumo", "options"))]
    folder = naming[-1].results if naming and config.sumo.options else None
    if folder is not None and not is_own_folder(folder):
        raise ConfigError(
            f"{naming[-1].origin}: [sumo] options = '{config.sumo.options}': somebody else's "
            "results folder passes options to SUMO, which may write files; copy the file, read "
            "it, and run the copy"
        )


def code_of(config: RunConfig) -> list[Named]:
    """Return all code of a run that is not giveway's: plug-ins, controller and vehicle FMUs."""
    return foreign_code(config) + [
        Named(VEHICLE, ego.ego_id, fmu, {})
        for ego in config.each_ego()
        if (fmu := ego.vehicle.fmu) not in BUNDLED_VEHICLES
        and os.path.isfile(fmu)  # noqa: PTH113 - the name may be too long for Path
        and not is_bundled(Path(fmu))
    ]


def is_own_folder(folder: Path) -> bool:
    """Return whether this user made the results in a folder, with the settings that are there."""
    try:
        manifest = read_json(folder / MANIFEST)
        if "definition" in manifest:  # of a study
            file, known = definition_name(manifest), manifest["definition"]
        else:
            file, known = "config.toml", manifest["seal"]["files"]["config.toml"]
        return is_own(manifest) and fingerprint_of(folder / file) == known
    except (OSError, RefusedFileError, LookupError, TypeError):
        return False


def _require_same(code: Named, origin: str, folder: Path, *, own: bool) -> None:
    """Make sure that code has the content that a folder records.

    Raises:
        ConfigError: it has another one, or somebody else's folder records none.
    """
    socket, name = code.socket, code.name
    known = hashes_in(folder, code)
    if not known and not own:
        raise ConfigError(
            f"{origin}: {socket.setting} = '{name}': {MANIFEST} beside it has no hash of this "
            f"code; name it yourself with {socket.flag} {name}"
        )
    now = code.sha256
    if known <= {now}:
        return
    before = min(known - {now})[:12]
    if socket is VEHICLE or is_fmu(name):
        raise ConfigError(
            f"{origin}: {socket.setting} = '{name}': the results were made with another "
            f"content of this file (SHA-256 {before}, now {now[:12]}); put that one back, "
            "or give the new one a name of its own"
        )
    found = find(name, socket)
    raise ConfigError(
        f"{origin}: {socket.setting} = '{name}': the results were made with another "
        f"content of {found.distribution} (SHA-256 {before}, installed is "
        f"{found.version}, {now[:12]}); install that one, or name it yourself "
        f"with {socket.flag} {name} (of studies --trust {name})"
    )


def hashes_in(folder: Path, code: Named) -> set[str]:
    """Return the SHA-256 of code in the manifest of a results folder; empty if it has none."""
    socket, name = code.socket, code.name
    ending = f": {Path(name).name if socket is VEHICLE else shown(name)}"
    try:
        manifest = read_json(folder / MANIFEST)
        told = manifest.get(socket.manifest, {})  # manifest of a run
        if socket is VEHICLE:
            told = [told[code.whose]] if code.whose in told else []
        else:
            told = [one for one in told.values() if same_name(one["name"]) == same_name(name)]
        inputs = [cell["inputs"] for cell in manifest.get("cells", ())]  # manifest of a study
        inputs.append(manifest.get("inputs", {}))
        return {str(one["sha256"]) for one in told} | {
            str(hash_)
            for files in inputs
            for key, hash_ in files.items()
            if key.startswith(f"{socket.what} of ") and key.endswith(ending)
        }
    except (OSError, RefusedFileError, ValueError, KeyError, TypeError, AttributeError):
        return set()


def _is_ours(code: Named) -> bool:
    """Return whether giveway itself declares the code by this name."""
    if code.socket is VEHICLE or not _is_declared(code.name):
        return False
    return find(code.name, code.socket).distribution == OURS


def _is_declared(name: str) -> bool:
    """Return whether a name is that of an entry point, and neither a file nor a class."""
    return not (is_reference(name) or is_fmu(name))


def _name(name: Any) -> Any:
    """Return a name for comparison; a file's name may be written in several ways."""
    is_file = isinstance(name, str) and name.lower().endswith((".fmu", ".ssp"))
    return os.path.abspath(name) if is_file else name  # noqa: PTH100


def _named_in(values: Mapping[str, Any], socket: Socket) -> set[str]:
    """Return the plug-ins that settings name, for the run and for its egos."""
    egos = values.get("egos")
    named = set()
    for node in (values, *(egos if isinstance(egos, list | tuple) else ())):
        for key in socket.location:
            node = node.get(key) if isinstance(node, Mapping) else None
        if isinstance(node, str):
            named.add(_name(node))
        elif isinstance(node, Mapping):  # a table of names
            named |= {name for name, own in node.items() if own}
    return named
