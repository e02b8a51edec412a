"""Numbers from the literature with which a report compares those of the study."""

import math

import pandas as pd

from giveway.reports.labels import (
    baseline_label,
    contexts,
    level_label,
    treatment_labels,
)
from giveway.reports.tables.table import Cell, Table
from giveway.reports.wording import digits_for, interval, number
from giveway.studies.contexts import short_name
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.statistics import PUBLISHED, TABLE_2_COLUMNS, table2
from giveway.studies.statistics.yang2019 import METRIC_OF

SOURCE = "Yang & Özgüner 2019"
DENSITY = "crowd.pedestrians"
TREATMENT, BASELINE = "mpc-paper", "pid-paper"

Key = tuple[tuple[str, ...], str, str, str]
"""Context, treatment, situation and metric of a number."""


def published_numbers(study: StudyFolder) -> dict[Key, float]:
    """Return Table 2 of Yang & Özgüner 2019, if the study names it and compares its levels."""
    compares = TREATMENT in treatment_labels(study) and baseline_label(study) == BASELINE
    if study.definition.reference != "yang2019" or not compares:
        return {}
    found: dict[Key, float] = {}
    for context in contexts(study):
        level = context.levels.get(DENSITY)
        for (pedestrians, situation), mean in PUBLISHED.items():
            if level is not None and level.label == str(pedestrians) and math.isfinite(mean):
                found[context.key, TREATMENT, situation, METRIC_OF[situation]] = mean
    return found


_DIGITS = 2  # Digits of a mean without an interval
_WORDS = {
    "inside": "inside our interval",
    "below": "below our interval",
    "above": "above our interval",
}


def published_frame(study: StudyFolder) -> pd.DataFrame | None:
    """Return Table 2 with the study's numbers, or None if the study does not name it."""
    if study.definition.reference != "yang2019":
        return None
    frame = table2(study.comparison)
    return None if frame.empty else frame


def published_table(frame: pd.DataFrame) -> Table:
    """Return the published and own numbers: a row per number of pedestrians and situation."""
    known = {column.name for column in TABLE_2_COLUMNS}
    others = [name for name in frame.columns if name not in known]
    headings = [*map(short_name, others), "pedestrians", "situation", "quantity", SOURCE, "giveway"]
    rows = []
    for row in frame.to_dict("records"):
        missing = not math.isfinite(row["mean_difference"])
        width = row["ci_high"] - row["ci_low"]
        digits = digits_for(width) if math.isfinite(width) else _DIGITS
        ours = "N.A." if missing else number(row["mean_difference"], digits)
        theirs = number(row["published"], 4)
        waits = METRIC_OF[row["situation"]] == "longest_wait"
        rows.append(
            [
                *(Cell(level_label(row[name])) for name in others),
                Cell(str(row["pedestrians"]), "number"),
                Cell(row["situation"]),
                Cell("longest wait" if waits else "completion time"),
                Cell(theirs, "na" if theirs == "N.A." else "number"),
                Cell(ours, "na" if missing else "number"),
                Cell(interval(row["ci_low"], row["ci_high"])),
                Cell(f"{int(row['n']):,}", "number"),
                Cell(_WORDS.get(str(row["agreement"]), "–")),
            ]
        )
    return Table(
        name="published-table",
        caption=f"Mean differences MPC minus PID [s]: Table 2 of {SOURCE} beside this study",
        headings=[*headings, "our interval", "our pairs", "the published number lies"],
        rows=rows,
        note="–: too few pairs for an interval; such a mean says little. N.A.: no pair, or no "
        "number in the paper, which does not say how many pairs a situation has.",
    )


def agreement(frame: pd.DataFrame) -> str:
    """Return how many of the published numbers lie within the study's intervals."""
    found = frame["agreement"].astype(str)
    known = int(found.isin(list(_WORDS)).sum())
    if not known:
        return ""
    inside = int((found == "inside").sum())
    alike = frame["published"] * frame["mean_difference"] > 0
    same = int((alike & found.isin(list(_WORDS))).sum())
    return (
        f"Of the {known} numbers of {SOURCE} that can be compared, {inside} "
        f"{'lies' if inside == 1 else 'lie'} within our intervals; {same} have the same sign."
    )
