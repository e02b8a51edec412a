"""Labels of the levels and contexts of a study in its report."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from giveway.studies.contexts import Context, baseline_level, other_factors
from giveway.studies.contexts import contexts as contexts_of
from giveway.studies.design import label_of
from giveway.studies.folder.study_folder import StudyFolder


def contexts(study: StudyFolder) -> list[Context]:
    """Return the contexts of a study in the order of its design."""
    return contexts_of(study.design, study.definition.comparison)


def compared_labels(study: StudyFolder) -> list[str]:
    """Return the labels of the compared factor's levels, including the baseline's."""
    return [level.label for level in study.design.factor(study.definition.comparison.factor).levels]


def baseline_label(study: StudyFolder) -> str:
    """Return the label of the baseline level."""
    return baseline_level(study.design, study.definition.comparison).label


def treatment_labels(study: StudyFolder) -> list[str]:
    """Return the labels of the levels that are compared with the baseline."""
    baseline = baseline_label(study)
    return [label for label in compared_labels(study) if label != baseline]


def level_label(value: object) -> str:
    """Return the label of a level from its value in a frame, of any type."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return ""
    if isinstance(value, str):
        return value.lower() if value in {"True", "False"} else value
    return label_of(value)


def context_key(study: StudyFolder, row: Mapping[Any, Any]) -> tuple[str, ...]:
    """Return the ``Context.key`` of a row of a table."""
    names = other_factors(study.design, study.definition.comparison)
    return tuple(level_label(row[name]) for name in names)
