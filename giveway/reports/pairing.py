"""The pairs of runs as one table with the ids of the runs, as a report needs them."""

from functools import lru_cache

import numpy as np
import pandas as pd

from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.record import run_id
from giveway.studies.statistics import METRICS
from giveway.studies.statistics import pairs as statistics
from giveway.studies.statistics.pairs import Pairs
from giveway.studies.statistics.situations import within

NUMBERS = tuple(metric.name for metric in METRICS)
BASELINE = "_baseline"
DIFFERENCE = "_difference"
_HEAD = ("context", "ego", "treatment", "baseline", "seed", "run", "run_baseline", "situation")


@lru_cache(maxsize=1)
def paired(study: StudyFolder) -> pd.DataFrame:
    """Return one row per pair of runs that differ only in the compared level.

    Pairs are in the order of contexts, treatments, egos and seeds. The pairs of one study are
    remembered, since a report needs them about ten times.

    Returns:
        A frame with ``context`` (label), ``ego``, ``treatment``, ``baseline`` (labels), ``seed``,
        ``run`` and ``run_baseline`` (ids), ``situation`` ("stop-and-wait": both stopped,
        "non-stop": neither did, or empty), and for each metric three columns: the treatment's
        number, the baseline's, and the difference.
    """
    found = list(statistics.paired(study.runs, study.design, study.definition.comparison))
    found.sort(key=lambda p: (min(p.context.cells.values()), p.context.cells[p.treatment]))
    if not found:
        numbers = [name + end for name in NUMBERS for end in ("", BASELINE, DIFFERENCE)]
        return pd.DataFrame(columns=[*_HEAD, *numbers])
    return pd.concat([_table(pairs) for pairs in found], ignore_index=True)


def situation_of(pairs: pd.DataFrame, situation: str) -> pd.DataFrame:
    """Return the pairs of a situation, or all pairs for "general"."""
    return pairs if situation == "general" else pairs[pairs["situation"] == situation]


def _table(pairs: Pairs) -> pd.DataFrame:
    runs = [
        [run_id(pairs.context.cells[label], seed) for seed in pairs.seeds]
        for label in (pairs.treatment, pairs.baseline)
    ]
    waiting, driving = within(pairs, "stop-and-wait"), within(pairs, "non-stop")
    situation = np.where(waiting, "stop-and-wait", np.where(driving, "non-stop", ""))
    labels = pairs.context.label, pairs.ego, pairs.treatment, pairs.baseline
    columns: dict[str, object] = dict(
        zip(_HEAD, (*labels, pairs.seeds, *runs, situation), strict=True)
    )
    for name in NUMBERS:
        treated, based = pairs.of(name)
        columns |= {name: treated, name + BASELINE: based, name + DIFFERENCE: treated - based}
    return pd.DataFrame(columns)
