"""The rules for importing code that only a results folder names.

The results of other people are data. A name that an installed package declares may be imported if
this package made the results. ``module:Class`` could name any installed code. It is imported only
if the user has named it, too.
"""

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from giveway.config.files.foreign_code import Named, foreign_code
from giveway.config.files.layers import Layer
from giveway.config.run_config import RunConfig
from giveway.errors import ConfigError
from giveway.gate import read_json
from giveway.plug_ins.finding import find, is_fmu, is_reference, same_name, shown
from giveway.plug_ins.sockets import Socket


def require_trusted(
    config: RunConfig, layers: Sequence[Layer], trusted: Collection[str] = ()
) -> None:
    """Make sure that no results folder alone decides which code is imported.

    Args:
        config: Configuration that the layers amount to.
        layers: Layers of settings.
        trusted: Code that the user has named, apart from the layers.

    Raises:
        ConfigError: a folder alone names code, or names code that has changed since.
        ControlError: a plug-in is not installed.
    """
    for code in sorted(foreign_code(config), key=lambda code: code.key):
        socket, name = code.socket, same_name(code.name)
        naming = [layer for layer in layers if name in _named_in(layer.values, socket)]
        said = name in {same_name(one) for one in trusted}
        said |= any(layer.results is None for layer in naming)
        told = [(layer.origin, layer.results) for layer in naming if layer.results is not None]
        if not told or (said and not is_fmu(name)):
            continue
        origin, folder = told[0]
        if not said and (is_reference(name) or is_fmu(name)):
            raise ConfigError(
                f"{origin}: {socket.setting} = '{name}': a results folder names code, which is "
                f"imported only if you say so: run it with {socket.flag} {name}, rerun and report "
                f"a study with --trust {name}"
            )
        _require_same(code, origin, folder)


def _require_same(code: Named, origin: str, folder: Path) -> None:
    socket, name = code.socket, code.name
    now = code.sha256
    for known in hashes_in(folder, name, socket):
        if known != now and is_fmu(name):
            raise ConfigError(
                f"{origin}: {socket.setting} = '{name}': the results were made with another "
                f"content of this file (SHA-256 {known[:12]}, now {now[:12]}); put that one back, "
                "or give the new one a name of its own"
            )
        if known != now:
            found = find(name, socket)
            raise ConfigError(
                f"{origin}: {socket.setting} = '{name}': the results were made with another "
                f"content of {found.distribution} (SHA-256 {known[:12]}, installed is "
                f"{found.version}, {now[:12]}); install that one, or name it yourself "
                f"with {socket.flag} {name} (of studies --trust {name})"
            )


def hashes_in(folder: Path, name: str, socket: Socket) -> set[str]:
    """Return the SHA-256 of a plug-in in the manifest of a results folder; empty if it has none."""
    try:
        manifest = read_json(folder / "manifest.json")
        told = manifest.get(socket.manifest, {}).values()  # manifest of a run
        inputs = [cell["inputs"] for cell in manifest.get("cells", ())]  # manifest of a study
        return {str(one["sha256"]) for one in told if same_name(one["name"]) == same_name(name)} | {
            str(hash_)
            for files in inputs
            for key, hash_ in files.items()
            if key.startswith(f"{socket.what} of ") and key.endswith(f": {shown(name)}")
        }
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return set()


def _named_in(values: Mapping[str, Any], socket: Socket) -> set[str]:
    """Return the plug-ins that settings name, for the run and for its egos."""
    egos = values.get("egos")
    named = set()
    for node in (values, *(egos if isinstance(egos, list | tuple) else ())):
        for key in socket.location:
            node = node.get(key) if isinstance(node, Mapping) else None
        if isinstance(node, str):
            named.add(same_name(node))
        elif isinstance(node, Mapping):  # a table of names
            named |= {name for name, own in node.items() if own}
    return named
