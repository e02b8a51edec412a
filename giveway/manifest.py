"""What a run was made of, so that anybody can make it again: versions, hashes, seeds, command."""

from __future__ import annotations

import hashlib
import platform
import xml.etree.ElementTree as ET
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any

from giveway import __version__

if TYPE_CHECKING:
    from pathlib import Path

    from giveway.config import RunConfig
    from sumo_scenarios import Scenario

_PACKAGES = ("fmpy", "libsumo", "numba", "numpy", "osqp", "pandas")


def sha256(content: bytes) -> str:
    """The hexadecimal SHA-256 of ``content``."""
    return hashlib.sha256(content).hexdigest()


def software_versions() -> dict[str, str]:
    """Versions of everything whose version can change a number."""
    versions = {"giveway": __version__, "python": platform.python_version()}
    for name in _PACKAGES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            versions[name] = "unknown"
    return versions | {"platform": platform.platform(), "machine": platform.machine()}


def scenario_hashes(scenario: Scenario) -> dict[str, str]:
    """SHA-256 of the scenario's configuration, settings and every input file that it names."""
    files = [scenario.config_file, *_inputs(scenario.config_file)]
    if scenario.settings_file is not None:
        files.append(scenario.settings_file)
    return {file.name: sha256(file.read_bytes()) for file in files if file.is_file()}


def _inputs(config_file: Path) -> list[Path]:
    root = ET.parse(config_file).getroot()
    section = root.find("input")
    values = [] if section is None else [element.get("value", "") for element in section]
    names = [name.strip() for value in values for name in value.split(",") if name.strip()]
    return [config_file.parent / name for name in names]


def manifest(
    config: RunConfig,
    scenario: Scenario,
    *,
    config_text: str,
    vehicle: dict[str, Any],
    pedestrians: dict[str, int],
    ending: str,
    error: str | None,
) -> dict[str, Any]:
    """The contents of ``manifest.json``; nothing in it depends on when the run was made."""
    return {
        "ending": ending,
        "error": error,
        "reproduce": "giveway run --config config.toml --out ANOTHER_FOLDER",
        "seed": config.seed,
        "scenario": {"name": scenario.name, "sha256": scenario_hashes(scenario)},
        "vehicle": vehicle,
        "pedestrians": pedestrians,
        "configuration_sha256": sha256(config_text.encode()),
        "software": software_versions(),
    }
