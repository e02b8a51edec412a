"""The comparison table by key, so that pictures find their numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.figures.study_forest import Estimate
from giveway.reports.labels import context_key, level_label

if TYPE_CHECKING:
    from giveway.studies.folder import StudyFolder

Key = tuple[tuple[str, ...], str, str, str, str]
"""Context, ego, treatment, situation, metric."""


def estimates(study: StudyFolder) -> dict[Key, Estimate]:
    """Mean difference and interval of every row of the comparison; nan is N.A."""
    return {
        (
            context_key(study, row),
            level_label(row["ego"]),
            level_label(row["treatment"]),
            str(row["situation"]),
            str(row["metric"]),
        ): Estimate(
            float(row["mean_difference"]) if row["verdict"] != "N.A." else float("nan"),
            float(row["ci_low"]),
            float(row["ci_high"]),
            shown=row["verdict"] in {"better", "worse"},
        )
        for row in study.comparison.to_dict("records")
    }
