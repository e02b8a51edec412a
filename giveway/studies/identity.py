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
from giveway._environment import ROOMS
from giveway.config import RunConfig
from giveway.config.files.foreign_code import code_hashes
from giveway.config.files.presets import is_preset_file
from giveway.ego.vehicle_model import fmu_path
from giveway.errors import ConfigError, GivewayError
from giveway.plug_ins.finding import is_fmu, shown
from giveway.recordings.clips import clip_files
from giveway.results.provenance import scenario_hashes, scenario_inputs, sha256, software_versions
from giveway.scenario_files.options import parse_options
from giveway.studies.record import Task
from sumo_scenarios import Scenario, ScenarioError, find

_NOT_NUMBERS = (
    "cli",
    "doctor",
    "exports",
    "figures",
    "replays",
    "reports",
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
    hashes = {f"scenario {name}": hash_ for name, hash_ in scenario_hashes(scenario).items()}
    hashes |= {name: _hash(file) for name, file in _own_files(config)}
    return hashes | code_hashes(config)


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
        files = {f"scenario {name}": file for name, file in _scenario_files(find(config.scenario))}
        files |= dict(_own_files(config))
    except (ScenarioError, GivewayError):  # the file that names the inputs is missing
        files = {}
    found = {name: _hash(file) for name, file in files.items() if file.is_file()}
    found |= code_hashes(config)
    for name, expected in task.inputs.items():
        if found.get(name) != expected:
            what = "another content" if name in found else "nothing"
            raise ConfigError(
                f"worker on {here}: {name}: found {what} where run {task.run} was planned with "
                "this file; put the study's files under the same path on every machine; if it was "
                "changed meanwhile, go on with --resume"
            )


def _scenario_files(scenario: Scenario) -> tuple[tuple[str, Path], ...]:
    """Return the scenario's inputs by name.

    They are read again only when the files that name them have changed.
    """
    naming = (scenario.config_file, scenario.settings_file)
    return _scenario_files_of(scenario, tuple(_stamp(file) for file in naming if file))


@functools.lru_cache(maxsize=64)
def _scenario_files_of(scenario: Scenario, _stamps: object) -> tuple[tuple[str, Path], ...]:
    return tuple(scenario_inputs(scenario).items())


def _own_files(config: RunConfig) -> list[tuple[str, Path]]:
    """Return the files that a run reads apart from its scenario."""
    files = [*_vehicle_files(config), *_preset_files(config), *_option_files(config)]
    return [*files, *_recording_files(config)]


def _recording_files(config: RunConfig) -> list[tuple[str, Path]]:
    """Return the files of the recordings whose people come in."""
    return [
        (f"recording '{entry.name}': {file.name}", file)
        for entry in config.crowd.recorded
        for file in clip_files(entry)
    ]


def _preset_files(config: RunConfig) -> list[tuple[str, Path]]:
    """Return the preset files of the pedestrian model: of the crowd, and as each ego expects it."""
    named = [("preset of the crowd", config.crowd.preset)]
    named += [
        (f"preset that {ego.ego_id} predicts with", ego.perception.preset)
        for ego in config.each_ego()
    ]
    return [(name, Path(preset)) for name, preset in named if is_preset_file(preset)]


def _option_files(config: RunConfig) -> list[tuple[str, Path]]:
    """Return the files that ``sumo.options`` name, such as additional files."""
    named = [
        (option, Path(piece.strip()))
        for option, value in parse_options(config.sumo.options).items()
        for piece in value.split(",")
        if piece.strip()
    ]
    return [
        (f"SUMO's {option} {number}: {file.name}", file)
        for number, (option, file) in enumerate(named, start=1)
        if file.is_file()
    ]


def _vehicle_files(config: RunConfig) -> list[tuple[str, Path]]:
    found = []
    for ego in config.each_ego():
        named: list[Path] = [fmu_path(ego.vehicle)]
        named += [Path(ego.vehicle.profile)] if ego.vehicle.profile else []
        found += [(f"vehicle of {ego.ego_id}: {f.name}", f) for f in named if f.is_file()]
        if ego.controller_profile:
            profile = Path(ego.controller_profile)
            found.append((f"controller of {ego.ego_id}: {profile.name}", profile))
    return found


def _hash(file: Path) -> str:
    """Return the file's SHA-256.

    The file is read again only when it has changed.
    """
    return _hash_of(str(file.absolute()), _stamp(file))


def _stamp(file: Path) -> tuple[int, int]:
    """Return the time and size of a file, which change with it."""
    status = file.stat()
    return status.st_mtime_ns, status.st_size


@functools.lru_cache(maxsize=1024)
def _hash_of(file: str, _stamp: tuple[int, int]) -> str:
    return sha256(Path(file).read_bytes())
