"""The choice of runs for a report: examples of pairs, and the most extreme runs.

The choice is not random: the same study gives the same runs. Of equal ones, the first in the study
is chosen.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.reports.pairing import BASELINE, DIFFERENCE, paired
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.statistics import metric


@dataclass(frozen=True)
class ExamplePair:
    """Two runs on the same crowd that are shown side by side.

    Attributes:
        reason: Reason to show the pair: median (with a stop), best, worst or stop-and-wait.
        context: Label of the other factors' levels; empty without other factors.
        ego: Id of the ego; empty in runs without an ego.
        treatment: Label of the compared level.
        baseline: Label of the level that is subtracted.
        seed: Seed of both runs.
        run: Id of the treatment's run.
        run_baseline: Id of the baseline's run.
        metric: Name of the metric by which the pair was chosen.
        difference: Treatment minus baseline, in the metric's unit.
    """

    reason: str
    context: str
    ego: str
    treatment: str
    baseline: str
    seed: int
    run: str
    run_baseline: str
    metric: str
    difference: float


@dataclass(frozen=True)
class WorstRun:
    """A run that is extreme in one respect.

    Attributes:
        reason: Heading of its table.
        run: Id of the run, or of the treatment's run of a pair.
        partner: Id of the baseline's run of a pair, else empty.
        cell: Label of the cell's levels.
        ego: Id of the ego; may be empty.
        metric: Name of the metric that is extreme.
        value: Value of the metric, or the pair's difference.
        unit: Unit of the value.
    """

    reason: str
    run: str
    partner: str
    cell: str
    ego: str
    metric: str
    value: float
    unit: str


CLOSE_PASSES = "Most close passes"
CLOSEST = "Smallest clearance to a pedestrian"
OVERLAPS = "Longest overlap with pedestrians"
WAITS = "Longest wait"
SLOWER = "Slower than the baseline by most"
FASTER = "Faster than the baseline by most"


def worst_runs(study: StudyFolder, count: int = 5) -> list[WorstRun]:
    """Return the runs that are extreme in safety or time, at most ``count`` for each reason.

    Args:
        study: Folder of the study.
        count: Largest number of runs for each reason.
    """
    return [
        *_extreme(study, CLOSE_PASSES, "close_passes", count, sign=-1.0),
        *_extreme(study, CLOSEST, "minimum_clearance", count, sign=1.0),
        *_extreme(study, OVERLAPS, "overlap_time", count, sign=-1.0),
        *_extreme(study, WAITS, "longest_wait", count, sign=-1.0),
        *_differing(study, SLOWER, count, sign=-1.0),
        *_differing(study, FASTER, count, sign=1.0),
    ]


def example_pairs(study: StudyFolder, count: int = 4) -> list[ExamplePair]:
    """Return pairs that show typical differences: median, best, worst, and one with waiting.

    They come from the first context, ego and treatment with pairs. The pair with waiting comes from
    a later context if the first has none. The median is that of the pairs in which at least one car
    stops, if there are any, because in the others hardly anything happens. A pair is shown once.

    Args:
        study: Folder of the study.
        count: Largest number of pairs.
    """
    pairs = paired(study)
    name = deciding_metric(pairs)
    pairs = pairs[pairs[name + DIFFERENCE].notna()]
    if pairs.empty:
        return []
    head = pairs.iloc[0]
    pairs = pairs[(pairs["treatment"] == head["treatment"]) & (pairs["ego"] == head["ego"])]
    here = pairs[pairs["context"] == head["context"]]
    waiting = pairs[pairs["situation"] == "stop-and-wait"]
    waiting = waiting[waiting["context"].isin(waiting["context"].iloc[:1])]
    by_time = here[name + DIFFERENCE]
    chosen: list[ExamplePair] = []
    _add(chosen, "best", here, name, by_time)
    _add(chosen, "worst", here, name, -by_time)
    extremes = len(chosen)
    stops = (here["stops"] > 0) | (here["stops" + BASELINE] > 0)
    for reason, table in (("median with a stop", here[stops]), ("median", here)):
        if len(chosen) == extremes:
            middle = table[name + DIFFERENCE]
            _add(chosen, reason, table, name, (middle - middle.median()).abs())
    chosen = [*chosen[extremes:], *chosen[:extremes]]  # typical pairs come first
    by_wait = waiting["longest_wait" + DIFFERENCE]
    _add(chosen, "stop-and-wait", waiting, "longest_wait", (by_wait - by_wait.median()).abs())
    return chosen[: max(count, 0)]


def _add(
    chosen: list[ExamplePair], reason: str, table: pd.DataFrame, by: str, cost: pd.Series
) -> None:
    """Add the pair of the lowest cost that has not been chosen yet, if there is one."""
    free = ~table["run"].isin([pair.run for pair in chosen])
    best = _smallest(cost.where(free).to_numpy(float), 1)
    chosen += [_example(reason, table.iloc[place], by) for place in best]


def deciding_metric(pairs: pd.DataFrame) -> str:
    """Return the metric to choose by: the completion time.

    It is the total waiting time if no pair has reached its goal on both sides.
    """
    reached = pairs["completion_time" + DIFFERENCE].notna()
    return "completion_time" if reached.any() else "total_wait"


def _example(reason: str, row: pd.Series, name: str) -> ExamplePair:
    return ExamplePair(
        reason=reason,
        context=str(row["context"]),
        ego=str(row["ego"]),
        treatment=str(row["treatment"]),
        baseline=str(row["baseline"]),
        seed=int(row["seed"]),
        run=str(row["run"]),
        run_baseline=str(row["run_baseline"]),
        metric=name,
        difference=float(row[name + DIFFERENCE]),
    )


def _extreme(
    study: StudyFolder, reason: str, name: str, count: int, *, sign: float
) -> list[WorstRun]:
    """Return the runs with the smallest (sign +1) or largest (sign -1) numbers.

    The largest numbers must be above zero.
    """
    values = pd.to_numeric(study.runs[name], errors="coerce").to_numpy(float)
    cost = np.where((values > 0.0) | (sign > 0.0), sign * values, np.nan)
    labels = {cell.number: cell.label for cell in study.design.cells}
    found = []
    for place in _smallest(cost, count):
        row = study.runs.iloc[place]
        ego = row["ego"] if isinstance(row["ego"], str) else ""
        cell = labels[int(row["cell"])]
        value, unit = float(values[place]), metric(name).unit
        found.append(WorstRun(reason, str(row["run"]), "", cell, ego, name, value, unit))
    return found


def _differing(study: StudyFolder, reason: str, count: int, *, sign: float) -> list[WorstRun]:
    """Return the pairs with the most negative (sign +1) or positive (sign -1) differences."""
    pairs = paired(study)
    name = deciding_metric(pairs)
    values = pairs[name + DIFFERENCE].to_numpy(float)
    cost = np.where(sign * values < 0.0, sign * values, np.nan)
    found = []
    for place in _smallest(cost, count):
        row = pairs.iloc[place]
        levels = f"{row['treatment']} against {row['baseline']}"
        cell = ", ".join(filter(None, (row["context"], levels)))
        value, unit = float(values[place]), metric(name).unit
        ids = str(row["run"]), str(row["run_baseline"])
        found.append(WorstRun(reason, *ids, cell, str(row["ego"]), name, value, unit))
    return found


def _smallest(cost: NDArray[np.float64], count: int) -> list[int]:
    """Return the indices of the ``count`` smallest finite values; of equal ones, the first."""
    order = np.argsort(cost, kind="stable")
    return [int(place) for place in order if np.isfinite(cost[place])][: max(count, 0)]
