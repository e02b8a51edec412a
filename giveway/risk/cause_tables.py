"""The tables of the causes: the inputs given the event, and its likeliest runs."""

import shlex
from collections.abc import Sequence
from typing import Any

import pandas as pd

from giveway.risk.causes import QUANTILES, Condition, conditions, likeliest
from giveway.risk.risk_folder import RiskFolder
from giveway.run_data.columns import Column

_SHARES = [f"{round(100.0 * share)}" for share in QUANTILES]
GIVEN_EVENT_COLUMNS = (
    Column("input", "string", None, "an input, or a person's start or speed [deviations]"),
    Column("index", "number", None, "share of the event's variance that it explains alone"),
    Column("index_low", "number", None, "lower bound"),
    Column("index_high", "number", None, "upper bound"),
    *(
        Column(f"own_{s}", "number", None, f"{s} % quantile of all runs; empty: no number")
        for s in _SHARES
    ),
    *(Column(f"given_{s}", "number", None, f"{s} % quantile given the event") for s in _SHARES),
    Column("shares", "string", None, "of a choice: the share of each value given the event"),
)
LIKELIEST_COLUMNS = (
    Column("run", "string", None, "id of the run"),
    Column("distance", "number", None, "length of its vector without the seed; 0: the likeliest"),
    Column("criticality", "number", None, "at least 0: the event"),
    Column("reproduce", "string", None, "the commands that make and play the run again"),
)


def given_event_frame(folder: RiskFolder) -> pd.DataFrame:
    """Return ``given_event.csv``: each input given the event; empty with too few events."""
    return _frame(map(given_event_row, conditions(folder)), GIVEN_EVENT_COLUMNS)


def given_event_row(one: Condition) -> dict[str, Any]:
    """Return the row of an input."""
    return {
        "input": one.component.name,
        "index": one.index.index,
        "index_low": one.index.low,
        "index_high": one.index.high,
        **{f"own_{share}": value for share, value in zip(_SHARES, one.own, strict=True)},
        **{f"given_{share}": value for share, value in zip(_SHARES, one.given, strict=True)},
        "shares": ", ".join(f"{value}: {share:.3g}" for value, share in one.shares.items()),
    }


def likeliest_frame(folder: RiskFolder) -> pd.DataFrame:
    """Return ``likeliest.csv``: the runs with the event, the likeliest first."""
    place = shlex.quote(str(folder.path))
    rows = [
        {
            "run": one.run.id,
            "distance": one.distance,
            "criticality": folder.plan.criticality(one.run, one.record),
            "reproduce": f"giveway rerun {place} {one.run.id} && "
            f"giveway replay {shlex.quote(str(folder.path / 'reruns' / one.run.id))}",
        }
        for one in likeliest(folder)
    ]
    return _frame(rows, LIKELIEST_COLUMNS)


def _frame(rows: Any, columns: Sequence[Column]) -> pd.DataFrame:
    return pd.DataFrame(list(rows), columns=[column.name for column in columns])
