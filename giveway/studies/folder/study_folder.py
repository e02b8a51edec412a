"""A study's folder as it is read: its definition, its records, its tables."""

from __future__ import annotations

import re
import shlex
from collections import defaultdict
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

from giveway.config.files.layers import Layer
from giveway.errors import ResultsError
from giveway.gate import LARGEST_TABLE, opened, read_text
from giveway.run_data.columns import Column
from giveway.studies.definition import StudyDefinition, parse_definition
from giveway.studies.design import Cell, Design, design
from giveway.studies.folder.folder_contents import (
    DEFINITION,
    MANIFEST,
    intact_tables,
    read_manifest,
    require_definition,
)
from giveway.studies.folder.frames import (
    cells_frame,
    computing_frame,
    execution_frame,
    failures_frame,
    measured_columns,
    runs_columns,
    runs_frame,
)
from giveway.studies.folder.store import RecordStore
from giveway.studies.identity import run_key
from giveway.studies.record import RunRecord, run_id
from giveway.studies.statistics import (
    COMPARISON_COLUMNS,
    Metric,
    compare,
    compared,
    fronts,
    levels,
    situations,
)

_RUN = re.compile(r"c([1-9][0-9]*)-s(0|[1-9][0-9]*)")


class StudyFolder:
    """The files that a study has written so far.

    Args:
        path: Path of the folder.

    Attributes:
        path: Path of the folder.
        definition: Definition of the study as it was run.
        design: Factors and cells of the study.
        manifest: Contents of the manifest: software, input files, the cells' digests.

    Raises:
        ResultsError: there is no study, or only one that was killed before it began.
        BrokenFileError: definition or manifest differ from what was written.
    """

    path: Path
    definition: StudyDefinition
    design: Design
    manifest: dict[str, Any]

    def __init__(self, path: Path) -> None:
        self.path = path
        origin = str(path / DEFINITION)
        try:
            text = read_text(path / DEFINITION)
            self.manifest = read_manifest(path)
            by_seals = self.manifest["identity"] if "definition" in self.manifest else None
            self._store = RecordStore(path, by_seals)
            cells = self.manifest["cells"]
            self._digests: dict[int, str] = {cell["cell"]: cell["digest"] for cell in cells}
            labels: dict[int, str] = {cell["cell"]: cell["label"] for cell in cells}
            self._seeds = int(self.manifest["seeds"])
        except (OSError, KeyError, TypeError):
            raise ResultsError(
                f"{path}: no study there ({DEFINITION} and {MANIFEST} that giveway wrote); "
                "name the folder that giveway study printed"
            ) from None
        require_definition(path, self.manifest)
        self.definition = parse_definition(text, origin, path.absolute())
        self.design = design(self.definition, origin)
        if labels != {cell.number: cell.label for cell in self.design.cells}:
            raise ResultsError(
                f"{path}: {MANIFEST} lists other cells than {DEFINITION}, as after a kill in the "
                "very beginning; go on with giveway study and --resume"
            )

    def __repr__(self) -> str:
        made, cells = len(self.records), len(self.design.cells)
        return f"<StudyFolder {self.path}: {cells} cells, {made} of {cells * self._seeds} runs>"

    @classmethod
    def open(cls, path: str | Path) -> StudyFolder:
        """Open the study in ``path``."""
        return cls(Path(path))

    @property
    def seeds(self) -> range:
        """The seeds of every cell: all that were requested, or as many as were enough."""
        first = self.definition.first_seed
        return range(first, first + self._seeds)

    @property
    def complete(self) -> bool:
        """True if the tables in the folder cover all runs."""
        return bool(self.manifest.get("complete"))

    @property
    def planned(self) -> int:
        """The number of runs of the complete study."""
        return len(self.seeds) * len(self.design.cells)

    @cached_property
    def records(self) -> list[tuple[Cell, int, RunRecord]]:
        """Return every finished run with its cell and seed, cell by cell."""
        found = []
        for cell in self.design.cells:
            for seed in self.seeds:
                record = self._kept_record(cell, seed)
                if record is not None:
                    found.append((cell, seed, record))
        return found

    @cached_property
    def measured(self) -> tuple[Column, ...]:
        """The columns that metrics of other packages have added."""
        return measured_columns(record for *_, record in self.records)

    @property
    def metrics(self) -> tuple[Metric, ...]:
        """The metrics that the study compares."""
        return compared(self.measured)

    @property
    def runs_columns(self) -> tuple[Column, ...]:
        """The columns of :attr:`runs`."""
        return runs_columns(self.design, self.measured)

    @cached_property
    def runs(self) -> pd.DataFrame:
        """The table with one row per run and ego."""
        return runs_frame(self.records, self.design)

    @cached_property
    def cells(self) -> pd.DataFrame:
        """The table with one row per cell."""
        return cells_frame(self.design.cells, self._by_cell)

    @cached_property
    def levels(self) -> pd.DataFrame:
        """The means of every level: one row per cell, ego and metric."""
        return levels(self.runs, self.design, self.definition.comparison, self.metrics)

    @cached_property
    def fronts(self) -> pd.DataFrame:
        """The costs to ego and people: one row per cell and ego with a counterfactual run."""
        return fronts(self.levels, self.design, self.definition.comparison)

    @cached_property
    def computing(self) -> pd.DataFrame:
        """The computing time of runs and control steps: one row per cell."""
        return computing_frame(self.design.cells, self._by_cell)

    @cached_property
    def _by_cell(self) -> dict[int, list[RunRecord]]:
        by_cell: defaultdict[int, list[RunRecord]] = defaultdict(list)
        for cell, _, record in self.records:
            by_cell[cell.number].append(record)
        return by_cell

    @cached_property
    def comparison(self) -> pd.DataFrame:
        """The paired differences: one row per context, ego, treatment, situation and metric."""
        kept = self._kept_comparison()
        if kept is not None:
            return kept
        return compare(self.runs, self.design, self.definition.comparison, self.metrics)

    @cached_property
    def situations(self) -> pd.DataFrame:
        """The numbers of pairs in which both runs, one run or neither stopped."""
        return situations(self.runs, self.design, self.definition.comparison)

    @cached_property
    def failures(self) -> pd.DataFrame:
        """The runs without a result."""
        return failures_frame(self.records, f"giveway rerun {shlex.quote(str(self.path))}")

    @cached_property
    def execution(self) -> pd.DataFrame:
        """The execution of each run."""
        return execution_frame(record for _, _, record in self.records)

    def cell_of(self, run: str) -> tuple[Cell, int]:
        """Return the cell and the seed of a run.

        Raises:
            ResultsError: this study has no such run.
        """
        parts = _RUN.fullmatch(run)
        if parts is not None:
            number, seed = map(int, parts.groups())
            cell = next((c for c in self.design.cells if c.number == number), None)
            if cell is not None and seed in self.seeds:
                return cell, seed
        first = run_id(1, self.seeds[0])
        last = run_id(len(self.design.cells), self.seeds[-1])
        raise ResultsError(
            f"run '{run}': not in {self.path}; expected c<cell>-s<seed>, "
            f"{first} to {last}: see runs.csv"
        )

    def layer_of(self, run: str) -> Layer:
        """Return the settings of a run.

        Raises:
            ResultsError: this study has no such run.
        """
        cell, seed = self.cell_of(run)
        layer = cell.layer(str(self.path / DEFINITION), self.definition)
        return replace(layer, values={**layer.values, "seed": seed})

    def record(self, run: str) -> RunRecord | None:
        """Return the record of a run, or None if the run has not been made.

        Raises:
            ResultsError: this study has no such run.
        """
        return self._kept_record(*self.cell_of(run))

    def key_of(self, run: str) -> str:
        """Return the key of a run's record, which depends on settings, input files and code.

        Raises:
            ResultsError: this study has no such run.
        """
        cell, seed = self.cell_of(run)
        return run_key(self._digests[cell.number], seed)

    def _kept_record(self, cell: Cell, seed: int) -> RunRecord | None:
        record = self._store.get(run_key(self._digests[cell.number], seed))
        return None if record is None else record.called(run_id(cell.number, seed))

    def _kept_comparison(self) -> pd.DataFrame | None:
        """Read ``comparison.csv``, which takes long to compute.

        The result is None if the file does not cover all runs.
        """
        path = self.path / "comparison.csv"
        if not self.complete or path.name not in intact_tables(self.path):
            return None
        columns = (*runs_columns(self.design), *COMPARISON_COLUMNS)
        texts = {column.name for column in columns if column.type == "string"}
        try:
            with opened(path, largest=LARGEST_TABLE) as stream:
                frame = pd.read_csv(
                    stream, dtype=dict.fromkeys(texts, str), keep_default_na=False, na_values=[""]
                )
        except (OSError, ValueError):
            return None
        empty = dict.fromkeys(texts & set(frame.columns), "")  # there is no ego or no unit
        return frame.fillna(empty)
