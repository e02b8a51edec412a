"""Code that a results folder names: what is imported without the user's own word, and what is not.

Somebody else's results are data. A name that an installed package declares may be followed, if the
package is the one that the results were made with; ``module:Class`` could be anything installed,
and is imported only if the user has named it too.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from giveway.config.layers import Layer
from giveway.config.run_config import RunConfig
from giveway.errors import ConfigError
from giveway.plug_ins.finding import find, is_reference

CONTROLLER_OF = "controller of "
"""How the input of a study's cell begins that is a controller; ego and name follow."""


def require_trusted(
    config: RunConfig, layers: Sequence[Layer], trusted: Collection[str] = ()
) -> None:
    """Make sure that no results folder alone decides on what is imported.

    Args:
        config: what the layers amount to.
        layers: of settings.
        trusted: controllers that the user has named apart from the layers.

    Raises:
        ConfigError: one does, or names a controller that has changed since.
        ControlError: a controller is not installed.
    """
    plugged_in = {ego.controller for ego in config.each_ego() if ego.plugged_in}
    own = {name for layer in layers if layer.results is None for name in _named_in(layer.values)}
    for name in sorted(plugged_in - own - set(trusted)):
        origin, folder = next(
            (layer.origin, layer.results)
            for layer in layers
            if layer.results is not None and name in _named_in(layer.values)
        )
        if is_reference(name):
            raise ConfigError(
                f"{origin}: controller = '{name}': a results folder names code, which is imported "
                f"only if you say so: run it with --controller {name}, rerun and report a study "
                f"with --trust {name}"
            )
        _require_same(name, origin, folder)


def _require_same(name: str, origin: str, folder: Path) -> None:
    found = find(name)
    for known in hashes_in(folder, name):
        if known != found.sha256:
            raise ConfigError(
                f"{origin}: controller = '{name}': the results were made with another content of "
                f"{found.distribution} (SHA-256 {known[:12]}, installed is {found.version}, "
                f"{found.sha256[:12]}); install that one, or name it yourself with "
                f"--controller {name} (of studies --trust {name})"
            )


def hashes_in(folder: Path, name: str) -> set[str]:
    """The SHA-256 of a controller that the manifest of a results folder tells; perhaps none."""
    try:
        manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
        told = manifest.get("controllers", {})  # of a run
        inputs = [cell["inputs"] for cell in manifest.get("cells", ())]  # of a study
        return {str(one["sha256"]) for one in told.values() if one["name"] == name} | {
            str(hash_)
            for files in inputs
            for key, hash_ in files.items()
            if key.startswith(CONTROLLER_OF) and key.endswith(f": {name}")
        }
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return set()


def _named_in(values: Mapping[str, Any]) -> set[str]:
    """The controllers that settings name, of the run and of its egos."""
    egos = values.get("egos")
    tables = [values, *(egos if isinstance(egos, list | tuple) else ())]
    named = [table.get("controller") for table in tables if isinstance(table, Mapping)]
    return {name for name in named if isinstance(name, str)}
