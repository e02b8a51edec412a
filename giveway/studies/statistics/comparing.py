"""The table of differences: every metric in every situation of every context."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from giveway.geometry.kernel import Array
from giveway.studies.contexts import other_factors
from giveway.studies.definition import Comparison, Situation
from giveway.studies.design import Design
from giveway.studies.statistics.bootstrap import Interval, mean_interval, seed_of, side_by_side
from giveway.studies.statistics.metrics import METRICS, Metric
from giveway.studies.statistics.pairs import Pairs, paired
from giveway.studies.statistics.rounding import mean, median, tabulated, to_decimals
from giveway.studies.statistics.signed_rank import SignedRank, q_values, signed_rank
from giveway.studies.statistics.situations import SITUATIONS, share, within
from giveway.studies.table_columns import COMPARISON_COLUMNS, numbers_of

BETTER = "better"
WORSE = "worse"
NOT_SHOWN = "no difference shown"
NOT_AVAILABLE = "N.A."


@dataclass(frozen=True)
class Differences:
    """The pairs that count for one metric in one situation, which have a number on both sides.

    Attributes:
        treated: Numbers of the treatment's runs (n,).
        based: Numbers of the baseline's runs (n,).
        values: Treatment minus baseline (n,), rounded to six decimals as both are, so that equal
            differences are equal numbers and share their rank.
    """

    treated: Array
    based: Array
    values: Array

    def __len__(self) -> int:
        """The number of pairs."""
        return self.values.size


def differences(pairs: Pairs, name: str, situation: Situation) -> Differences:
    """Return the pairs of a situation that have a finite difference in the metric ``name``."""
    treated, based = pairs.of(name)
    with np.errstate(over="ignore"):
        values = to_decimals(treated - based)
    chosen = within(pairs, situation) & np.isfinite(values)
    return Differences(treated[chosen], based[chosen], values[chosen])


def interval(
    found: Differences, pairs: Pairs, name: str, situation: Situation, comparison: Comparison
) -> Interval:
    """Return the interval of the mean difference.

    Its random draws depend only on the names.
    """
    return mean_interval(
        found.values,
        confidence=comparison.confidence,
        resamples=comparison.resamples,
        seed=seed_of((*pairs.names, situation, name)),
    )


def compare(
    runs: pd.DataFrame,
    design: Design,
    comparison: Comparison,
    metrics: Sequence[Metric] = METRICS,
) -> pd.DataFrame:
    """Return ``comparison.csv``: the paired differences between the levels of one factor.

    Args:
        runs: Table with a row per run and ego, as ``runs.csv``.
        design: Design of the study.
        comparison: Compared factor, its baseline, and the confidence.
        metrics: Metrics that are compared.

    Returns:
        Table with a row per context, ego, treatment, situation and metric, in this order. Its
        columns are the context's factors, then ``COMPARISON_COLUMNS``; numbers are as they are
        written to a file. A context without any pair has no row.

    Raises:
        ConfigError: the study has no such factor, or the factor no such level.
    """
    wanted = [
        (pairs, metric, situation)
        for pairs in paired(runs, design, comparison, metrics)
        for situation in SITUATIONS
        for metric in metrics
    ]
    rows = side_by_side(lambda of: _row(*of, comparison), wanted)
    names = [*other_factors(design, comparison), *(column.name for column in COMPARISON_COLUMNS)]
    frame = pd.DataFrame(rows, columns=[*names, "better", "direction", "excludes_zero"])
    numbers = numbers_of(COMPARISON_COLUMNS)
    frame[numbers] = frame[numbers].astype(np.float64)
    # Slowed pairs are a subset of the general ones, so their tests do not count in the correction.
    for family in (frame["situation"] != "slowed", frame["situation"] == "slowed"):
        frame.loc[family, "q_value"] = q_values(frame.loc[family, "p_value"].to_numpy())
    frame["verdict"] = [_verdict(row, comparison) for row in frame.to_dict("records")]
    return tabulated(frame[names], numbers)


def _row(
    pairs: Pairs, metric: Metric, situation: Situation, comparison: Comparison
) -> dict[str, object]:
    found = differences(pairs, metric.name, situation)
    row: dict[str, object] = {
        **pairs.row,
        "situation": situation,
        "metric": metric.name,
        "unit": metric.unit,
        "n": len(found),
        "share": share(pairs, situation),
        "better": metric.better,
        "interval": "",
    }
    if len(found):
        row |= {
            "treatment_mean": mean(found.treated),
            "baseline_mean": mean(found.based),
            "mean_difference": mean(found.values),
            "median_difference": median(found.values),
        }
    if len(found) < comparison.minimum_pairs:
        return row
    between = interval(found, pairs, metric.name, situation, comparison)
    return row | _certainty(between, signed_rank(found.values))


def _certainty(between: Interval, test: SignedRank) -> dict[str, object]:
    return {
        "ci_low": between.low,
        "ci_high": between.high,
        "wilcoxon_statistic": test.statistic,
        "p_value": test.p_value,
        "interval": between.method,
        "direction": test.direction,
        "excludes_zero": between.excludes_zero(),
    }


def _verdict(row: Mapping[Hashable, Any], comparison: Comparison) -> str:
    """Return the verdict; both the interval and the corrected test must show a difference.

    Thus a verdict contradicts neither the interval in its row nor the correction for many tests. If
    a few large differences pull the mean to the other side than most pairs, no difference is shown.
    """
    if np.isnan(row["q_value"]):
        return NOT_AVAILABLE
    shown = row["q_value"] <= 1.0 - comparison.confidence and row["excludes_zero"]
    if not shown or row["direction"] != np.sign(row["mean_difference"]):
        return NOT_SHOWN
    return BETTER if (row["direction"] < 0) == (row["better"] == "lower") else WORSE
