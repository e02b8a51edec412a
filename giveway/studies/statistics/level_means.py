"""The numbers of every level: the mean of each metric over the runs of each cell."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from giveway.geometry.kernel import Array
from giveway.studies.definition import Comparison
from giveway.studies.design import Cell, Design
from giveway.studies.statistics.bootstrap import mean_interval, seed_of, side_by_side
from giveway.studies.statistics.metrics import METRICS, Metric
from giveway.studies.statistics.pairs import cleaned, without_result
from giveway.studies.statistics.rounding import mean, tabulated
from giveway.studies.table_columns import LEVEL_COLUMNS, numbers_of


def levels(
    runs: pd.DataFrame,
    design: Design,
    comparison: Comparison,
    metrics: Sequence[Metric] = METRICS,
) -> pd.DataFrame:
    """Return ``levels.csv``: the mean of every metric in every cell, with its interval.

    A level's mean, unlike a difference, depends on how hard the crowds are. Therefore its interval
    is wider, and two levels whose intervals overlap may still differ pair by pair.

    Args:
        runs: Table with a row per run and ego, as ``runs.csv``.
        design: Design of the study.
        comparison: Confidence of the intervals. Fewer runs than ``minimum_pairs`` have no interval.
        metrics: Metrics whose means are computed.

    Returns:
        Table with a row per cell, ego and metric, in this order. Its columns are the factors, then
        ``LEVEL_COLUMNS``. A cell without any result has no row.
    """
    frame = cleaned(runs, metrics)
    frame = frame[~without_result(frame)]
    tables = dict(iter(frame.groupby(["cell", "ego"])))
    wanted = [
        (cell, str(ego), metric, table)
        for cell in design.cells
        for (number, ego), table in tables.items()
        if number == cell.number
        for metric in metrics
    ]

    def row(of: tuple[Cell, str, Metric, pd.DataFrame]) -> dict[str, object]:
        cell, ego, metric, table = of
        values = table[metric.name].to_numpy(np.float64)
        found = _row(cell, ego, metric.name, values, comparison)
        found |= _slowed(cell, ego, metric.name, table, comparison)
        return found | {"unit": metric.unit}

    rows = side_by_side(row, wanted)
    names = [factor.name for factor in design.factors]
    frame = pd.DataFrame(rows, columns=[*names, *(column.name for column in LEVEL_COLUMNS)])
    return tabulated(frame, numbers_of(LEVEL_COLUMNS))


def _slowed(
    cell: Cell, ego: str, name: str, table: pd.DataFrame, comparison: Comparison
) -> dict[str, object]:
    """Return the columns for the runs in which people slowed the ego."""
    which = table["slowed"].to_numpy(np.float64)
    values = table[name].to_numpy(np.float64)[which == 1.0]
    alone = _row(cell, ego, name, values, comparison)
    known = np.isfinite(which)
    share = {"share_slowed": mean(which[known])} if known.any() else {}
    kept = ("n", "mean", "ci_low", "ci_high")
    return share | {f"slowed_{key}": alone[key] for key in kept if key in alone}


def _row(
    cell: Cell, ego: str, name: str, values: Array, comparison: Comparison
) -> dict[str, object]:
    known = values[np.isfinite(values)]
    row: dict[str, object] = {factor: level.value for factor, level in cell.levels.items()}
    row |= {"ego": ego, "metric": name, "runs": values.size, "n": known.size, "interval": ""}
    if not known.size:
        return row
    row |= {"mean": mean(known), "smallest": known.min(), "largest": known.max()}
    if known.size < comparison.minimum_pairs:
        return row
    between = mean_interval(
        known,
        confidence=comparison.confidence,
        resamples=comparison.resamples,
        seed=seed_of((cell.label, ego, name)),
    )
    return row | {"ci_low": between.low, "ci_high": between.high, "interval": between.method}
