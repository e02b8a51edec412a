"""The study file: the varied factors, the number of runs, the comparison."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path
from typing import Annotated, Any, Literal

import tomlkit
from pydantic import AfterValidator, Field, ValidationError, model_validator

from giveway.config.files.layers import anchored
from giveway.config.files.schema_names import STUDY, with_schema
from giveway.config.files.toml import parse_toml, read_toml_file
from giveway.config.option import Name, Section
from giveway.errors import ConfigError, in_words

Situation = Literal["general", "stop-and-wait", "non-stop", "slowed"]

_MOST_SEEDS = 1_000_000
_NAME = r"^[\w.-]*\w[\w.-]*$"


def _not_empty(value: dict[str, Any]) -> dict[str, Any]:
    if not value:
        raise ValueError("expected at least one factor, like controller = ['mpc', 'pid-tuned']")
    return value


class Comparison(Section):
    """The comparison: which factor's levels are compared, run by run on the same crowds."""

    factor: str = Field(
        "controller",
        description="The factor whose levels are compared. By default controller, or the last one",
    )
    baseline: str | None = Field(
        None, description="The level that is subtracted. By default it is the factor's last"
    )
    confidence: float = Field(0.95, description="of the intervals", gt=0.5, lt=1.0)
    resamples: int = Field(
        4999, description="of the bootstrap behind each interval", ge=99, le=1_000_000
    )
    minimum_pairs: int = Field(
        30, description="a situation with fewer pairs is N.A.", ge=3, le=_MOST_SEEDS
    )


class Precision(Section):
    """Sequential stopping: seeds are added until the interval is narrow enough."""

    metric: str = Field("completion_time", description="whose mean difference is to be known")
    situation: Situation = Field("general", description="in which situation")
    width: float = Field(description="whole width of its interval, in the metric's unit", gt=0)
    minimum: int = Field(100, description="seeds to begin with", ge=10, le=_MOST_SEEDS)
    batch: int = Field(100, description="seeds that are added at a time", ge=1, le=_MOST_SEEDS)


class PrimaryOutcome(Section):
    """The outcome that is named before the runs: its differences alone are confirmatory."""

    metric: str = Field(description="whose differences are confirmatory")
    situation: Situation = Field("general", description="in which situation")
    smallest_effect: float = Field(
        description="smallest difference of interest, in the metric's unit", gt=0
    )
    reason: str = Field(
        description="source of the smallest effect, or the reason for it", min_length=1
    )


class StudyDefinition(Section):
    """One study, as its TOML file has it."""

    name: Name = Field(description="of the study; names its results folder", pattern=_NAME)
    description: str = Field("", description="for the report's title")
    replications: int = Field(
        100, description="seeds per cell; the most, with [precision]", ge=1, le=_MOST_SEEDS
    )
    first_seed: int = Field(1, description="they count up from here", ge=0, le=2**31 - 1)
    reference: Literal["", "yang2019"] = Field(
        "", description="published numbers that the report shows beside its own"
    )
    table: Literal["differences", "levels"] = Field(
        "differences",
        description="what is shown first: differences to the baseline, or each level's own numbers",
    )
    folder: str = Field(
        "", description="The folder of relative file names. By default it is the study file's"
    )
    run: dict[str, Any] = Field(
        default_factory=dict, description="settings of every run, as in a run's TOML file"
    )
    factors: Annotated[dict[str, Any], AfterValidator(_not_empty)] = Field(
        description="option = [levels], or name = {level = {settings}}"
    )
    cells: tuple[dict[str, Any], ...] = Field(
        (),
        description="Combinations of levels by name. By default the study has all of them, a grid",
    )
    only: dict[str, tuple[Any, ...]] = Field(
        default_factory=dict,
        description="The only levels of some factors, by name. By default the study has all",
    )
    comparison: Comparison = Comparison()
    precision: Precision | None = None
    primary_outcome: PrimaryOutcome | None = None

    def placed(self, settings: dict[str, Any]) -> dict[str, Any]:
        """Return ``settings`` with the paths of those files that exist in the study's folder."""
        return anchored(deepcopy(settings), Path(self.folder))

    @model_validator(mode="after")
    def _seeds_in_range(self) -> StudyDefinition:
        if self.first_seed + self.replications > 2**31:
            raise ValueError(
                f"first_seed = {self.first_seed}: the last seed would be beyond 2147483647"
            )
        return self


def read_definition(path: Path) -> StudyDefinition:
    """Read the study in a TOML file.

    Paths in it are relative to its folder.

    Raises:
        ConfigError: the file is missing, not TOML, or holds what no study has.
    """
    values = read_toml_file(path, "a study, see giveway study --help")
    return _placed(values, str(path), path.parent.absolute())


def parse_definition(text: str, origin: str, folder: Path) -> StudyDefinition:
    """Return the study in a TOML text.

    Args:
        text: Text of the file.
        origin: Name of the file, for messages.
        folder: Folder to which relative paths refer.

    Raises:
        ConfigError: the study is not valid; the message names the key, its value and what was
            expected.
    """
    return _placed(parse_toml(text, origin), origin, folder)


def _placed(values: dict[str, Any], origin: str, folder: Path) -> StudyDefinition:
    return _validated(values | folder_of(values, folder), origin)


def make_definition(values: dict[str, Any], origin: str) -> StudyDefinition:
    """Return the study in a dictionary with the keys of a study's TOML file.

    Args:
        values: Keys and values; file names in it are relative to the working folder.
        origin: Origin of the dictionary, for messages.

    Raises:
        ConfigError: the study is not valid; the message names the key, its value and what was
            expected.
    """
    return _placed(values, origin, Path.cwd())


def changed(definition: StudyDefinition, changes: dict[str, Any], origin: str) -> StudyDefinition:
    """Return the study with some keys changed.

    Raises:
        ConfigError: the result is not a valid study.
    """
    return _validated(definition.model_dump(exclude_unset=True) | changes, origin)


def _validated(values: dict[str, Any], origin: str) -> StudyDefinition:
    try:
        return StudyDefinition.model_validate(values)
    except ValidationError as error:
        raise ConfigError(f"{origin}: {_explain(error.errors(include_url=False)[0])}") from None


def folder_of(values: dict[str, Any], folder: Path) -> dict[str, str]:
    """Return the folder to which relative file names refer, if a study or risk names any file."""
    named = values.get("folder", "")
    varied = (values.get("run"), values.get("factors"), values.get("inputs"))
    if isinstance(named, str) and (named or any(_holds_file_of(folder, v) for v in varied)):
        return {"folder": str(folder / named)}
    return {}


def _holds_file_of(folder: Path, values: Any) -> bool:
    """Return whether a text in ``values`` names a file or folder in ``folder``."""
    if isinstance(values, dict):
        return any(_holds_file_of(folder, value) for value in values.values())
    if isinstance(values, list):
        return any(_holds_file_of(folder, value) for value in values)
    if not isinstance(values, str):
        return False
    try:
        return bool(anchored({"scenario": values}, folder)["scenario"] != values)
    except OSError:  # the text is too long for a name
        return False


def dump_definition(definition: StudyDefinition, out: Path | None = None) -> str:
    """Return the study as TOML, from which :func:`parse_definition` makes the same cells.

    Files in the study's own folder ``out`` move with it. Factors keep their order, on which the
    numbers of the cells depend. TOML demands tables after plain lists, which would change that
    order; therefore each level is an inline table.
    """
    values = definition.model_dump(mode="json", exclude_none=True)
    if out is not None and Path(definition.folder) == out.absolute():
        values["folder"] = "."
    document = tomlkit.document()
    for key, value in values.items():
        if not isinstance(value, dict):
            document.append(key, _inline(value))
    for key, value in values.items():
        if key == "factors":
            table = tomlkit.table()
            for name, levels in value.items():
                if isinstance(levels, dict):
                    for label, level in levels.items():
                        table.append(tomlkit.key([name, label]), _inline(level))
                else:
                    table.append(name, _inline(levels))
            document.append(key, table)
        elif isinstance(value, dict):
            document.append(key, tomlkit.item(value))
    return with_schema(tomlkit.dumps(document), STUDY)


def _inline(value: Any) -> Any:
    if isinstance(value, dict):
        table = tomlkit.inline_table()
        for key, item in value.items():
            table.append(key, _inline(item))
        return table
    if isinstance(value, list | tuple):
        array = tomlkit.array()
        for item in value:
            array.append(_inline(item))
        return array
    return tomlkit.item(value)


def _explain(error: Any) -> str:
    place = [str(part) for part in error["loc"]]
    key = ".".join(place) or "study"
    if error["type"] == "missing":
        return f"{key}: missing; {_meaning(place)}"
    if error["type"] == "extra_forbidden":
        known = _fields(place[:-1])
        return f"{key}: unknown key; expected one of {', '.join(known)}"
    if error["type"] == "value_error":
        return f"{key}: {error['ctx']['error']}"
    expected = in_words(error)
    if error["type"] == "string_pattern_mismatch":
        expected = "expected letters, digits, '_', '-' and '.'"
    return f"{key} = {error['input']!r}: {expected} ({_meaning(place)})"


def _fields(place: list[str]) -> dict[str, Any]:
    tables: dict[str, type[Section]] = {
        "comparison": Comparison,
        "precision": Precision,
        "primary_outcome": PrimaryOutcome,
    }
    model = tables.get(place[0] if place else "", StudyDefinition)
    return dict(model.model_fields)


def _meaning(place: list[str]) -> str:
    field = _fields(place[:-1]).get(place[-1]) if place else None
    return str(field.description) if field is not None else "see docs/studies.md"
