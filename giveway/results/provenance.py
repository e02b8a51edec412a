"""The provenance of a run, with which it can be repeated: versions, hashes, seeds, command."""

import contextlib
import functools
import platform
import re
from collections.abc import Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, NamedTuple

import numpy as np

from giveway._version import __version__
from giveway.config import RunConfig
from giveway.errors import GivewayError
from giveway.results.inputs import data_hashes, scenario_hashes, sha256
from sumo_scenarios import Scenario

CONFIGURATION: Final = "configuration_sha256"
_PACKAGES = ("fmpy", "jupedsim", "libsumo", "numba", "numpy", "osqp", "pandas", "shapely")


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


@functools.cache
def processor() -> Mapping[str, Any]:
    """Return the processor's name, the vector units that numpy uses, and the kernel of BLAS.

    No table depends on them (docs/results.md), which this makes verifiable.
    """
    from threadpoolctl import threadpool_info

    kernels = {pool["architecture"] for pool in threadpool_info() if "architecture" in pool}
    units: Mapping[str, Any] = np.show_config(mode="dicts")["SIMD Extensions"]
    return MappingProxyType(
        {"name": _processor_name(), "numpy": units.get("found", []), "blas": sorted(kernels)}
    )


def _processor_name() -> str:
    """The name that the system gives: Linux writes it into a file, others tell Python."""
    try:
        told = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return platform.processor()
    named = re.search(r"^model name\s*:\s*(.+)$", told, re.MULTILINE)
    return named[1] if named else platform.machine()


class RunFacts(NamedTuple):
    """The facts about a run that its configuration does not tell."""

    pedestrians: Mapping[str, int]  # ledger of the pedestrians that giveway moved
    vehicles: Mapping[str, Mapping[str, Any]] = MappingProxyType({})  # FMU of each ego
    traffic: Mapping[str, float] = MappingProxyType({})  # vehicles that yielded, and their time [s]
    sumo: Mapping[str, float] = MappingProxyType({})  # seed and step length in effect
    time_step: float | None = None  # [s], or None if the process died before it was known
    code: Mapping[str, Mapping[str, Any]] = MappingProxyType({})  # plug-ins, by their sockets


def manifest(
    config: RunConfig,
    scenario: Scenario,
    facts: RunFacts,
    *,
    config_text: str | None,
    remarks: Sequence[str],
    ending: str,
    error: str | None,
) -> dict[str, Any]:
    """Return the contents of ``manifest.json``, which do not depend on when the run was made.

    Args:
        config: Configuration of the run.
        scenario: Scenario of the run.
        facts: Facts about the run.
        config_text: Configuration as it is written, or None if its hash is filled in later.
        remarks: Remarks for the user.
        ending: Reason why the run ended.
        error: Error that ended the run, or None.
    """
    inputs: dict[str, str] = {}
    with contextlib.suppress(GivewayError, OSError):  # a file is gone that there was at the start
        inputs = data_hashes(config, scenario)
    return {
        "ending": ending,
        "error": error,
        "remarks": list(remarks),
        "reproduce": "giveway run --config config.toml --out ANOTHER_FOLDER",
        "seed": config.seed,
        "time_step": facts.time_step,
        "sumo": dict(facts.sumo),
        "scenario": {"name": scenario.name, "sha256": scenario_hashes(scenario)},
        "inputs": inputs,
        "vehicles": dict(facts.vehicles),
        **facts.code,
        "pedestrians": facts.pedestrians,
        "traffic": dict(facts.traffic),
        CONFIGURATION: None if config_text is None else sha256(config_text.encode()),
        "software": dict(software_versions()),
        "processor": dict(processor()),
    }
