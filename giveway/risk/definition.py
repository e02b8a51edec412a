"""The risk file: the event, the random inputs, and how the probability is estimated."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path
from typing import Any, Literal

import tomlkit
from pydantic import Field, ValidationError

from giveway.config.files.layers import anchored, undotted
from giveway.config.files.toml import parse_toml, read_toml_file
from giveway.config.option import Name, Section
from giveway.errors import ConfigError, in_words
from giveway.risk.events import Measure
from giveway.studies.definition import folder_of

Method = Literal["monte-carlo", "subset", "importance"]


class RiskDefinition(Section):
    """The probability of one event, as its TOML file has it."""

    name: Name = Field(description="Name of the folder results/risk_NAME")
    event: str = Field(
        "frontal",
        description="The event: frontal, side, contact, impact>SPEED with a speed in km/h, "
        "mais3 or red-light",
    )
    method: Method = Field("monte-carlo", description="The estimator of the probability")
    criticality: Measure = Field(
        "deceleration",
        description="The measure of how close a run came to a frontal impact: the deceleration "
        "that would have been needed, the clearance ahead, or the time to a collision",
    )
    runs: int = Field(1000, description="Number of runs, or the budget", ge=1, le=100_000_000)
    why: int = Field(
        0,
        description="Number of base vectors for the Sobol indices of the criticality. Each costs "
        "two runs, and one for each group of inputs. By default there are no indices",
        ge=0,
        le=100_000,
    )
    seed: int = Field(1, description="Seed of the vectors of all runs", ge=0, le=2**31 - 1)
    confidence: float = Field(0.95, description="of the interval", gt=0.5, lt=1.0)
    folder: str = Field(
        "", description="The folder of relative file names. By default it is the risk file's"
    )
    run: dict[str, Any] = Field(
        default_factory=dict, description="settings of every run, as in a run's TOML file"
    )
    inputs: dict[str, Any] = Field(
        default_factory=dict,
        description="option = { distribution = [numbers] }, and crowd = true or false",
    )

    @property
    def settings(self) -> dict[str, Any]:
        """The settings of every run, with absolute paths for the files in the folder."""
        return anchored(undotted(deepcopy(self.run)), Path(self.folder))


def read_risk(path: Path) -> RiskDefinition:
    """Read the risk in a TOML file.

    Raises:
        ConfigError: the file is missing, not TOML, or holds what no risk has.
    """
    values = read_toml_file(path, "a risk, see docs/risk.md")
    return make_risk(values, str(path), path.parent.absolute())


def parse_risk(text: str, origin: str, folder: Path) -> RiskDefinition:
    """Return the risk in a TOML text; relative paths in it begin at ``folder``.

    Raises:
        ConfigError: the risk is not valid.
    """
    return make_risk(parse_toml(text, origin), origin, folder)


def make_risk(values: dict[str, Any], origin: str, folder: Path | None = None) -> RiskDefinition:
    """Return the risk in a dictionary with the keys of a risk's TOML file.

    Args:
        values: Keys and values.
        origin: Origin of the dictionary, for messages.
        folder: Folder of relative file names, or None for the working folder.

    Raises:
        ConfigError: the risk is not valid; the message names key, value and what was expected.
    """
    placed = folder_of(values, folder or Path.cwd())
    try:
        return RiskDefinition.model_validate(values | placed)
    except ValidationError as error:
        raise ConfigError(f"{origin}: {_explain(error.errors(include_url=False)[0])}") from None


def dump_risk(definition: RiskDefinition) -> str:
    """Return the risk as TOML."""
    return tomlkit.dumps(definition.model_dump(mode="json", exclude_none=True))


def _explain(error: Any) -> str:
    key = ".".join(str(part) for part in error["loc"])
    fields = RiskDefinition.model_fields
    if error["type"] == "extra_forbidden":
        return f"{key}: unknown key; expected one of {', '.join(fields)}"
    field = fields.get(key.partition(".")[0])
    meaning = "see docs/risk.md" if field is None else str(field.description)
    if error["type"] == "missing":
        return f"{key}: missing; {meaning}"
    return f"{key} = {error['input']!r}: {in_words(error)} ({meaning})"
