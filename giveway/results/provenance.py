"""The provenance of a run, with which it can be repeated: versions, hashes, seeds, command."""

import functools
import hashlib
import os
import platform
from collections.abc import Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from giveway._version import __version__
from giveway.config import RunConfig
from giveway.scenario_files import read_scenario, with_included
from sumo_scenarios import Scenario

CONFIGURATION: Final = "configuration_sha256"
_PACKAGES = ("fmpy", "jupedsim", "libsumo", "numba", "numpy", "osqp", "pandas", "shapely")


def sha256(content: bytes) -> str:
    """Return the hexadecimal SHA-256 of ``content``."""
    return hashlib.sha256(content).hexdigest()


@functools.cache
def software_versions() -> Mapping[str, str]:
    """Return the versions of all software that can change a number."""
    versions = {"giveway": __version__, "python": platform.python_version()}
    for name in _PACKAGES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            versions[name] = "unknown"
    versions |= {"platform": platform.platform(), "machine": platform.machine()}
    return MappingProxyType(versions)


def scenario_inputs(scenario: Scenario) -> dict[str, Path]:
    """Return the scenario's configuration, settings and input files, by path from its folder.

    Files that input files include are among them.
    """
    inputs = [path for _, path in read_scenario(scenario.config_file).inputs]
    files = [scenario.config_file, *with_included(path for path in inputs if path.is_file())]
    if scenario.settings_file is not None:
        files.append(scenario.settings_file)
    folder = scenario.config_file.parent
    return {_seen_from(folder, file): file for file in files if file.is_file()}


def scenario_hashes(scenario: Scenario) -> dict[str, str]:
    """Return the SHA-256 of each of the :func:`scenario_inputs`."""
    inputs = scenario_inputs(scenario)
    return {name: sha256(file.read_bytes()) for name, file in inputs.items()}


def _seen_from(folder: Path, file: Path) -> str:
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # the file is on another drive
        return file.name


def manifest(
    config: RunConfig,
    scenario: Scenario,
    *,
    config_text: str | None,
    vehicles: dict[str, dict[str, Any]],
    pedestrians: dict[str, int],
    traffic: dict[str, float],
    sumo: dict[str, float],
    time_step: float | None,
    remarks: Sequence[str],
    ending: str,
    error: str | None,
    code: Mapping[str, Mapping[str, Any]] = MappingProxyType({}),
) -> dict[str, Any]:
    """Return the contents of ``manifest.json``, which do not depend on when the run was made.

    Args:
        config: Configuration of the run.
        scenario: Scenario of the run.
        config_text: Configuration as it is written, or None if its hash is filled in later.
        vehicles: FMU of each ego.
        pedestrians: Ledger of the pedestrians that giveway moved.
        traffic: Counts of the yield layer.
        sumo: Seed and step length in effect.
        time_step: Time step of the co-simulation [s], or None if the process died before it was
            known.
        remarks: Remarks for the user.
        ending: Reason why the run ended.
        error: Error that ended the run, or None.
        code: Provenance of plug-ins from other packages, under the keys of their sockets.
    """
    return {
        "ending": ending,
        "error": error,
        "remarks": list(remarks),
        "reproduce": "giveway run --config config.toml --out ANOTHER_FOLDER",
        "seed": config.seed,
        "time_step": time_step,
        "sumo": sumo,
        "scenario": {"name": scenario.name, "sha256": scenario_hashes(scenario)},
        "vehicles": vehicles,
        **code,
        "pedestrians": pedestrians,
        "traffic": traffic,
        CONFIGURATION: None if config_text is None else sha256(config_text.encode()),
        "software": dict(software_versions()),
    }
