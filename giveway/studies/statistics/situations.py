"""The three situations of Yang & Özgüner 2019, section 4: whether the vehicle had to stop."""

from typing import get_args

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.studies.contexts import other_factors
from giveway.studies.definition import Comparison, Situation
from giveway.studies.design import Design
from giveway.studies.statistics.pairs import Pairs, paired
from giveway.studies.table_columns import SITUATION_COLUMNS

Mask = NDArray[np.bool_]

SITUATIONS: tuple[Situation, ...] = get_args(Situation)


def situations(runs: pd.DataFrame, design: Design, comparison: Comparison) -> pd.DataFrame:
    """Return ``situations.csv``: the numbers of pairs with stops on both sides, one, or none.

    Args:
        runs: Table with a row per run and ego, as ``runs.csv``.
        design: Design of the study.
        comparison: Compared factor and its baseline.

    Returns:
        Table with a row per context, ego and treatment: the context's factors, then
            ``SITUATION_COLUMNS``.

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
    """Return flags (n,) of the pairs whose runs both have a result with this ego."""
    return np.asarray(np.isfinite(pairs.of("stops")).all(axis=0), dtype=np.bool_)


def within(pairs: Pairs, situation: Situation) -> Mask:
    """Return flags (n,) of the pairs in the situation.

    A pair without both results is in no situation.
    """
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
    """Return the share of the situation among the pairs with results, or nan without any."""
    return _mean(within(pairs, situation), kept(pairs))


def _mean(which: Mask, among: Mask) -> float:
    return float(np.mean(which[among])) if among.any() else np.nan


def _stopped(pairs: Pairs) -> tuple[Mask, Mask]:
    """Return whether the vehicle stopped at least once, for each side.

    A missing number (nan) counts as no stop.
    """
    treated, based = pairs.of("stops")
    return treated >= 1.0, based >= 1.0
