"""Numbers from the literature that a study may be shown beside."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from giveway.reports.study import baseline_label, contexts, treatment_labels
from giveway.studies.statistics import PUBLISHED
from giveway.studies.statistics.yang2019 import METRIC_OF

if TYPE_CHECKING:
    from giveway.reports.study import Study

SOURCE = "Yang & Özgüner 2019"
DENSITY = "crowd.pedestrians"
TREATMENT, BASELINE = "mpc-paper", "pid-paper"

Key = tuple[tuple[str, ...], str, str, str]
"""Context, treatment, situation, metric."""


def published_numbers(study: Study) -> dict[Key, float]:
    """Table 2 of Yang & Özgüner 2019 where the study asks for it and compares what they did."""
    compares = TREATMENT in treatment_labels(study) and baseline_label(study) == BASELINE
    if study.definition.reference != "yang2019" or not compares:
        return {}
    found: dict[Key, float] = {}
    for context in contexts(study):
        for (pedestrians, situation), mean in PUBLISHED.items():
            if context.levels.get(DENSITY) == str(pedestrians) and math.isfinite(mean):
                found[context.key, TREATMENT, situation, METRIC_OF[situation]] = mean
    return found
