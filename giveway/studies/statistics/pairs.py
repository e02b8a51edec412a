"""Pairs of runs on the same crowd, from which all differences are computed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.studies.contexts import Context, baseline_level, contexts
from giveway.studies.definition import Comparison
from giveway.studies.design import Design
from giveway.studies.record import CRASHED, FAILED, Scalar
from giveway.studies.statistics.metrics import METRICS, Metric

_SLOWED = "slowed"  # Column that tells whether people ever slowed the ego


@dataclass(frozen=True)
class Pairs:
    """One ego's runs under two levels, seed by seed, with everything else equal.

    Attributes:
        context: Level of each other factor.
        ego: Id of the ego in SUMO; empty in runs without an ego.
        treatment: Label of the level that is compared.
        baseline: Label of the level that is subtracted.
        seeds: Seeds of the pairs (n,).
        treated: Metrics of the treatment's runs (n, metrics), nan where there is no number.
        based: Metrics of the baseline's runs (n, metrics); row i of both has seed i.
        metrics: Names of the columns of both.
    """

    context: Context
    ego: str
    treatment: str
    baseline: str
    seeds: NDArray[np.int64]
    treated: Array
    based: Array
    metrics: tuple[str, ...]

    def __len__(self) -> int:
        """The number of pairs."""
        return len(self.treated)

    def of(self, name: str) -> tuple[Array, Array]:
        """Return both sides (n,) of one metric."""
        place = self.metrics.index(name)
        return self.treated[:, place], self.based[:, place]

    @property
    def names(self) -> tuple[str, ...]:
        """The names that identify these pairs.

        They are the same if treatment and baseline are swapped.
        """
        context = (f"{name}={level.value}" for name, level in self.context.levels.items())
        return (*context, self.ego, *sorted((self.treatment, self.baseline)))

    @property
    def row(self) -> dict[str, Scalar]:
        """Return the columns that name the pairs in a table."""
        compared = {"ego": self.ego, "treatment": self.treatment, "baseline": self.baseline}
        return {name: level.value for name, level in self.context.levels.items()} | compared


@dataclass(frozen=True)
class _Side:
    """One ego's runs in one cell, in the order of their seeds."""

    seeds: NDArray[np.int64]
    values: Array


def paired(
    runs: pd.DataFrame,
    design: Design,
    comparison: Comparison,
    metrics: Sequence[Metric] = METRICS,
) -> Iterator[Pairs]:
    """Yield all pairs, by context in the design's order, then by ego, then by treatment.

    A run that failed or crashed belongs to each ego of its context. Levels without a common seed
    have no pairs.

    Args:
        runs: Table with a row per run and ego, as ``runs.csv``.
        design: Design of the study.
        comparison: Compared factor and its baseline.
        metrics: Metrics that are compared.

    Raises:
        ConfigError: the study has no such factor, or the factor no such level.
    """
    compared = design.factor(comparison.factor).levels
    baseline = baseline_level(design, comparison)
    by_cell = dict(iter(cleaned(runs, metrics).groupby("cell")))
    nothing = cleaned(runs.iloc[:0], metrics)
    names = _names(metrics)
    for context in contexts(design, comparison):
        tables = {label: by_cell.get(cell, nothing) for label, cell in context.cells.items()}
        if baseline.label not in tables:
            continue
        for ego in _egos(tables):
            based = _side(tables[baseline.label], ego, names)
            for level in compared:
                if level is baseline or level.label not in tables:
                    continue
                treated = _side(tables[level.label], ego, names)
                seeds, i, j = np.intersect1d(treated.seeds, based.seeds, return_indices=True)
                if i.size:
                    sides = seeds, treated.values[i], based.values[j]
                    yield Pairs(context, ego, level.label, baseline.label, *sides, names)


def cleaned(runs: pd.DataFrame, metrics: Sequence[Metric] = METRICS) -> pd.DataFrame:
    """Return the columns that are compared, with the types that a CSV reader may have lost."""
    names = _names(metrics)
    frame = runs.reindex(columns=["cell", "seed", "ego", "ending", *names])
    frame["ego"] = frame["ego"].astype(object).fillna("").astype(str)
    for name in names:
        values = pd.to_numeric(frame[name], errors="coerce").to_numpy(np.float64, na_value=np.nan)
        frame[name] = np.where(np.isfinite(values), values, np.nan)
    frame.loc[without_result(frame), list(names)] = np.nan
    return frame.sort_values(["cell", "seed", "ego"], kind="stable")


def without_result(frame: pd.DataFrame) -> pd.Series[bool]:
    """Return a mask (n,) of the rows of runs that failed or crashed."""
    return frame["ending"].isin([FAILED, CRASHED])


def _egos(tables: dict[str, pd.DataFrame]) -> list[str]:
    """Return the egos of a context.

    It is one ego without a name if no run has a result.
    """
    names = {str(ego) for table in tables.values() for ego in table["ego"][~without_result(table)]}
    return sorted(names) or [""]


def _names(metrics: Sequence[Metric]) -> tuple[str, ...]:
    return (*(metric.name for metric in metrics), _SLOWED)


def _side(table: pd.DataFrame, ego: str, names: tuple[str, ...]) -> _Side:
    rows = table[(table["ego"] == ego) | without_result(table)]
    rows = rows.drop_duplicates("seed")
    seeds = rows["seed"].to_numpy(np.int64)
    return _Side(seeds, rows[list(names)].to_numpy(np.float64))
