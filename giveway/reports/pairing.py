"""Pairs of runs by their ids: one crowd, met once with the treatment and once with the baseline.

The statistics look at the same pairs as arrays; a report also wants to know which runs they are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from giveway.reports.study import baseline_label, contexts
from giveway.studies.statistics import METRICS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from giveway.reports.study import Study

NUMBERS = tuple(metric.name for metric in METRICS)
BASELINE = "_baseline"
DIFFERENCE = "_difference"
_KEYS = ["ego", "seed"]
_HEAD = ("context", "short_context", "ego", "treatment", "baseline", "seed", "run", "run_baseline")


def paired(study: Study) -> pd.DataFrame:
    """One row per pair of runs that differ in nothing but the level that is compared.

    Pairs stand in the order of contexts, egos, treatments and seeds.

    Returns:
        A frame with ``context`` and ``short_context`` (labels), ``ego``, ``treatment``,
        ``baseline`` (labels), ``seed``, ``run`` and ``run_baseline`` (ids), ``situation``
        ("stop-and-wait": both stopped, "non-stop": neither did, or empty), and for each metric
        three columns: the treatment's number, the baseline's, and the difference.
    """
    runs = study.runs.assign(ego=study.runs["ego"].fillna("").astype(str))
    for name in NUMBERS:
        runs[name] = pd.to_numeric(runs[name], errors="coerce").astype(float)
    by_cell = dict(iter(runs.groupby("cell", sort=False)))
    baseline = baseline_label(study)
    tables = []
    for context in contexts(study):
        right = by_cell.get(context.cells.get(baseline, -1))
        for label, cell in context.cells.items():
            left = by_cell.get(cell)
            if label == baseline or left is None or right is None:
                continue
            merged = left.merge(right, on=_KEYS, suffixes=("", BASELINE)).sort_values(_KEYS)
            names = {"context": context.label, "short_context": context.short}
            merged = merged.assign(**names, treatment=label, baseline=baseline)
            tables.append(_columns(merged))
    tables = [table for table in tables if len(table)]
    if not tables:
        return _columns(_nothing())
    return pd.concat(tables, ignore_index=True)


def situation_of(pairs: pd.DataFrame, situation: str) -> pd.DataFrame:
    """The pairs of a situation; "general" are all."""
    return pairs if situation == "general" else pairs[pairs["situation"] == situation]


def _columns(merged: pd.DataFrame) -> pd.DataFrame:
    columns: dict[str, object] = {name: merged[name] for name in _HEAD}
    columns["situation"] = _situations(merged)
    for name in NUMBERS:
        columns |= {name: merged[name], name + BASELINE: merged[name + BASELINE]}
        columns[name + DIFFERENCE] = merged[name] - merged[name + BASELINE]
    return pd.DataFrame(columns).reset_index(drop=True)


def _situations(merged: pd.DataFrame) -> NDArray[np.str_]:
    """Yang & Özgüner 2019, section 5: both stop and wait, or neither does."""
    here, there = (merged[name].to_numpy(float) for name in ("stops", "stops" + BASELINE))
    both, neither = (here >= 1) & (there >= 1), (here == 0) & (there == 0)
    return np.where(both, "stop-and-wait", np.where(neither, "non-stop", ""))


def _nothing() -> pd.DataFrame:
    numbers = [name + end for name in NUMBERS for end in ("", BASELINE)]
    return pd.DataFrame(
        {name: pd.Series(dtype=object) for name in _HEAD}
        | {name: pd.Series(dtype=float) for name in numbers}
    )
