"""Finding scenarios: by the name of a bundled one, by folder, or by .sumocfg file."""

import difflib
import os
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from sumo_scenarios.errors import ScenarioError

_ROOT = Path(__file__).parent
_CONFIG_SUFFIX = ".sumocfg"
_OLD_CONFIG_SUFFIX = ".cfg"  # suffix of name.sumo.cfg, an older custom of SUMO's users
_SETTINGS_SUFFIX = ".giveway.toml"


@dataclass(frozen=True, slots=True)
class Scenario:
    """A SUMO scenario and the giveway settings beside it; all paths are absolute."""

    name: str  # the bundled name, or the stem of the .sumocfg
    folder: Path
    config_file: Path  # its .sumocfg
    settings_file: Path | None  # its <stem>.giveway.toml
    description: str  # one line, from the settings; empty without them


@cache
def available() -> tuple[str, ...]:
    """Name the bundled scenarios, in alphabetical order."""
    return tuple(sorted(config.parent.name for config in _ROOT.glob(f"*/*{_CONFIG_SUFFIX}")))


def find(name_or_path: str | Path) -> Scenario:
    """Find a scenario by its bundled name, its folder, or its .sumocfg file.

    A string that is a bundled name means that scenario, whatever lies in the current folder; for
    a folder of the same name write ``./name``, or pass a ``Path``.

    Raises:
        ScenarioError: there is no such scenario, a folder holds no or several .sumocfg files, or
            the settings beside the .sumocfg are not TOML.
    """
    text = os.fspath(name_or_path)
    bundled = available()
    if isinstance(name_or_path, str) and text in bundled:
        return _bundled(text)
    try:
        # abspath, not Path.resolve: the files that a linked .sumocfg names lie beside the link.
        path = Path(os.path.abspath(Path(text).expanduser()))  # noqa: PTH100
        if text.strip() and path.is_dir():
            return _from_folder(path)
        if path.is_file():
            return _from_config(path)
    except (OSError, RuntimeError) as error:  # RuntimeError: the ~user of a stranger
        raise ScenarioError(f"scenario {text!r} cannot be read: {error}") from error
    raise ScenarioError(_unknown(text, bundled))


@cache
def _bundled(name: str) -> Scenario:
    return _from_folder(_ROOT / name)


def _from_folder(folder: Path) -> Scenario:
    configs = sorted(folder.glob(f"*{_CONFIG_SUFFIX}"))
    if len(configs) == 1:
        return _from_config(configs[0])
    if configs:
        names = ", ".join(config.name for config in configs)
        raise ScenarioError(
            f"folder {folder} holds {len(configs)} {_CONFIG_SUFFIX} files ({names}): name one"
        )
    raise ScenarioError(f"folder {folder} holds no {_CONFIG_SUFFIX} file: expected exactly one")


def _from_config(config_file: Path) -> Scenario:
    if config_file.suffix not in {_CONFIG_SUFFIX, _OLD_CONFIG_SUFFIX}:
        raise ScenarioError(
            f"{config_file} is not a scenario: expected a {_CONFIG_SUFFIX} file or its folder"
        )
    name = config_file.stem.removesuffix(".sumo")
    settings_file = config_file.with_name(name + _SETTINGS_SUFFIX)
    has_settings = settings_file.is_file()
    return Scenario(
        name=name,
        folder=config_file.parent,
        config_file=config_file,
        settings_file=settings_file if has_settings else None,
        description=_description(settings_file) if has_settings else "",
    )


def _description(settings_file: Path) -> str:
    try:
        description = tomllib.loads(settings_file.read_text(encoding="utf-8")).get("description")
    except (ValueError, RecursionError) as error:  # not TOML, not UTF-8, brackets in one another
        raise ScenarioError(f"{settings_file} is not valid TOML: {error}") from error
    if not isinstance(description, str | None):
        raise ScenarioError(
            f"{settings_file}: description = {description!r}: expected a line of text"
        )
    return description or ""


def _unknown(text: str, bundled: tuple[str, ...]) -> str:
    """Return a message on an unknown scenario: a similar name, and the known ones."""
    path = Path(text)
    if len(path.parts) > 1 or path.suffix == _CONFIG_SUFFIX:
        kind = f"{_CONFIG_SUFFIX} file" if path.suffix == _CONFIG_SUFFIX else "file or folder"
        problem, candidates = f"no such {kind}: {text!r}", _neighbours(path)
    else:
        problem, candidates = f"unknown scenario {text!r}", {name: name for name in bundled}
    close = difflib.get_close_matches(path.name.lower(), candidates, n=1)
    hint = f"; did you mean {candidates[close[0]]!r}?" if close else ""
    return f"{problem}{hint} (bundled: {', '.join(bundled)}; or a folder, or a .sumocfg file)"


def _neighbours(path: Path) -> dict[str, str]:
    """Return possible scenarios in the folder of `path`: lower-case name to path."""
    try:
        entries = sorted(path.parent.iterdir())
        return {
            entry.name.lower(): str(entry)
            for entry in entries
            if entry.suffix == _CONFIG_SUFFIX or entry.is_dir()
        }
    except OSError:
        return {}
