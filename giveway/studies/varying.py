"""Studies without a file: the factors come from the command line or from Python."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from giveway.config.files.layers import read_toml, undotted
from giveway.config.files.toml import toml_value
from giveway.errors import ConfigError
from giveway.studies.definition import StudyDefinition, make_definition

_SEEDS = 20


def varied(variations: Sequence[str], settings: Path | None = None) -> StudyDefinition:
    """Return the study of all combinations of some options' values.

    Args:
        variations: Texts like ``controller_options.precaution_weight=5,20``.
        settings: TOML file with the other settings of every run, or None for giveway's defaults.

    Raises:
        ConfigError: a text is no variation, or the file cannot be used.
    """
    factors: dict[str, list[Any]] = {}
    for variation in variations:
        name, values = _parsed(variation)
        if name in factors:
            raise ConfigError(f"--vary {name}: is given twice; list all its values in one option")
        factors[name] = values
    definition: dict[str, Any] = {
        "name": "_".join(["vary", *factors])[:80],
        "description": "; ".join(variations),
        "replications": _SEEDS,
        "factors": factors,
    }
    if settings is not None:
        definition["run"] = dict(read_toml(settings).values)
    return make_definition(definition, "--vary")


def chosen(choices: Sequence[str]) -> dict[str, list[Any]]:
    """Return the levels, by factor, that texts like ``controller=mpc`` choose.

    Raises:
        ConfigError: a text chooses nothing.
    """
    levels: dict[str, list[Any]] = {}
    for choice in choices:
        name, equals, text = (part.strip() for part in choice.partition("="))
        if not equals or not name or not text:
            raise ConfigError(
                f"--only {choice}: expected a factor of the study and one of its levels, like "
                "controller=mpc; give it again for another level"
            )
        levels.setdefault(name, []).append(toml_value(text))
    return levels


def _parsed(variation: str) -> tuple[str, list[Any]]:
    name, equals, text = variation.partition("=")
    values = [toml_value(part.strip()) for part in text.split(",") if part.strip()]
    if not equals or not name.strip() or len(values) < 2:
        raise ConfigError(
            f"--vary {variation}: expected an option and at least two values, like "
            "controller_options.precaution_weight=5,20"
        )
    return name.strip(), values


def study_of(study: Mapping[str, Any] | str | Path) -> tuple[StudyDefinition, str]:
    """Return the study that a caller of the Python API names, and its origin for messages.

    Raises:
        ConfigError: there is no such study.
    """
    from giveway.studies.definition import read_definition
    from giveway.studies.study_files import find_study

    if isinstance(study, Mapping):
        values = {"name": "study", "replications": _SEEDS, **study}
        if isinstance(values.get("run"), Mapping):
            values["run"] = undotted(values["run"])
        return make_definition(values, "study"), "study"
    return read_definition(find_study(study)), str(study)
