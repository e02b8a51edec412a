"""The record of one run in a study: its summary rows, or why it has none."""

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
    """One run to be made, in any process, on any machine.

    Attributes:
        run: Id in its study, such as ``c2-s17`` (cell 2, seed 17).
        key: Content hash of everything that can change a number of it.
        config: The effective configuration as JSON.
        inputs: SHA-256 of each input file, by its name; a worker on another machine checks them.
        software: Identity of the code that planned it; a worker must be the same.
    """

    run: str
    key: str
    config: str
    inputs: dict[str, str]
    software: str

    @cached_property
    def run_config(self) -> RunConfig:
        """The configuration, read once."""
        return RunConfig.model_validate_json(self.config)


@dataclass(frozen=True)
class Computing:
    """The execution of a run, which may differ between two equal studies.

    Attributes:
        seconds: Wall clock of the run, set-up and metrics included.
        attempts: Number of attempts.
        worker: Host and process id.
        memory: Resident set of the worker after the run [MB].
        control_median: Median time of one control step, prediction and controller [ms].
        control_max: The longest one [ms]; the run's first step is left out of both.
        twin: Part of the seconds spent on following the run and on its twin; nan without a twin.
    """

    seconds: float = math.nan
    attempts: int = 1
    worker: str = ""
    memory: float = math.nan
    control_median: float = math.nan
    control_max: float = math.nan
    twin: float = math.nan


@dataclass(frozen=True)
class RunRecord:
    """One finished run.

    Attributes:
        run: Id in its study.
        key: Content hash of everything that can change a number of it.
        ending: Ending as in the summary: completed, time limit, ..., failed, crashed.
        rows: One per ego: the columns of ``summary.csv``; one row of the run's head without egos.
        remarks: notes on what is unusual about the run.
        failure: One line: why it failed or crashed, and where; empty if it did not.
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
        """True if it has no result."""
        return bool(self.failure)

    def called(self, run: str) -> RunRecord:
        """The same record under another name: as the study numbers its cells now.

        Cells with equal settings share their records, and a level that is added moves numbers.
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
        """The record that :meth:`to_json` has written.

        Raises:
            ValueError: the text is not one.
        """
        return cls.from_values(json.loads(text))

    @classmethod
    def from_values(cls, values: dict[str, Any]) -> RunRecord:
        """Make the record from JSON that has been read already, and empty ``values``.

        Raises:
            ValueError: they are not those of a record.
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
