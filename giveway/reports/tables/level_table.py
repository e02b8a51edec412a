"""The table of every level's own numbers: a block per context, a row per level."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from giveway.reports.labels import (
    baseline_label,
    compared_labels,
    context_key,
    contexts,
    level_label,
)
from giveway.reports.tables.table import Cell, Table
from giveway.reports.wording import number, pretty_unit
from giveway.studies.contexts import Context
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.statistics import metric

BETTER, WORSE = "+", "−"

_SHOWN = {
    "completion_time": "completion",
    "longest_wait": "longest wait",
    "stops": "stops",
    "rms_jerk": "RMS jerk",
    "peak_jerk": "peak jerk",
    "close_passes": "close passes",
    "overlaps": "overlaps",
    "frontal_contacts": "frontal",
    "side_contacts": "side",
    "minimum_gap": "min. gap",
    "minimum_ttc": "min. TTC",
    "minimum_pet": "min. PET",
    "share_below_safe_distance": "below d_safe",
    "conflicts": "serious conflicts",
    "safety_share": "safety acts",
}
_OF_TWINS = {  # metrics that are shown if runs have a counterfactual run
    "mean_people_delay": "people's delay",
    "worst_people_delay": "worst delay",
    "share_gave_way": "gave way",
    "traffic_delay": "cars' delay",
}
_IN_PERCENT = frozenset({"share_below_safe_distance", "safety_share", "share_gave_way"})
_MOST_DIGITS = 3
_SLOWED = (("slowed", "%"), ("completion, slowed", "s"))
_TIMES = ("control step", "worst step")


@dataclass(frozen=True)
class Mean:
    """The mean of one metric at one level.

    Attributes:
        text: Mean and half width of its interval, as in "14.42 ±0.31".
        verdict: "better" or "worse" than the baseline, pair by pair; otherwise empty.
    """

    text: str
    verdict: str = ""

    @property
    def mark(self) -> str:
        """A plus if the level is better, a minus if it is worse."""
        return {"better": BETTER, "worse": WORSE}.get(self.verdict, "")


@dataclass(frozen=True)
class Row:
    """One level in one context."""

    context: str
    level: str
    means: tuple[Mean, ...]


@dataclass(frozen=True)
class LevelTable:
    """The table of levels, as the terminal and the report show it.

    Attributes:
        headings: Metric and unit of each column of means.
        rows: Rows, context by context.
        baseline: Level with which the verdicts compare.
    """

    headings: tuple[tuple[str, str], ...]
    rows: tuple[Row, ...]
    baseline: str


def level_table(study: StudyFolder) -> LevelTable:
    """Return the main metrics of every level in every context, and the time of a control step.

    The table shows half of the interval's width; ``levels.csv`` has both ends.
    """
    headings = [(heading, _unit(name)) for name, heading in _shown(study).items()]
    headings += [*_SLOWED, *((heading, "ms") for heading in _TIMES)]
    rows = [row for context in contexts(study) for row in _rows(study, context)]
    return LevelTable(tuple(headings), tuple(rows), baseline_label(study))


def _shown(study: StudyFolder) -> dict[str, str]:
    """Return metric and heading of each column of means."""
    frame = study.levels
    known = set(frame.loc[frame["n"] > 0, "metric"])
    return _SHOWN | {name: heading for name, heading in _OF_TWINS.items() if name in known}


def _unit(name: str) -> str:
    return "%" if name in _IN_PERCENT else metric(name).unit


def _rows(study: StudyFolder, context: Context) -> Iterator[Row]:
    compared = study.definition.comparison.factor
    frame, verdicts = study.levels, _verdicts(study, context)
    here = [row for row in frame.to_dict("records") if context_key(study, row) == context.key]
    several = frame["ego"].nunique() > 1
    title = _title(context)
    for label in compared_labels(study):
        own = [row for row in here if level_label(row[compared]) == label]
        for ego in dict.fromkeys(str(row["ego"]) for row in own):
            by_metric = {row["metric"]: row for row in own if str(row["ego"]) == ego}
            means = [
                _mean(by_metric[name], verdicts.get((label, ego, name), ""))
                for name in _shown(study)
            ]
            means += _slowed(by_metric["completion_time"])
            means += _times(study, context.cells[label])
            yield Row(title, f"{label} ({ego})" if several else label, tuple(means))


def _title(context: Context) -> str:
    """Return the heading of a block: the label of a level that has a name, else the context."""
    levels = list(context.levels.values())
    return (
        levels[0].label if len(levels) == 1 and isinstance(levels[0].value, str) else context.short
    )


def _verdicts(study: StudyFolder, context: Context) -> dict[tuple[str, str, str], str]:
    """Return the verdicts by treatment, ego and metric, over all pairs."""
    frame = study.comparison
    return {
        (str(row["treatment"]), str(row["ego"]), str(row["metric"])): str(row["verdict"])
        for row in frame[frame["situation"] == "general"].to_dict("records")
        if context_key(study, row) == context.key
    }


def _mean(row: Mapping[Any, Any], verdict: str) -> Mean:
    if not math.isfinite(row["mean"]):
        return Mean("–")
    scale = 100.0 if row["metric"] in _IN_PERCENT else 1.0
    text = _with_half(scale * row["mean"], scale * (row["ci_high"] - row["ci_low"]) / 2.0)
    if row["metric"] == "completion_time" and row["n"] < row["runs"]:
        text += f" ({row['n']}/{row['runs']})"
    return Mean(text, verdict)


def _with_half(mean: float, half: float) -> str:
    if not half > 0.0:
        return f"{mean:.3g}"
    digits = _digits(half)
    return f"{number(mean, digits)} ±{number(half, digits)}"


def _slowed(row: Mapping[Any, Any]) -> list[Mean]:
    """Return the number of runs in which people slowed the ego, and their completion time."""
    share = row["share_slowed"]
    if not math.isfinite(share):
        return [Mean("–")] * len(_SLOWED)
    mean, half = row["slowed_mean"], (row["slowed_ci_high"] - row["slowed_ci_low"]) / 2.0
    time = _with_half(mean, half) if math.isfinite(mean) else "–"
    return [Mean(f"{100.0 * share:.3g}"), Mean(time)]


def _digits(half: float) -> int:
    """Return the decimals that show half an interval with one digit, or two below 2, 0.2, 0.02."""
    return min(max(math.ceil(0.3 - math.log10(half)), 0), _MOST_DIGITS)


def _times(study: StudyFolder, cell: int) -> list[Mean]:
    frame = study.computing
    row = frame[frame["cell"] == cell].iloc[0]
    times = row["control_median"], row["control_max"]
    return [Mean(f"{time:.2f}" if math.isfinite(time) else "–") for time in times]


def levels_section(study: StudyFolder) -> Table | None:
    """Return the table of the report, or None if the study shows differences only."""
    if study.definition.table != "levels" or study.levels.empty:
        return None
    table = level_table(study)
    percent = 100.0 * study.definition.comparison.confidence
    units = [f"{name} [{pretty_unit(unit)}]" if unit else name for name, unit in table.headings]
    rows = [
        [Cell(row.context), Cell(row.level), *(_cell(mean) for mean in row.means)]
        for row in table.rows
    ]
    return Table(
        name="levels-table",
        caption=f"Each level's mean, with half the width of its {percent:g} % interval",
        headings=["context", study.definition.comparison.factor, *units],
        rows=rows,
        filters=(0, 1),
        note=f"{BETTER} better, {WORSE} worse than {table.baseline}, pair by pair. (n/m): n of m "
        "runs arrived. Slowed: at some instant below 0.8 times the speed with nobody about. "
        "A control step is prediction and controller: the median of the runs' medians, and "
        "the longest of all.",
    )


def _cell(mean: Mean) -> Cell:
    return Cell(f"{mean.text} {mean.mark}".rstrip(), mean.verdict if mean.mark else "number")
