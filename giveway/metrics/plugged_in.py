"""Metrics of other packages: what they declare, and what they measure of one ego's drive."""

import dataclasses
import math
from dataclasses import dataclass, field
from numbers import Integral, Real
from typing import Any, Protocol

import numpy as np

from giveway.config import RunConfig
from giveway.config.tables.recorded import RECORDED
from giveway.errors import MetricError
from giveway.metrics.dummies import DUMMY, DummyMetric, DummyOptions
from giveway.metrics.ego_fields import EGO_FIELDS
from giveway.metrics.impacts import IMPACTS, ImpactMetric
from giveway.metrics.pedestrians import WALK_SUMMARY_FIELDS
from giveway.metrics.recorded_people import RecordedPeopleMetric
from giveway.plug_ins.faults import blamed, described, shown
from giveway.plug_ins.finding import load_class
from giveway.plug_ins.sockets import METRIC
from giveway.run_data.columns import SUMMARY_HEAD, Column, columns_of

_OURS = (*SUMMARY_HEAD, *EGO_FIELDS, *WALK_SUMMARY_FIELDS)
_TAKEN = {"run": "giveway", "cell": "giveway"} | {column.name: "giveway" for column in _OURS}
"""Owner of each column that the tables of runs and studies already have."""
_EXPECTED = {
    "number": "a finite number, or nan if there is none",
    "integer": "a whole number",
    "boolean": "True or False",
}


class Metric(Protocol):
    """A metric of another package.

    Attributes:
        Columns: Dataclass of ``Annotated[float | int | bool, Quantity(unit, meaning)]``, one
            attribute for each column.
    """

    Columns: type

    def measure(self, drive: Any) -> Any:
        """Return an instance of ``Columns``.

        Args:
            drive: :class:`~giveway.results.ego_result.EgoResult` of one ego, which must not be
                changed.
        """


@dataclass(frozen=True)
class Measured:
    """The measurements of one drive by metrics of other packages.

    Attributes:
        columns: Columns that they add to the summary.
        values: Value of each column by its name; nan if its metric failed.
        faults: Faults of metrics, one sentence each.
    """

    columns: tuple[Column, ...] = ()
    values: dict[str, float] = field(default_factory=dict)
    faults: tuple[str, ...] = ()


@dataclass
class DeclaredMetric:
    """A metric as its package declares it, with the options of the run.

    Attributes:
        name: Name of the metric, as the user wrote it.
        kind: Class of the metric.
        options: Instance of its ``Options``, or None if it has none.
        columns: Columns that it declares.
    """

    name: str
    kind: Any
    options: Any
    columns: tuple[Column, ...]

    def measure(self, drive: Any) -> dict[str, float]:
        """Return the value of each column.

        Args:
            drive: :class:`~giveway.results.ego_result.EgoResult` of one ego.

        Raises:
            MetricError: the metric raised, or its answer cannot be used.
        """
        whose = f"metric '{self.name}' of '{drive.id}'"
        with blamed(whose, MetricError):
            metric = self.kind() if self.options is None else self.kind(self.options)
            answer = metric.measure(drive)
        if not isinstance(answer, self.kind.Columns):
            msg = f"{whose} returned {shown(answer)}: expected an instance of its Columns"
            raise MetricError(msg)
        attributes = dataclasses.fields(self.kind.Columns)
        return {
            column.name: _checked(whose, column, getattr(answer, attribute.name))
            for column, attribute in zip(self.columns, attributes, strict=True)
        }


NOTHING_MEASURED = Measured()
"""Result without metrics of other packages."""


def metric_columns(config: RunConfig) -> tuple[Column, ...]:
    """Return the columns that metrics of other packages add to the summary of a run.

    Args:
        config: Configuration of the run.

    Raises:
        GivewayError: a metric cannot be used, as :func:`declared` tells it.
    """
    return tuple(column for metric in declared(config) for column in metric.columns)


def measured(config: RunConfig, drive: Any) -> Measured:
    """Return the measurements of one ego's drive by the metrics of other packages.

    If a metric fails, only its own columns are lost: the run has been driven, and its other numbers
    do not depend on the metric.

    Args:
        config: Configuration of the run.
        drive: :class:`~giveway.results.ego_result.EgoResult` of the ego.
    """
    columns: list[Column] = []
    values: dict[str, float] = {}
    faults: list[str] = []
    for metric in declared(config):
        columns += metric.columns
        try:
            values |= metric.measure(drive)
        except MetricError as error:
            values |= dict.fromkeys((column.name for column in metric.columns), math.nan)
            faults.append(f"{error}; its columns are empty")
    return Measured(tuple(columns), values, tuple(faults))


def declared(config: RunConfig) -> list[DeclaredMetric]:
    """Return the metrics of a run, each with its columns, in the order of the configuration.

    The first of them are giveway's own, of people who walk as recorded, impacts and dummies.

    Args:
        config: Configuration of the run.

    Raises:
        ConfigError: the options of a metric cannot be used.
        ControlError: a metric is not installed, or cannot be imported.
        MetricError: a metric declares no columns, or one that another metric or giveway has.
    """
    found: list[DeclaredMetric] = []
    owners = dict(_TAKEN)
    dummy = config.metrics.dummy
    size = None if dummy is None else DummyOptions(dummy)
    for name, kind, wanted, own in (
        (RECORDED, RecordedPeopleMetric, config.crowd.model == RECORDED, None),
        (IMPACTS, ImpactMetric, config.metrics.impacts, None),
        (DUMMY, DummyMetric, dummy is not None, size),
    ):
        if wanted:
            ours = columns_of(kind.Columns)
            owners |= {column.name: "giveway" for column in ours}
            found.append(DeclaredMetric(name, kind, own, ours))
    for name, settings in config.metrics.plugged_in.items():
        kind, options = load_class(name, METRIC, settings)
        if not callable(getattr(kind, METRIC.method, None)):
            raise MetricError(
                f"{METRIC.setting} = '{name}': {shown(kind)} has no method {METRIC.method}; "
                "expected a class with one (docs/plugins.md)"
            )
        metric = DeclaredMetric(name, kind, options, _columns(name, kind))
        for column in metric.columns:
            if column.name in owners:
                raise MetricError(
                    f"{METRIC.setting} = '{name}': column '{column.name}': "
                    f"{owners[column.name]} has a column of this name already; choose another name"
                )
            owners[column.name] = f"'{name}'"
        found.append(metric)
    return found


def _columns(name: str, kind: Any) -> tuple[Column, ...]:
    """Return the columns that the class of a metric declares."""
    table = getattr(kind, "Columns", None)
    try:
        if not (isinstance(table, type) and dataclasses.is_dataclass(table)):
            raise TypeError(f"Columns = {shown(table)}")
        columns = columns_of(table)
        if not columns or any(column.type not in _EXPECTED for column in columns):
            raise TypeError("no column, or one that holds no number")
        if not {column.better for column in columns} <= {None, "lower", "higher"}:
            raise TypeError("better is neither 'lower' nor 'higher'")
    except Exception as error:
        raise MetricError(
            f"{METRIC.setting} = '{name}': {described(error).partition(' (')[0]}: expected "
            "Columns, a dataclass whose attributes are all Annotated[float, int or bool, "
            "Quantity(unit, meaning)] (docs/plugins.md)"
        ) from error
    return columns


def _checked(whose: str, column: Column, value: Any) -> float:
    """Return the value of a column in Python's own type."""
    is_truth = isinstance(value, bool | np.bool_)
    if column.type == "boolean" and is_truth:
        return bool(value)
    if column.type == "integer" and isinstance(value, Integral) and not is_truth:
        return int(value)
    is_number = column.type == "number" and isinstance(value, Real) and not is_truth
    if is_number and not math.isinf(number := float(value)):
        return number
    raise MetricError(
        f"{whose} returned {column.name} = {shown(value)}: expected {_EXPECTED[column.type]}"
    )
