"""The files that a run reads, and their hashes, by which changed ones are noticed."""

import functools
import hashlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from giveway.config import RunConfig
from giveway.config.files.presets import is_preset_file
from giveway.config.files.trust import is_own_folder
from giveway.ego.vehicle_model import fmu_path
from giveway.errors import ConfigError
from giveway.gate import MANIFEST, read_json
from giveway.scenario_files import read_scenario, with_included
from giveway.scenario_files.options import parse_options
from sumo_scenarios import Scenario


def sha256(content: bytes) -> str:
    """Return the hexadecimal SHA-256 of ``content``."""
    return hashlib.sha256(content).hexdigest()


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
    return {name: file_hash(file) for name, file in scenario_inputs(scenario).items()}


def data_files(config: RunConfig, scenario: Scenario) -> dict[str, Path]:
    """Return the files that a run reads, by names that do not depend on their folders."""
    files = {f"scenario {name}": file for name, file in _scenario_files(scenario)}
    return files | dict(_own_files(config))


def data_hashes(config: RunConfig, scenario: Scenario) -> dict[str, str]:
    """Return the SHA-256 of each of the :func:`data_files`; a file that is gone has none."""
    files = data_files(config, scenario).items()
    return {name: file_hash(file) for name, file in files if file.is_file()}


def require_recorded(folder: Path, config: RunConfig, scenario: Scenario) -> None:
    """Make sure that a run by somebody else's results reads the files that they were made with.

    The user's own results may be repeated with files that have changed since.

    Args:
        folder: Results folder of a run or study.
        config: Configuration of the run.
        scenario: Scenario of the run.

    Raises:
        ConfigError: a file has another content, or the folder has no hash of it.
        ResultsError: the manifest in the folder cannot be used.
        OSError: the manifest cannot be read.
    """
    if is_own_folder(folder):
        return
    known = _recorded(read_json(folder / MANIFEST))
    for name, now in data_hashes(config, scenario).items():
        if now not in known.get(name, ()):
            found = "has another content than the results were made with"
            raise ConfigError(
                f"{folder}: {name}: {found if name in known else 'has no hash in ' + MANIFEST}; "
                "somebody else's results are repeated with the same files only; put them back, or "
                "copy config.toml, read it, and run the copy"
            )


def _recorded(manifest: Mapping[str, Any]) -> dict[str, set[str]]:
    """Return the hashes of input files that a manifest records, by the names of the files."""
    try:
        whole = [cell["inputs"] for cell in manifest.get("cells", ())]  # of a study
        whole.append(manifest.get("inputs", {}))
        named = manifest.get("scenario", {}).get("sha256", {})  # of an earlier giveway
        whole.append({f"scenario {name}": hash_ for name, hash_ in named.items()})
        known: dict[str, set[str]] = {}
        for inputs in whole:
            for name, hash_ in inputs.items():
                known.setdefault(name, set()).add(str(hash_))
    except (KeyError, TypeError, AttributeError):
        return {}
    return known


def _seen_from(folder: Path, file: Path) -> str:
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # the file is on another drive
        return file.name


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
    if not config.crowd.recorded:
        return []
    # imported here, since pandas comes with it
    from giveway.recordings.clips import clip_files

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


def file_hash(file: Path) -> str:
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
