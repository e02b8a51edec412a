"""The risk that a command line describes: a scenario, a file, and what flags add to them."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from giveway.config.files.layers import Layer, merge, read_toml, undotted
from giveway.config.files.toml import toml_value
from giveway.errors import ConfigError
from giveway.risk.definition import RiskDefinition, make_risk, read_risk
from giveway.risk.inputs import CROWD


def requested_risk(
    subject: str,
    changes: Mapping[str, Any],
    fixed: Sequence[str],
    random: Sequence[str],
    config: Path | None = None,
) -> tuple[RiskDefinition, str]:
    """Return the risk that is wanted, and its origin for messages.

    Args:
        subject: A scenario, or the name of a risk file, which has an ``event`` or ``[inputs]``.
        changes: Keys of the risk that flags set; None where a flag is not given.
        fixed: Texts like ``crowd.pedestrians=30``, settings of every run.
        random: Texts like ``vehicle.mass=normal:1000,100``, random inputs.
        config: A run's TOML file with other settings of every run, or None.

    Raises:
        ConfigError: the risk is not valid.
    """
    given = {key: value for key, value in changes.items() if value is not None}
    settings = undotted(dict(_fixed(text) for text in fixed))
    inputs = dict(_random(text) for text in random)
    if subject.endswith(".toml"):
        risk, origin = read_risk(Path(subject)), subject
        values = risk.model_dump(exclude_unset=True)
    else:
        values, origin = {"name": Path(subject).stem, "run": {"scenario": subject}}, subject
    layers = [Layer(origin, undotted(values.get("run", {})))]
    layers += [] if config is None else [read_toml(config)]
    values["run"] = merge([*layers, Layer("--fix", settings)])
    values["inputs"] = values.get("inputs", {}) | inputs
    return make_risk(values | given, origin), origin


def _fixed(text: str) -> tuple[str, Any]:
    name, equals, value = (part.strip() for part in text.partition("="))
    if not (name and equals and value):
        raise ConfigError(
            f"--fix {text}: expected an option and its value, like crowd.pedestrians=30"
        )
    return name, toml_value(value)


def _random(text: str) -> tuple[str, Any]:
    name, equals, given = (part.strip() for part in text.partition("="))
    distribution, colon, numbers = (part.strip() for part in given.partition(":"))
    if name == CROWD and given in {"true", "false"}:
        return name, given == "true"
    if not (name and equals and colon and numbers):
        raise ConfigError(
            f"--random {text}: expected an option, a distribution and its numbers, like "
            "vehicle.mass=normal:1000,100"
        )
    return name, {distribution: [toml_value(part.strip()) for part in numbers.split(",")]}
