"""The record of one run in a study: its summary rows, or the reason why it has none."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from typing import Any

from giveway.config import RunConfig
from giveway.run_data.columns import Column

Scalar = str | bool | int | float

CRASHED = "crashed"
FAILED = "failed"


def run_id(cell: int, seed: int) -> str:
    """Return the name of a run within its study: ``c2-s17`` is seed 17 in cell 2."""
    return f"c{cell}-s{seed}"


@dataclass(frozen=True)
class Task:
    """A run to be made, in any process, on any machine.

    Attributes:
        run: Id of the run in its study, such as ``c2-s17`` (cell 2, seed 17).
        key: Hash of everything that can change a number of the run.
        config: Effective configuration as JSON.
        inputs: SHA-256 of each input file, by its name; a worker on another machine checks them.
        software: Identity of the code that planned it; a worker must be the same.
        versions: Versions behind this identity, for messages.
    """

    run: str
    key: str
    config: str
    inputs: dict[str, str]
    software: str
    versions: dict[str, str] = field(default_factory=dict)

    @cached_property
    def run_config(self) -> RunConfig:
        """Return the configuration, which is read once."""
        return RunConfig.model_validate_json(self.config)


@dataclass(frozen=True)
class Computing:
    """The execution of a run, which may differ between two equal studies.

    Attributes:
        seconds: Wall clock time [s] of the run, with set-up and metrics.
        attempts: Number of attempts.
        retried: Reason why the run was made once more, or "" if it was not.
        worker: Host and process id.
        processor: Name of the processor.
        memory: Memory [MB] that the worker holds after the run.
        control_median: Median time [ms] of a control step, for prediction and controller.
        control_max: Largest time [ms] of a control step. The first step is left out of both.
        twin: Part of the seconds for the follow-up and the counterfactual run; nan without one.
    """

    seconds: float = math.nan
    attempts: int = 1
    retried: str = ""
    worker: str = ""
    processor: str = ""
    memory: float = math.nan
    control_median: float = math.nan
    control_max: float = math.nan
    twin: float = math.nan


@dataclass(frozen=True)
class RunRecord:
    """The record of one finished run.

    Attributes:
        run: Id of the run in its study.
        key: Hash of everything that can change a number of the run.
        ending: Ending as in the summary: completed, time limit, ..., failed, crashed.
        rows: Rows with the columns of ``summary.csv``, one per ego, or one without egos.
        remarks: Remarks on what is unusual about the run.
        failure: Reason and place of a failure or crash, in one line; empty if it did not fail.
        computing: Execution of the run.
        columns: Columns of the rows that metrics of other packages have added.
    """

    run: str
    key: str
    ending: str
    rows: tuple[dict[str, Scalar], ...] = ()
    remarks: tuple[str, ...] = ()
    failure: str = ""
    computing: Computing = field(default_factory=Computing)
    columns: tuple[Column, ...] = ()

    @property
    def failed(self) -> bool:
        """True if the run has no result."""
        return bool(self.failure)

    def called(self, run: str) -> RunRecord:
        """Return the same record under the name that the run has in the present study.

        Cells with equal settings share their records, and an additional level changes the numbers
        of cells.
        """
        return self if self.run == run else replace(self, run=run)

    def to_json(self) -> str:
        """Return the record as one line of JSON, in which nan becomes null."""
        values = asdict(self)
        if not self.columns:
            del values["columns"]
        return json.dumps(_plain(values), ensure_ascii=False, allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> RunRecord:
        """Return the record from the text of :meth:`to_json`.

        Raises:
            ValueError: the text is not a record.
        """
        return cls.from_values(json.loads(text))

    @classmethod
    def from_values(cls, values: dict[str, Any]) -> RunRecord:
        """Return the record from JSON values that have been read already; ``values`` is emptied.

        Raises:
            ValueError: they are not the values of a record.
        """
        try:
            computing = Computing(**{k: _number(v) for k, v in values.pop("computing").items()})
            rows = tuple({k: _number(v) for k, v in row.items()} for row in values.pop("rows"))
            remarks = tuple(values.pop("remarks"))
            columns = tuple(Column(**column) for column in values.pop("columns", ()))
            values |= {"rows": rows, "remarks": remarks, "columns": columns}
            return cls(computing=computing, **values)
        except (TypeError, KeyError, AttributeError) as error:
            raise ValueError(f"not a run's record: {error}") from error


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _number(value: Any) -> Any:
    return math.nan if value is None else value
