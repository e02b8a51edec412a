"""The parameter sets by name: two published ones, and those that were fitted to recorded people.

``MIXED``, ``CITR`` and ``DUT`` are files of ``giveway calibrate``, with what they were fitted to.
"""

import tomllib
from collections.abc import Mapping
from importlib import resources
from types import MappingProxyType
from typing import Any

from pedestrian_model.parameters import SIM, TABLE2, VciParameters

_FITTED = ("MIXED", "CITR", "DUT")


def _file(name: str) -> dict[str, Any]:
    file = resources.files("pedestrian_model.presets") / f"{name.lower()}.toml"
    return tomllib.loads(file.read_text(encoding="utf-8"))


#: The presets by name.
PRESETS: Mapping[str, VciParameters] = MappingProxyType(
    {"SIM": SIM, "TABLE2": TABLE2}
    | {name: VciParameters(**_file(name)["parameters"]) for name in _FITTED}
)


def provenance_of(name: str) -> dict[str, Any]:
    """Return what a fitted preset says of its making: data, seed, quality; empty for others.

    Args:
        name: Name of a preset.
    """
    return dict(_file(name)["provenance"]) if name in _FITTED else {}
