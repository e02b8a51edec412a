"""The frozen scenes, people and seeds of the benchmark, as a study of the named controllers."""

import re
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path

from giveway.config.files.layers import read_toml
from giveway.config.files.toml import parse_toml
from giveway.errors import ConfigError
from giveway.studies.definition import StudyDefinition, make_definition

VERSION = 1
"""Version of scenes, people and seeds: only numbers of one version can be compared."""
ALL_SCENES = "all scenes"
"""Name of the row that pools the drives of all scenes among the same people."""
ORIGIN = "giveway benchmark"
"""Origin of the study, for messages."""

_OWN = ("controller_options", "controller_profile", "regulation", "rules", "safety", "vehicle")
"""Settings that a controller may need; all others are the benchmark's."""
_LONGEST = 80
"""Largest number of characters of the study's name."""


def benchmark_of(controllers: Sequence[str], settings: Path | None = None) -> StudyDefinition:
    """Return the study that drives each controller through the benchmark.

    Args:
        controllers: Names of bundled controllers and plug-ins, or paths of controller FMUs.
        settings: TOML file with the settings that the controllers need, or None.

    Raises:
        ConfigError: the file cannot be used, or sets what the benchmark fixes.
    """
    values = parse_toml(_text(), "scenes.toml")
    if settings is not None:
        values["run"] |= _own_settings(settings)
    values["factors"]["controller"] = [*dict.fromkeys(controllers)]
    slug = re.sub(r"[^\w.-]+", "-", "_".join(Path(name).name for name in controllers))
    values["name"] = f"{values['name']}_{slug}"[:_LONGEST]
    values["description"] = f"Benchmark {VERSION}: {', '.join(controllers)}"
    return make_definition(values, ORIGIN)


def scenes() -> tuple[str, ...]:
    """Return the names of the scenes."""
    return tuple(parse_toml(_text(), "scenes.toml")["factors"]["scene"])


def _text() -> str:
    file = files("giveway.studies.benchmark") / "scenes.toml"
    return file.read_text(encoding="utf-8")


def _own_settings(settings: Path) -> dict[str, object]:
    values = dict(read_toml(settings).values)
    for key, value in values.items():
        if key not in _OWN:
            raise ConfigError(
                f"{settings}: {key} = {value!r}: the benchmark fixes it; expected no table or key "
                f"but {', '.join(_OWN)}; remove it, or compare by giveway study"
            )
    return values
