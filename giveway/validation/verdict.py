"""The sentences that say which predictor is better.

A difference whose interval contains zero does not count.
"""

from collections.abc import Iterator

import pandas as pd

from giveway.validation.evaluation import EVERYWHERE, NEAR
from giveway.validation.predictors import CV, GOAL_CV, OWN_PACE, VCI

_GROUPS = {EVERYWHERE: "everybody", NEAR: "people near a moving vehicle"}


def verdict(errors: pd.DataFrame, prediction: pd.DataFrame) -> Iterator[str]:
    """Yield one sentence per model, and one for drift, about the FDE of the people near vehicles.

    Without anybody near, the sentences are about everybody. A model must be better than both
    constant velocity and the walk straight to the destination at a horizon to be called better.

    Args:
        errors: Table of :func:`giveway.validation.evaluation.error_table`.
        prediction: Table of :func:`giveway.validation.prediction.prediction_table`, or empty.
    """
    near = errors[(errors["subset"] == NEAR) & (errors["metric"] == "FDE")]
    subset = NEAR if near["count"].sum() else EVERYWHERE
    rows = errors[(errors["subset"] == subset) & (errors["metric"] == "FDE")]
    rows = rows[rows["count"] > 0]
    for model in (VCI, OWN_PACE):
        told = [_of_model(row) for _, row in rows[rows["predictor"] == model].iterrows()]
        if told:
            yield f"{model}, {_GROUPS[subset]}: {'; '.join(told)}."
    if len(prediction):
        mine = prediction[prediction["subset"] == subset]
        told = [_of_drift(row) for _, row in mine.iterrows()]
        if told:
            yield f"drift, {_GROUPS[subset]}: {'; '.join(told)}."


def _of_model(row: pd.Series) -> str:
    """Return how a model compares with both simple predictors at a horizon."""
    against = {
        name: compared(row[f"{column}_low"], row[f"{column}_high"])
        for name, column in ((CV, "against_cv"), (GOAL_CV, "against_goal_cv"))
    }
    return f"at {row['horizon']:g} s " + ", ".join(f"{how} {name}" for name, how in against.items())


def _of_drift(row: pd.Series) -> str:
    """Return how drift compares with the best constant velocity at a horizon."""
    how = compared(row["change_low"], row["change_high"])
    interval = f"[{100 * row['change_low']:+.0f}, {100 * row['change_high']:+.0f}]"
    change = f"({100 * row['change']:+.1f} % {interval})"
    return f"at {row['horizon']:g} s {how} {row['baseline']} {change}"


def compared(low: float, high: float) -> str:
    """Return the words for a difference of errors with this interval."""
    if high < 0.0:
        return "better than"
    return "worse than" if low > 0.0 else "not distinguishable from"
