"""The plan of a study: settings, key and order of every run, before any of them is made."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from giveway.config import RunConfig
from giveway.config.files.layers import Layer, merge
from giveway.config.files.loading import load
from giveway.config.option import DEFAULT_PRESET
from giveway.cosimulation.preflight import preflight
from giveway.errors import ConfigError, GivewayError
from giveway.metrics.plugged_in import metric_columns
from giveway.results.inputs import scenario_inputs
from giveway.scenario_files.declared_ids import declares_people
from giveway.studies.definition import StudyDefinition
from giveway.studies.design import Cell, Design, Level, design
from giveway.studies.identity import (
    cell_digest,
    input_hashes,
    relevant_versions,
    run_key,
    software_identity,
)
from giveway.studies.record import Task, run_id
from giveway.studies.statistics import metric
from sumo_scenarios import Scenario


@dataclass(frozen=True)
class PlannedCell:
    """A cell whose scenario and settings fit each other.

    Attributes:
        cell: Levels and number.
        config: Effective configuration of its first run.
        inputs: SHA-256 of each file that its runs read.
        digest: Hash of everything that its runs have in common.
    """

    cell: Cell
    config: RunConfig
    inputs: dict[str, str]
    digest: str


@dataclass(frozen=True)
class PlannedRun:
    """A planned run: its cell and its seed."""

    planned: PlannedCell
    seed: int

    @property
    def id(self) -> str:
        """The run's name within the study."""
        return run_id(self.planned.cell.number, self.seed)

    @property
    def key(self) -> str:
        """The key of the run's record."""
        return run_key(self.planned.digest, self.seed)

    @property
    def config(self) -> RunConfig:
        """The run's effective configuration."""
        return self.planned.config.model_copy(update={"seed": self.seed})

    def task(self) -> Task:
        """Return the task that a worker needs to make the run."""
        text = self.config.as_json()
        made_by = software_identity(), relevant_versions()
        return Task(self.id, self.key, text, self.planned.inputs, *made_by)


@dataclass(frozen=True)
class Plan:
    """The cells of a study and their seeds."""

    definition: StudyDefinition
    design: Design
    cells: tuple[PlannedCell, ...]

    @property
    def seeds(self) -> range:
        """The seeds of every cell.

        With [precision] these are the most that may be run.
        """
        first = self.definition.first_seed
        return range(first, first + self.definition.replications)

    def runs(self, seeds: range) -> Iterator[PlannedRun]:
        """Yield the runs of all cells seed by seed, so that finished runs are always paired."""
        for seed in seeds:
            for planned in self.cells:
                yield PlannedRun(planned, seed)

    def __len__(self) -> int:
        return len(self.cells) * len(self.seeds)


def plan(definition: StudyDefinition, origin: str) -> Plan:
    """Check every level and every cell's scenario and vehicles, and give every run its key.

    Args:
        definition: Definition of the study.
        origin: File of the study, for messages.

    Raises:
        GivewayError: a cell or level cannot be used; the message names it.
    """
    designed = design(definition, origin)
    _require_valid_levels(definition, designed, origin)
    definition = _with_comparison(definition, designed, origin)
    _require_metrics(definition, origin)
    cells = tuple(_planned(cell, definition, origin) for cell in designed.cells)
    if _meet_others(cells):
        definition = _with_preset(definition, DEFAULT_PRESET)
        cells = tuple(_planned(cell, definition, origin) for cell in designed.cells)
    _require_own_names(designed, cells, origin)
    return Plan(definition, designed, cells)


def _meet_others(cells: Iterable[PlannedCell]) -> bool:
    """Return whether the presets of people differ only because the controllers declare others."""
    crowds = [planned.config.crowd for planned in cells]
    return len({crowd.preset for crowd in crowds if "preset" not in crowd.model_fields_set}) > 1


def _with_preset(definition: StudyDefinition, preset: str) -> StudyDefinition:
    """Return ``definition`` with one preset of people for all controllers."""
    run = merge([Layer("", definition.run), Layer("", {"crowd": {"preset": preset}})])
    return definition.model_copy(update={"run": run})


def _require_own_names(designed: Design, cells: Iterable[PlannedCell], origin: str) -> None:
    """Make sure that no factor has the name of a metric's column."""
    names = {factor.name for factor in designed.factors}
    for column in (column for planned in cells for column in metric_columns(planned.config)):
        if column.name in names:
            raise ConfigError(
                f"{origin}: factor '{column.name}': a metric of [metrics] has a column of this "
                "name; give the factor another one"
            )


def _with_comparison(definition: StudyDefinition, designed: Design, origin: str) -> StudyDefinition:
    """Return ``definition`` with the factor and the baseline that its comparison leaves open."""
    names = [factor.name for factor in designed.factors]
    wanted = definition.comparison
    chosen = "factor" in wanted.model_fields_set or wanted.factor in names
    try:
        factor = designed.factor(wanted.factor if chosen else names[-1])
    except ConfigError as error:
        raise ConfigError(f"{origin}: [comparison] {error}") from None
    baseline = None if wanted.baseline is None else factor.level(wanted.baseline)
    if baseline is None and (wanted.baseline is None or factor.name in definition.only):
        baseline = factor.levels[-1]  # the study's baseline may be left out
    if baseline is None:
        known = ", ".join(level.label for level in factor.levels)
        raise ConfigError(
            f"{origin}: [comparison] baseline = {wanted.baseline!r}: expected one of {known}"
        )
    complete = wanted.model_copy(update={"factor": factor.name, "baseline": baseline.label})
    return definition.model_copy(update={"comparison": complete})


def _require_valid_levels(definition: StudyDefinition, designed: Design, origin: str) -> None:
    """Make sure that levels without a cell are valid, too: cells may be listed, or left out.

    Raises:
        GivewayError: a level is not valid.
    """
    whole = designed
    if definition.only:
        whole = design(definition.model_copy(update={"only": {}}), origin)
    for factor in whole.factors:
        used = [cell.levels[factor.name] for cell in designed.cells]
        for level in factor.levels:
            if level not in used:
                _require_valid(factor.name, level, whole, definition, origin)


def _require_valid(
    name: str, level: Level, designed: Design, definition: StudyDefinition, origin: str
) -> None:
    """Make sure that a level is valid by itself, or with the other levels of some cell."""
    place = f"{origin}: [factors] {name} = {level.label}"
    first = None
    for others in ({}, *(cell.levels for cell in designed.cells)):
        layer = Cell(0, {**others, name: level}).layer(origin, definition)
        try:
            load([replace(layer, origin=place)])
        except GivewayError as error:
            first = first or error
        else:
            return
    assert first is not None
    first.args = (str(first) if origin in str(first) else f"{place}: {first}",)
    raise first


def _require_metrics(definition: StudyDefinition, origin: str) -> None:
    """Make sure that the metrics of [precision] and [primary_outcome] are compared."""
    for table in ("precision", "primary_outcome"):
        wanted = getattr(definition, table)
        try:
            if wanted is not None:
                metric(wanted.metric)
        except ConfigError as error:
            raise ConfigError(f"{origin}: [{table}] {error}") from None


def _planned(cell: Cell, definition: StudyDefinition, origin: str) -> PlannedCell:
    try:
        config, scenario = load([cell.layer(origin, definition)])
        config = config.model_copy(update={"seed": definition.first_seed})
        preflight(config, scenario)
        _require_people(cell, config, scenario)
        inputs = input_hashes(config, scenario)
    except GivewayError as error:
        where = f"{origin}: cell {cell.number} ({cell.label})"
        error.args = (str(error) if origin in str(error) else f"{where}: {error}",)
        raise
    return PlannedCell(cell, config, inputs, cell_digest(config, inputs, software_identity()))


def _require_people(cell: Cell, config: RunConfig, scenario: Scenario) -> None:
    """Make sure that a study that varies the crowd has pedestrians in each of its cells.

    Raises:
        ConfigError: neither giveway nor the scenario adds pedestrians in a cell.
    """
    varied = any("crowd" in level.settings for level in cell.levels.values())
    if not varied or config.crowd.adds_people:
        return
    if not declares_people(scenario_inputs(scenario).values()):
        raise ConfigError(
            f"crowd.pedestrians = 0: expected at least 1: the study varies [crowd], but nobody "
            f"walks in {config.scenario} of its own, and every seed would make the same run"
        )
