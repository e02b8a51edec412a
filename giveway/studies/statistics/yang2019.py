"""The paper's Table 2 next to the study's: Yang & Özgüner 2019 (arXiv 1907.05178), section 5.2."""

import math

import pandas as pd

from giveway.studies.definition import Situation
from giveway.studies.table_columns import COMPARISON_COLUMNS, TABLE_2_COLUMNS

PEDESTRIANS = (30, 20, 10)
METRIC_OF: dict[Situation, str] = {
    "general": "completion_time",
    "stop-and-wait": "longest_wait",
    "non-stop": "completion_time",
}
"""Metric that the paper compares in each situation."""

PUBLISHED: dict[tuple[int, Situation], float] = {
    (30, "general"): -1.2665,
    (30, "stop-and-wait"): -1.9457,
    (30, "non-stop"): -0.9843,
    (20, "general"): -0.5243,
    (20, "stop-and-wait"): -1.8338,
    (20, "non-stop"): -0.7630,
    (10, "general"): -0.4153,
    (10, "stop-and-wait"): math.nan,  # printed as N.A.: too few instances
    (10, "non-stop"): -0.5394,
}
"""Mean difference [s] MPC minus PID over 2,000 simulations, by pedestrians and situation."""


def table2(
    comparison: pd.DataFrame,
    factor_column: str = "crowd.pedestrians",
    *,
    treatment: str = "mpc-paper",
    baseline: str = "pid-paper",
) -> pd.DataFrame:
    """Return the nine numbers of Table 2, each with the study's.

    Args:
        comparison: Table of ``compare``.
        factor_column: Column that has the number of pedestrians.
        treatment: Level that stands for the paper's MPC.
        baseline: Level that stands for the paper's PID.

    Returns:
        Nine rows, by pedestrians (30, 20, 10) and situation, for every ego and combination of the
        other factors: these factors, then ``TABLE_2_COLUMNS``. The study's number is nan if it was
        not run. The table is empty if the two levels are not compared at any number of pedestrians.
    """
    known = {column.name for column in COMPARISON_COLUMNS}
    others = [name for name in comparison.columns if name not in known and name != factor_column]
    columns = [*others, *(column.name for column in TABLE_2_COLUMNS)]
    if factor_column not in comparison.columns:
        return pd.DataFrame(columns=columns)
    ours = comparison[(comparison["treatment"] == treatment) & (comparison["baseline"] == baseline)]
    rows = [
        dict(zip(others, context[:-1], strict=True)) | {"ego": context[-1]} | row
        for context, frame in ours.groupby([*others, "ego"], sort=False)
        for row in _nine(frame, factor_column)
    ]
    return pd.DataFrame(rows, columns=columns)


def _nine(ours: pd.DataFrame, factor_column: str) -> list[dict[str, object]]:
    rows = {
        (row[factor_column], row["situation"], row["metric"]): row
        for row in ours.to_dict("records")
    }
    found = []
    for (pedestrians, situation), published in PUBLISHED.items():
        metric = METRIC_OF[situation]
        row = rows.get((pedestrians, situation, metric), {})
        numbers = {name: row.get(name, math.nan) for name in ("mean_difference", "share")}
        low, high = row.get("ci_low", math.nan), row.get("ci_high", math.nan)
        found.append(
            {
                "pedestrians": pedestrians,
                "situation": situation,
                "metric": metric,
                "unit": "s",
                "published": published,
                **numbers,
                "ci_low": low,
                "ci_high": high,
                "n": row.get("n", 0),
                "verdict": row.get("verdict", "N.A."),
                "agreement": _agreement(published, low, high),
            }
        )
    return found


def _agreement(published: float, low: float, high: float) -> str:
    """Return on which side of the study's interval the published number lies."""
    if math.isnan(published) or math.isnan(low):
        return ""
    if published < low:
        return "below"
    return "above" if published > high else "inside"
