"""The hashes of everything on which a run's numbers depend: settings, input files, code.

Two runs with the same key have the same rows, byte for byte. Therefore a study can be resumed.
"""

import functools
import hashlib
import json
import socket
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fmus.text import printable
from giveway._start.environment import ROOMS
from giveway.config import RunConfig
from giveway.config.files.foreign_code import code_hashes
from giveway.errors import ConfigError, GivewayError
from giveway.plug_ins.finding import is_fmu, shown
from giveway.results.inputs import data_files, data_hashes, file_hash
from giveway.results.provenance import software_versions
from giveway.studies.record import Task
from sumo_scenarios import Scenario, ScenarioError, find

_NOT_NUMBERS = (
    "cli",
    "doctor",
    "exports",
    "figures",
    "replays",
    "reports",
    "risk",
    "studies",
    "validation",
)
"""Parts of giveway that only read results: a change there leaves every record valid."""
_NAMING_FILES = (
    ("vehicle", "fmu"),
    ("vehicle", "profile"),
    ("crowd", "preset"),
    ("perception", "preset"),
)
# Files that make the rows, in packages that are otherwise left out
_ROWS = frozenset({"studies/execution/perform.py", "studies/record.py"})
_IRRELEVANT_VERSIONS = frozenset({"platform", "pandas"})


@functools.cache
def software_identity() -> str:
    """Return a text that changes with all code that can change a number: giveway and libraries."""
    root = Path(__file__).resolve().parent.parent.parent
    digest = hashlib.sha256()
    for room in ("giveway", *ROOMS):
        for path in sorted((root / room).rglob("*.py")):
            place = path.relative_to(root / room)
            excluded = room == "giveway" and place.parts[0] in _NOT_NUMBERS
            if not excluded or place.as_posix() in _ROWS:
                digest.update(str(place.as_posix()).encode() + path.read_bytes())
    digest.update(json.dumps(relevant_versions(), sort_keys=True).encode())
    return digest.hexdigest()[:16]


def relevant_versions(versions: Mapping[str, Any] | None = None) -> dict[str, str]:
    """Return the versions and the kind of machine on which the bytes of a row depend.

    The processor is not among them: docs/results.md promises the same bytes on each.

    Args:
        versions: Versions as a manifest has them, or None for those of this process.
    """
    versions = software_versions() if versions is None else versions
    relevant = {k: str(v) for k, v in versions.items() if k not in _IRRELEVANT_VERSIONS}
    major_minor = relevant.get("python", "").split(".")[:2]
    library = str(versions.get("platform", "")).partition("-with-")[2]
    return relevant | {"python": ".".join(major_minor), "C library": library}


def differences(versions: Mapping[str, str]) -> str:
    """Return in words how this process differs from another: "numpy 2.1 instead of 2.2".

    Args:
        versions: The other process's :func:`relevant_versions`.
    """
    here = relevant_versions()
    pairs = [(k, here.get(k, "none"), versions.get(k, "none")) for k in sorted({*here, *versions})]
    told = [f"{name} {mine} instead of {other}" for name, mine, other in pairs if mine != other]
    return printable(", ".join(told) or "its own files", 400)


def input_hashes(config: RunConfig, scenario: Scenario) -> dict[str, str]:
    """Return the SHA-256 of every file that the run reads: scenario, FMUs, profiles, presets."""
    return data_hashes(config, scenario) | code_hashes(config)


def cell_digest(config: RunConfig, inputs: dict[str, str], software: str) -> str:
    """Return a hash of everything but the seed.

    It depends on the content of the files, but not on their paths.

    Args:
        config: Effective configuration; its seed is left out.
        inputs: Hashes of the input files from :func:`input_hashes`.
        software: Identity of the code from :func:`software_identity`.
    """
    values = config.model_dump(mode="json", exclude={"seed"})
    for table in (values, *values["egos"]):
        for section, key in _NAMING_FILES:
            settings = table.get(section, {})
            if key in settings:
                settings[key] = Path(settings[key]).name
        if is_fmu(table.get("controller", "")):
            table["controller"] = shown(table["controller"])
            table["controller_profile"] = Path(table.get("controller_profile", "")).name
    for entry in values["crowd"]["recorded"]:
        entry |= {key: Path(entry[key]).name for key in ("path", "dataset")}
    values["scenario"] = Path(values["scenario"]).name
    values["told"] = sorted(config.vehicle.told)
    content = {"settings": values, "inputs": inputs, "software": software}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def run_key(digest: str, seed: int) -> str:
    """Return the key of one run of a cell."""
    return hashlib.sha256(f"{digest} {seed}".encode()).hexdigest()[:32]


def require_same(task: Task) -> None:
    """Make sure that this process makes the planned run, perhaps elsewhere or much later.

    Raises:
        ConfigError: another version of giveway or a library runs here, or a file differs.
    """
    here = socket.gethostname()
    if task.software != software_identity():
        raise ConfigError(
            f"worker on {here}: its giveway, libraries or machine differ from those that planned "
            f"run {task.run} ({differences(task.versions)}), and so might the bytes of its rows; "
            "use the same versions and kind of machine everywhere; if they were changed "
            "meanwhile, go on with --resume"
        )
    config = task.run_config
    try:
        files = data_files(config, find(config.scenario))
    except (ScenarioError, GivewayError):  # the file that names the inputs is missing
        files = {}
    found = {name: file_hash(file) for name, file in files.items() if file.is_file()}
    found |= code_hashes(config)
    for name, expected in task.inputs.items():
        if found.get(name) != expected:
            what = "another content" if name in found else "nothing"
            raise ConfigError(
                f"worker on {here}: {name}: found {what} where run {task.run} was planned with "
                "this file; put the study's files under the same path on every machine; if it was "
                "changed meanwhile, go on with --resume"
            )
