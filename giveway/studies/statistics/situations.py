"""Whether the vehicle had to stop: the three situations of Yang & Özgüner 2019, section 4."""

from typing import get_args

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.studies.columns import SITUATION_COLUMNS
from giveway.studies.contexts import other_factors
from giveway.studies.definition import Comparison, Situation
from giveway.studies.design import Design
from giveway.studies.statistics.pairs import Pairs, paired

Mask = NDArray[np.bool_]

SITUATIONS: tuple[Situation, ...] = get_args(Situation)


def situations(runs: pd.DataFrame, design: Design, comparison: Comparison) -> pd.DataFrame:
    """How often both sides of a pair stopped, one of them or none: ``situations.csv``.

    Args:
        runs: a row per run and ego, as ``runs.csv``.
        design: of the study.
        comparison: which factor is compared, with which baseline.

    Returns:
        A row per context, ego and treatment: the context's factors, then ``SITUATION_COLUMNS``.

    Raises:
        ConfigError: the study has no such factor, or the factor no such level.
    """
    rows = [_row(pairs) for pairs in paired(runs, design, comparison)]
    names = [*other_factors(design, comparison), *(column.name for column in SITUATION_COLUMNS)]
    return pd.DataFrame(rows, columns=names)


def _row(pairs: Pairs) -> dict[str, object]:
    treated, based = _stopped(pairs)
    seen = kept(pairs)
    arrived = np.isfinite(pairs.of("completion_time")).all(axis=0)

    return {
        **pairs.row,
        "pairs": len(pairs),
        "share_both_stop": _mean(treated & based, seen),
        "share_neither_stops": _mean(~treated & ~based, seen),
        "share_only_treatment_stops": _mean(treated & ~based, seen),
        "share_only_baseline_stops": _mean(~treated & based, seen),
        "lost": int(np.count_nonzero(~seen)),
        "incomplete": int(np.count_nonzero(seen & ~arrived)),
    }


def kept(pairs: Pairs) -> Mask:
    """Which pairs (n,) are not lost: both runs have a result, with this ego."""
    return np.asarray(np.isfinite(pairs.of("stops")).all(axis=0), dtype=np.bool_)


def within(pairs: Pairs, situation: Situation) -> Mask:
    """Which pairs (n,) are in the situation; those that are lost are in none."""
    treated, based = _stopped(pairs)
    seen = kept(pairs)
    if situation == "stop-and-wait":
        return seen & treated & based
    if situation == "non-stop":
        return seen & ~treated & ~based
    if situation == "slowed":
        slowed: Mask = (np.stack(pairs.of("slowed")) == 1.0).any(axis=0)
        return seen & slowed
    return seen


def share(pairs: Pairs, situation: Situation) -> float:
    """The share of the situation among the pairs that are not lost; nan if all are lost."""
    return _mean(within(pairs, situation), kept(pairs))


def _mean(which: Mask, among: Mask) -> float:
    return float(np.mean(which[among])) if among.any() else np.nan


def _stopped(pairs: Pairs) -> tuple[Mask, Mask]:
    """Whether the vehicle stopped at least once, on each side; nan did not."""
    treated, based = pairs.of("stops")
    return treated >= 1.0, based >= 1.0
