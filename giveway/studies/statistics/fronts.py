"""The cost of each level to the ego and to the people, and the Pareto front."""

import numpy as np
import pandas as pd

from giveway.studies.contexts import contexts
from giveway.studies.definition import Comparison
from giveway.studies.design import Design
from giveway.studies.statistics.rounding import tabulated
from giveway.studies.table_columns import FRONT_COLUMNS, numbers_of

EGO, PEOPLE = "completion_time", "mean_people_delay"
"""The metrics of the two sides. The time of a free drive is the same for all levels of a
context."""


def fronts(levels: pd.DataFrame, design: Design, comparison: Comparison) -> pd.DataFrame:
    """Return each cell's mean time to the goal and people's mean delay, and the Pareto front.

    A cell is on the Pareto front of its context if no other level of the compared factor has both
    means at most as large and one of them smaller. A cell with a run that did not arrive has no
    fair mean time, and is not on the front.

    Args:
        levels: The table of :func:`levels`.
        design: Design of the study.
        comparison: Factor whose levels are compared.

    Returns:
        Table with a row per cell and ego with numbers on both sides, in the order of the design.
        Its columns are the factors, then ``FRONT_COLUMNS``. It is empty without counterfactual
        runs.
    """
    rows = []
    for context in contexts(design, comparison):
        numbers = set(context.cells.values())
        cells = [cell for cell in design.cells if cell.number in numbers]
        for ego in levels["ego"].unique():
            found = []
            for cell in cells:
                here = levels["ego"] == ego
                for name, level in cell.levels.items():
                    here &= levels[name] == level.value
                row = _row(levels[here])
                if row is not None:
                    factors = {name: level.value for name, level in cell.levels.items()}
                    found.append(factors | {"ego": ego} | row)
            times = np.array([row["ego_time"] for row in found])
            delays = np.array([row["people_delay"] for row in found])
            arrived = np.array([row["arrived"] == row["runs"] for row in found], dtype=np.bool_)
            front = on_front(np.where(arrived, times, np.inf), delays) & arrived
            rows += [row | {"front": bool(best)} for row, best in zip(found, front, strict=True)]
    names = [factor.name for factor in design.factors]
    frame = pd.DataFrame(rows, columns=[*names, *(column.name for column in FRONT_COLUMNS)])
    return tabulated(frame, numbers_of(FRONT_COLUMNS))


def on_front(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return flags (n,): no other point is as low in both ``x`` and ``y``, and lower in one."""
    better = (x[None] <= x[:, None]) & (y[None] <= y[:, None])
    better &= (x[None] < x[:, None]) | (y[None] < y[:, None])
    return np.asarray(~better.any(axis=1))


def _row(metrics: pd.DataFrame) -> dict[str, float] | None:
    """Return the numbers of one cell and ego, or None if a side is missing."""
    by_name = metrics.set_index("metric")
    if not {EGO, PEOPLE} <= set(by_name.index):
        return None
    ego, people = by_name.loc[EGO], by_name.loc[PEOPLE]
    if not (ego["n"] and people["n"]):
        return None
    return {
        "runs": ego["runs"],
        "arrived": ego["n"],
        "ego_time": ego["mean"],
        "ego_time_low": ego["ci_low"],
        "ego_time_high": ego["ci_high"],
        "people_delay": people["mean"],
        "people_delay_low": people["ci_low"],
        "people_delay_high": people["ci_high"],
    }
