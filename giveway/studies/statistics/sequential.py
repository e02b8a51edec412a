"""Sequential stopping: whether the seeds so far tell the mean difference well enough.

Fixed-width sequential intervals: Chow & Robbins 1965, Ann. Math. Stat. 36, 457-462; for
simulation Glynn & Whitt 1992, Ann. Appl. Probab. 2, 180-198. The rule looks at the first k seeds
only, at k = minimum, minimum + batch, ..., so that neither the number of workers nor the order in
which runs end can move the stop.
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
    """Return the numbers of seeds after which to look: minimum, minimum + batch, ..., and all."""
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
    """True if the interval is narrow enough in every context, for every ego and treatment.

    Args:
        runs: A row per run and ego, as ``runs.csv``, from the study's first seed on; runs beyond
            the look do not matter.
        design: Design of the study.
        comparison: Compared factor, its baseline, and the confidence.
        precision: Metric, situation, width to reach, and when to look.
        seeds: Number of first seeds to look at, from :func:`looks`. None: as many as the
            last look at which every cell has a run of each.

    Returns:
        The answer, and a row per context, ego and treatment (the context's factors, then
        ``PRECISION_COLUMNS``). Before the look there are no rows, and the answer is no; a
        situation with fewer pairs than ``minimum_pairs`` has no interval, and is not precise.

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
    """The seeds, from the first one on without a gap, of which every cell has a run."""
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
