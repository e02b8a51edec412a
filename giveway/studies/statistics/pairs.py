"""Two runs on the same crowd make a pair: what all differences are differences of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from giveway.errors import ConfigError
from giveway.studies.record import CRASHED, FAILED, Scalar
from giveway.studies.statistics.metrics import METRICS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from giveway.studies.definition import Comparison
    from giveway.studies.design import Cell, Design, Factor, Level

    Array = NDArray[np.float64]

_NAMES = tuple(metric.name for metric in METRICS)


@dataclass(frozen=True)
class Pairs:
    """One ego's runs under two levels, all else equal, seed by seed.

    Attributes:
        context: the value of each other factor.
        ego: SUMO id; empty without one.
        treatment: label of the level that is compared.
        baseline: label of the level that is subtracted.
        treated: metrics of the treatment's runs (n, metrics), nan where there is no number.
        based: the same of the baseline's runs; row i of both has the same seed.
    """

    context: dict[str, Scalar]
    ego: str
    treatment: str
    baseline: str
    treated: Array
    based: Array

    def __len__(self) -> int:
        """The number of pairs."""
        return len(self.treated)

    def of(self, name: str) -> tuple[Array, Array]:
        """Both sides (n,) of one metric."""
        place = _NAMES.index(name)
        return self.treated[:, place], self.based[:, place]

    @property
    def names(self) -> tuple[str, ...]:
        """What tells them from all others; the same with treatment and baseline swapped."""
        context = (f"{name}={value}" for name, value in self.context.items())
        return (*context, self.ego, *sorted((self.treatment, self.baseline)))

    @property
    def row(self) -> dict[str, Scalar]:
        """The columns by which a table names them."""
        who = {"ego": self.ego, "treatment": self.treatment, "baseline": self.baseline}
        return {**self.context, **who}


@dataclass(frozen=True)
class _Side:
    """One ego's runs in one cell, by ascending seed."""

    seeds: NDArray[np.int64]
    values: Array


def other_factors(design: Design, comparison: Comparison) -> list[str]:
    """The names of the factors that make the context."""
    return [factor.name for factor in design.factors if factor.name != comparison.factor]


def paired(runs: pd.DataFrame, design: Design, comparison: Comparison) -> Iterator[Pairs]:
    """All pairs, context by context in the design's order, then ego, then treatment.

    A run that failed or crashed belongs to each ego of its context, for it would have had them
    all. Where no seed was run under both levels there is nothing to yield.

    Args:
        runs: a row per run and ego, as ``runs.csv``.
        design: of the study.
        comparison: which factor is compared, with which baseline.

    Raises:
        ConfigError: the study has no such factor, or the factor no such level.
    """
    factor = design.factor(comparison.factor)
    baseline = _baseline(factor, comparison)
    by_cell = dict(iter(cleaned(runs).groupby("cell")))
    nothing = cleaned(runs.iloc[:0])
    for cells in _contexts(design, factor):
        tables = {label: by_cell.get(cell.number, nothing) for label, cell in cells.items()}
        if baseline.label not in tables:
            continue
        some = next(iter(cells.values()))
        context = {n: level.value for n, level in some.levels.items() if n != factor.name}
        for ego in _egos(tables):
            based = _side(tables[baseline.label], ego)
            for level in factor.levels:
                if level is baseline or level.label not in tables:
                    continue
                treated = _side(tables[level.label], ego)
                _, i, j = np.intersect1d(treated.seeds, based.seeds, return_indices=True)
                if i.size:
                    sides = treated.values[i], based.values[j]
                    yield Pairs(context, ego, level.label, baseline.label, *sides)


def _baseline(factor: Factor, comparison: Comparison) -> Level:
    if comparison.baseline is None:
        return factor.levels[-1]
    level = factor.level(comparison.baseline)
    if level is None:
        known = ", ".join(level.label for level in factor.levels)
        msg = (
            f"comparison.baseline = '{comparison.baseline}': no level of {factor.name}; "
            f"expected one of {known}"
        )
        raise ConfigError(msg)
    return level


def _contexts(design: Design, factor: Factor) -> list[dict[str, Cell]]:
    """The cells that differ in ``factor`` alone, by its level's label."""
    found: dict[tuple[str, ...], dict[str, Cell]] = {}
    for cell in design.cells:
        key = tuple(level.label for name, level in cell.levels.items() if name != factor.name)
        found.setdefault(key, {})[cell.levels[factor.name].label] = cell
    return list(found.values())


def cleaned(runs: pd.DataFrame) -> pd.DataFrame:
    """The columns that matter, whatever a CSV reader or an empty table made of their types."""
    frame = runs.reindex(columns=["cell", "seed", "ego", "ending", *_NAMES])
    frame["ego"] = frame["ego"].fillna("").astype(str)
    for name in _NAMES:
        values = pd.to_numeric(frame[name], errors="coerce").to_numpy(np.float64, na_value=np.nan)
        frame[name] = np.where(np.isfinite(values), values, np.nan)
    frame.loc[without_result(frame), list(_NAMES)] = np.nan
    return frame.sort_values(["cell", "seed", "ego"], kind="stable")


def without_result(frame: pd.DataFrame) -> pd.Series[bool]:
    """Which rows (n,) are those of runs that failed or crashed."""
    return frame["ending"].isin([FAILED, CRASHED])


def _egos(tables: dict[str, pd.DataFrame]) -> list[str]:
    """The egos of a context; without any run that has a result there is the nameless one."""
    names = {str(ego) for table in tables.values() for ego in table["ego"][~without_result(table)]}
    return sorted(names) or [""]


def _side(table: pd.DataFrame, ego: str) -> _Side:
    rows = table[(table["ego"] == ego) | without_result(table)]
    rows = rows.drop_duplicates("seed")
    seeds = rows["seed"].to_numpy(np.int64)
    return _Side(seeds, rows[list(_NAMES)].to_numpy(np.float64))
