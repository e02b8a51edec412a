"""Sequential stopping: whether the seeds so far determine the mean difference precisely enough.

The intervals have a fixed width: Chow & Robbins 1965, Ann. Math. Stat. 36, 457-462; for simulation
Glynn & Whitt 1992, Ann. Appl. Probab. 2, 180-198. The rule is applied to the first k seeds only, at
k = minimum, minimum + batch, ..., so that neither the number of workers nor the order in which runs
end can change the stop.
"""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from giveway.studies.contexts import other_factors
from giveway.studies.definition import Comparison, Precision
from giveway.studies.design import Design
from giveway.studies.statistics.comparing import differences, interval
from giveway.studies.statistics.metrics import metric
from giveway.studies.statistics.pairs import Pairs, paired
from giveway.studies.statistics.rounding import mean, tabulated
from giveway.studies.table_columns import PRECISION_COLUMNS, numbers_of


def looks(precision: Precision, replications: int) -> Iterator[int]:
    """Yield the numbers of seeds at which to check: minimum, minimum + batch, ..., and all."""
    seeds = min(precision.minimum, replications)
    while seeds < replications:
        yield seeds
        seeds += precision.batch
    yield replications


def precise_enough(
    runs: pd.DataFrame,
    design: Design,
    comparison: Comparison,
    precision: Precision,
    *,
    seeds: int | None = None,
) -> tuple[bool, pd.DataFrame]:
    """Return whether the interval is narrow enough for every context, ego and treatment.

    Args:
        runs: Table with a row per run and ego, as ``runs.csv``, from the study's first seed on.
            Runs of later seeds than the check's do not count.
        design: Design of the study.
        comparison: Compared factor, its baseline, and the confidence.
        precision: Metric, situation, largest width, and the numbers of seeds at which to check.
        seeds: Number of first seeds that count, from :func:`looks`. With None it is the last of
            these numbers for which every cell has all runs.

    Returns:
        The answer, and a table with a row per context, ego and treatment (the context's factors,
        then ``PRECISION_COLUMNS``). Before the first check, the answer is False and the table is
        empty. A situation with fewer pairs than ``minimum_pairs`` has no interval, and is not
        precise.

    Raises:
        ConfigError: the study has no such factor, level or metric.
    """
    wanted = metric(precision.metric)
    names = [*other_factors(design, comparison), *(column.name for column in PRECISION_COLUMNS)]
    whole = _whole_seeds(runs, len(design.cells))
    look = _last_look(len(whole), precision) if seeds is None else seeds
    chosen = whole[:look] if len(whole) >= look else []
    first = runs[runs["seed"].isin(chosen)]
    rows = []
    for pairs in paired(first, design, comparison):
        found = _row(pairs, comparison, precision)
        rows.append(found | {"unit": wanted.unit, "seeds": look})
    frame = pd.DataFrame(rows, columns=names)
    enough = bool(rows) and all(bool(row["precise"]) for row in rows)
    return enough, tabulated(frame, numbers_of(PRECISION_COLUMNS))


def _whole_seeds(runs: pd.DataFrame, cells: int) -> list[int]:
    """Return the seeds, from the first one on without a gap, of which every cell has a run."""
    cells_run = runs.groupby("seed")["cell"].nunique()
    whole: list[int] = []
    for seed, count in cells_run.items():
        if count < cells or (whole and seed != whole[-1] + 1):
            break
        whole.append(int(str(seed)))
    return whole


def _last_look(finished: int, precision: Precision) -> int:
    batches = max(0, finished - precision.minimum) // precision.batch
    return precision.minimum + batches * precision.batch


def _row(pairs: Pairs, comparison: Comparison, precision: Precision) -> dict[str, object]:
    name, situation = precision.metric, precision.situation
    found = differences(pairs, name, situation)
    row: dict[str, object] = {
        **pairs.row,
        "situation": situation,
        "metric": name,
        "n": len(found),
        "mean_difference": np.nan,
        "ci_low": np.nan,
        "ci_high": np.nan,
        "width": np.nan,
        "wanted": precision.width,
        "precise": False,
    }
    if len(found) < comparison.minimum_pairs:
        return row
    between = interval(found, pairs, name, situation, comparison)
    return row | {
        "mean_difference": mean(found.values),
        "ci_low": between.low,
        "ci_high": between.high,
        "width": between.width,
        "precise": between.width < precision.width,
    }
