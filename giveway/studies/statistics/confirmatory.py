"""Confirmatory differences: those of the primary outcome, which a study names before its runs.

All other differences of a study are exploratory.
"""

import math

import numpy as np
import pandas as pd

from giveway.geometry.kernel import Array
from giveway.studies.definition import StudyDefinition
from giveway.studies.statistics.comparing import BETTER, NOT_AVAILABLE, NOT_SHOWN, WORSE
from giveway.studies.statistics.metrics import metric

EXCLUDED = "excluded"  # The interval has only effects of at least the smallest of interest
POSSIBLE = "possible"  # The interval has effects on both sides of the smallest of interest
ONLY = "only these"  # The interval has only effects below the smallest of interest


def is_confirmatory(comparison: pd.DataFrame, definition: StudyDefinition) -> Array:
    """Return which rows (n,) of ``comparison.csv`` are differences of the primary outcome."""
    outcome = definition.primary_outcome
    if outcome is None:
        return np.zeros(len(comparison), dtype=bool)
    chosen = comparison["metric"] == outcome.metric
    return np.asarray(chosen & (comparison["situation"] == outcome.situation), dtype=bool)


def confirmatory(comparison: pd.DataFrame, definition: StudyDefinition) -> pd.DataFrame:
    """Return the differences of the primary outcome with conclusions of their own.

    Args:
        comparison: Table of all differences, as ``comparison.csv``.
        definition: Study, which may name a primary outcome. Without one no row is confirmatory.

    Returns:
        Rows of ``comparison`` in its order. ``p_holm`` is the p-value after Holm over these rows
        alone. ``verdict`` follows from it. ``smaller_effects`` says whether the interval has
        effects below the smallest of interest: excluded, possible, or only these. Rows without an
        interval have N.A. in both.
    """
    outcome = definition.primary_outcome
    least = math.nan if outcome is None else outcome.smallest_effect
    better = "lower" if outcome is None else metric(outcome.metric).better
    rows = comparison[is_confirmatory(comparison, definition)]
    low, high, mean, median, p_value = (
        rows[name].to_numpy(np.float64)
        for name in ("ci_low", "ci_high", "mean_difference", "median_difference", "p_value")
    )
    p_holm = holm(p_value)
    shown = (p_holm <= 1.0 - definition.comparison.confidence) & ((low > 0.0) | (high < 0.0))
    shown &= mean * median >= 0.0  # the middle pair does not point the other way
    gained = (mean < 0.0) == (better == "lower")
    none = np.isnan(low)
    return rows.assign(
        p_holm=p_holm,
        verdict=np.select([none, ~shown, gained], [NOT_AVAILABLE, NOT_SHOWN, BETTER], WORSE),
        smaller_effects=np.select(
            [none, (low >= least) | (high <= -least), (low > -least) & (high < least)],
            [NOT_AVAILABLE, EXCLUDED, ONLY],
            POSSIBLE,
        ),
    )


def holm(p_values: Array) -> Array:
    """Return the family-wise error rate at which each test is just rejected.

    Holm 1979, Scand. J. Stat. 6, 65-70.

    Args:
        p_values: Values (m,), or nan if there was no test, which then does not count.
    """
    corrected = np.full(p_values.size, np.nan)
    tests = np.flatnonzero(np.isfinite(p_values))
    order = tests[np.argsort(p_values[tests], kind="stable")]
    factors = np.arange(tests.size, 0, -1)
    corrected[order] = np.minimum(np.maximum.accumulate(factors * p_values[order]), 1.0)
    return corrected
