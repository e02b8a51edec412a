"""A study's folder, read: its definition, its records, its tables."""

from __future__ import annotations

import json
from collections import defaultdict
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from giveway.errors import ResultsError
from giveway.studies.definition import StudyDefinition, parse_definition
from giveway.studies.design import Cell, Design, design
from giveway.studies.frames import cells_frame, execution_frame, failures_frame, runs_frame
from giveway.studies.identity import run_key
from giveway.studies.statistics import compare, situations
from giveway.studies.store import RecordStore

if TYPE_CHECKING:
    from giveway.studies.record import RunRecord

DEFINITION = "study.toml"
MANIFEST = "manifest.json"


class StudyFolder:
    """What a study has left, or has so far.

    Args:
        path: its folder.

    Attributes:
        path: its folder.
        definition: as it was run.
        design: its factors and cells.
        manifest: software, input files, the cells' digests.

    Raises:
        ResultsError: there is no study.
    """

    path: Path
    definition: StudyDefinition
    design: Design
    manifest: dict[str, Any]

    def __init__(self, path: Path) -> None:
        self.path = path
        self._store = RecordStore(path)
        origin = str(path / DEFINITION)
        try:
            text = (path / DEFINITION).read_text(encoding="utf-8")
            self.manifest = json.loads((path / MANIFEST).read_text(encoding="utf-8"))
            self._digests = {cell["cell"]: cell["digest"] for cell in self.manifest["cells"]}
            self._seeds = int(self.manifest["seeds"])
        except (OSError, ValueError, KeyError, TypeError):
            msg = (
                f"{path}: no study there ({DEFINITION} and {MANIFEST} that giveway wrote); "
                "name the folder that giveway study printed"
            )
            raise ResultsError(msg) from None
        self.definition = parse_definition(text, origin, path.absolute())
        self.design = design(self.definition, origin)

    @classmethod
    def open(cls, path: str | Path) -> StudyFolder:
        """The study in ``path``."""
        return cls(Path(path))

    @property
    def seeds(self) -> range:
        """The seeds that were asked for, or were enough."""
        first = self.definition.first_seed
        return range(first, first + self._seeds)

    @property
    def planned(self) -> int:
        """How many runs it has when it is complete."""
        return len(self.seeds) * len(self.design.cells)

    @cached_property
    def records(self) -> list[tuple[Cell, int, RunRecord]]:
        """Every finished run with its cell and seed, cell by cell."""
        found = []
        for cell in self.design.cells:
            for seed in self.seeds:
                record = self._store.get(run_key(self._digests[cell.number], seed))
                if record is not None:
                    found.append((cell, seed, record))
        return found

    @cached_property
    def runs(self) -> pd.DataFrame:
        """One row per run and ego."""
        return runs_frame(self.records, self.design)

    @cached_property
    def cells(self) -> pd.DataFrame:
        """One row per cell."""
        by_cell: defaultdict[int, list[RunRecord]] = defaultdict(list)
        for cell, _, record in self.records:
            by_cell[cell.number].append(record)
        return cells_frame(self.design.cells, by_cell)

    @cached_property
    def comparison(self) -> pd.DataFrame:
        """Paired differences: one row per context, ego, treatment, situation and metric."""
        kept = self._kept("comparison")
        if kept is not None:
            return kept
        return compare(self.runs, self.design, self.definition.comparison)

    @cached_property
    def situations(self) -> pd.DataFrame:
        """How often both sides, one side or neither stopped."""
        return situations(self.runs, self.design, self.definition.comparison)

    @cached_property
    def failures(self) -> pd.DataFrame:
        """The runs without a result."""
        return failures_frame(self.records, f"giveway rerun {self.path}")

    @cached_property
    def execution(self) -> pd.DataFrame:
        """How each run was computed."""
        return execution_frame(record for _, _, record in self.records)

    def cell_of(self, run_id: str) -> tuple[Cell, int]:
        """The cell and the seed of a run.

        Raises:
            ResultsError: this study has no such run.
        """
        number, _, seed = run_id.removeprefix("c").partition("-s")
        if number.isdecimal() and seed.isdecimal():
            cell = next((c for c in self.design.cells if c.number == int(number)), None)
            if cell is not None and int(seed) in self.seeds:
                return cell, int(seed)
        last = f"c{len(self.design.cells)}-s{self.seeds[-1]}"
        msg = (
            f"run '{run_id}': not in {self.path}; expected c<cell>-s<seed>, "
            f"c1-s{self.seeds[0]} to {last}: see runs.csv"
        )
        raise ResultsError(msg)

    def record(self, run_id: str) -> RunRecord | None:
        """What is kept of a run; None: it has not been made.

        Raises:
            ResultsError: this study has no such run.
        """
        cell, seed = self.cell_of(run_id)
        return self._store.get(run_key(self._digests[cell.number], seed))

    def _kept(self, name: str) -> pd.DataFrame | None:
        """A table that takes long to make, as it was written; None: not there."""
        path = self.path / f"{name}.csv"
        if not path.is_file():
            return None
        context = [f.name for f in self.design.factors if f.unit is None]
        texts = dict.fromkeys((*context, "ego", "treatment", "baseline"), str)
        try:
            return pd.read_csv(path, dtype=texts, keep_default_na=False, na_values=[""])
        except (OSError, ValueError):
            return None
