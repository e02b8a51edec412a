"""The pictures of a study and their content from the tables; ``giveway.figures`` draws them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from giveway.figures.studies.study_differences import (
    DifferenceColumn,
    Differences,
    differences_figure,
)
from giveway.figures.studies.study_distributions import DistributionColumn, distributions_figure
from giveway.figures.studies.study_forest import Estimate, ForestColumn, forest_figure
from giveway.figures.studies.study_fronts import FrontPoint, fronts_figure
from giveway.figures.studies.study_rows import Row, level_colours
from giveway.figures.studies.study_tradeoff import TradeOffPoint, tradeoff_figure
from giveway.reports.choice import deciding_metric
from giveway.reports.labels import (
    baseline_label,
    compared_labels,
    context_key,
    contexts,
    level_label,
    treatment_labels,
)
from giveway.reports.pairing import BASELINE, DIFFERENCE, paired, situation_of
from giveway.reports.student_intervals import mean_interval, possible
from giveway.reports.tables.published import SOURCE, published_numbers
from giveway.reports.wording import shown_ego
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.statistics import SITUATIONS, metric

ROWS_PER_PICTURE = 8
PANELS_PER_PICTURE = 16
FEWEST_SPREAD = 10
"""Smallest number of runs in a cell for a 5th and 95th percentile."""
FOREST = ("completion_time", "longest_wait", "rms_jerk", "close_passes", "minimum_clearance")
SPREADS = {
    "time and comfort": ("completion_time", "longest_wait", "rms_jerk"),
    "safety": ("close_passes", "minimum_clearance", "minimum_ttc", "maximum_drac"),
}

_Key = tuple[tuple[str, ...], str, str, str, str]
"""Context, ego, treatment, situation, metric."""


@dataclass(frozen=True)
class Picture:
    """One figure of a study.

    Attributes:
        name: Name of its files, without suffix; unique within the study.
        section: Section of the report to which it belongs.
        caption: Caption of one or two sentences.
        alt: Description for readers who do not see the picture.
        figure: The picture.
    """

    name: str
    section: str
    caption: str
    alt: str
    figure: Figure


def study_pictures(study: StudyFolder) -> Iterator[Picture]:
    """Yield every picture of a study for which its tables have numbers."""
    if study.runs.empty:
        return
    yield from _histograms(study)
    yield from _forest(study)
    yield from _spreads(study)
    yield from _trade_off(study)
    yield from _fronts(study)


def _histograms(study: StudyFolder) -> Iterator[Picture]:
    pairs = paired(study)
    time = deciding_metric(pairs)
    names = {"general": time, "stop-and-wait": "longest_wait", "non-stop": time}
    columns = [
        DifferenceColumn(situation, quantity.label, quantity.unit, quantity.better)
        for situation, quantity in zip(names, map(metric, names.values()), strict=True)
    ]
    reported = _estimates(study)
    printed = published_numbers(study)
    number = 0
    for names_, group in pairs.groupby(["ego", "treatment"], sort=False):
        ego, treatment = map(str, names_)
        rows = []
        for context in contexts(study):
            some = group[group["context"] == context.label]
            if len(some):
                panels = [
                    _panel(
                        some, situation, name,
                        reported.get((context.key, ego, treatment, situation, name)),
                        printed.get((context.key, treatment, situation, name)),
                    )
                    for situation, name in names.items()
                ]  # fmt: skip
                rows.append((context.short, panels))
        rows = [row for row in rows if any(panel.values.size for panel in row[1])]
        for first in range(0, len(rows), ROWS_PER_PICTURE):
            number += 1
            what = f"{treatment} minus {baseline_label(study)}{shown_ego(ego)}"
            part = rows[first : first + ROWS_PER_PICTURE]
            yield Picture(
                name="differences" if number == 1 else f"differences_{number}",
                section="differences",
                caption=(
                    f"{what}, pair by pair, on the same crowds. General: {metric(time).label} of "
                    f"all pairs; stop-and-wait: longest wait where both stopped; non-stop: "
                    f"{metric(time).label} where neither did. Counts are "
                    "logarithmic where one bin would hide the others. A number with an arrow "
                    "counts pairs beyond the axis."
                ),
                alt=f"Histograms of the differences {what}: {_in_words(part, names)}",
                figure=differences_figure(columns, part, title=what, source=SOURCE),
            )


def _panel(
    pairs: pd.DataFrame,
    situation: str,
    name: str,
    reported: Estimate | None,
    printed: float | None,
) -> Differences:
    values = situation_of(pairs, situation)[name + DIFFERENCE].dropna().to_numpy(float)
    seen = int((pairs["stops"].notna() & pairs["stops" + BASELINE].notna()).sum())
    share = values.size / seen if seen else math.nan
    reported = reported or Estimate(math.nan, math.nan, math.nan)
    return Differences(values, share, reported.mean, reported.low, reported.high, printed)


def _in_words(rows: Sequence[tuple[str, Sequence[Differences]]], names: dict[str, str]) -> str:
    """Return the means of the panels in words, row by row."""
    said = []
    for label, panels in rows:
        for situation, panel in zip(names, panels, strict=True):
            mean = f"mean {panel.mean:.2f} s" if math.isfinite(panel.mean) else "no mean (N.A.)"
            said.append(f"{label or 'all'}, {situation}: {panel.values.size} pairs, {mean}")
    return "; ".join(said) + "."


def _forest(study: StudyFolder) -> Iterator[Picture]:
    reported, printed = _estimates(study), published_numbers(study)
    groups = [
        (context, ego, treatment)
        for context in contexts(study)
        for ego in dict.fromkeys(key[1] for key in reported)
        for treatment in treatment_labels(study)
        if any(key[:3] == (context.key, ego, treatment) for key in reported)
    ]
    columns = []
    for name in FOREST:
        found = {}
        for row, (context, ego, treatment) in enumerate(groups):
            for situation in SITUATIONS:
                value = reported.get((context.key, ego, treatment, situation, name))
                if value is not None:
                    known = printed.get((context.key, treatment, situation, name))
                    found[row, str(situation)] = replace(value, published=known)
        if any(math.isfinite(value.mean) for value in found.values()):
            quantity = metric(name)
            columns.append(ForestColumn(quantity.label, quantity.unit, quantity.better, found))
    if not groups or not columns:
        return
    several = len(treatment_labels(study)) > 1 or len({ego for _, ego, _ in groups}) > 1
    rows = [
        Row(f"{treatment}{shown_ego(ego)}" if several or not context.short else "", context.short)
        for context, ego, treatment in groups
    ]
    baseline = baseline_label(study)
    what = " and ".join(treatment_labels(study)) if not several else "each level"
    percent = 100.0 * study.definition.comparison.confidence
    yield Picture(
        name="forest",
        section="differences",
        caption=(
            f"Mean differences, {what} minus {baseline}, with {percent:g} % intervals. Filled: "
            "interval and test show a difference; hollow: no difference shown."
        ),
        alt=f"Mean differences with intervals against {baseline}; the comparison table has them.",
        figure=forest_figure(rows, columns, title=f"{what} minus {baseline}", source=SOURCE),
    )


def _estimates(study: StudyFolder) -> dict[_Key, Estimate]:
    """Return mean difference and interval of every row of the comparison, with N.A. for nan."""
    return {
        (
            context_key(study, row),
            level_label(row["ego"]),
            level_label(row["treatment"]),
            str(row["situation"]),
            str(row["metric"]),
        ): Estimate(
            float(row["mean_difference"]) if row["verdict"] != "N.A." else float("nan"),
            float(row["ci_low"]),
            float(row["ci_high"]),
            shown=row["verdict"] in {"better", "worse"},
        )
        for row in study.comparison.to_dict("records")
    }


def _spreads(study: StudyFolder) -> Iterator[Picture]:
    cells = [
        (context, label, cell)
        for context in contexts(study)
        for label, cell in context.cells.items()
    ]
    colours = level_colours(compared_labels(study), baseline_label(study))
    rows = [Row(label, context.short) for context, label, _ in cells]
    if len({label for _, label, _ in cells}) == 1:
        rows = [Row(context.short or label) for context, label, _ in cells]
    for place, (what, names) in enumerate(SPREADS.items()):
        columns = [_spread(study, name, [cell for _, _, cell in cells]) for name in names]
        columns = [c for c in columns if max(len(v) for v in c.values) >= FEWEST_SPREAD]
        if not columns:
            continue
        yield Picture(
            name=f"distributions_{'time' if place == 0 else 'safety'}",
            section="cells",
            caption=(
                f"Spread of the runs of each cell, {what}: a line from the 5th to the 95th "
                "percentile, a bar over the middle half, the median as a tick, the mean as a dot."
            ),
            alt=f"Spread per cell of {', '.join(column.quantity for column in columns)}.",
            figure=distributions_figure(
                rows, [colours[label] for _, label, _ in cells], columns, title=what.capitalize()
            ),
        )


def _spread(study: StudyFolder, name: str, cells: Sequence[int]) -> DistributionColumn:
    values = _by_cell(study, name)
    quantity = metric(name)
    return DistributionColumn(quantity.label, quantity.unit, [values[cell] for cell in cells])


def _by_cell(study: StudyFolder, name: str) -> dict[int, NDArray[np.float64]]:
    """Return a metric's finite numbers for each cell."""
    numbers = pd.to_numeric(study.runs[name], errors="coerce").to_numpy(float)
    cell = study.runs["cell"].to_numpy()
    kept = np.isfinite(numbers)
    return {c.number: numbers[kept & (cell == c.number)] for c in study.design.cells}


def _trade_off(study: StudyFolder) -> Iterator[Picture]:
    times = _by_cell(study, "completion_time")
    name = "completion_time" if any(v.size for v in times.values()) else "total_wait"
    x, y = _by_cell(study, name), _by_cell(study, "close_passes")
    confidence = study.definition.comparison.confidence
    points = [
        TradeOffPoint(
            " / ".join(context.key), label, float(x[cell].mean()), float(y[cell].mean()),
            possible(mean_interval(x[cell], confidence)),
            possible(mean_interval(y[cell], confidence)),
        )
        for context in contexts(study)
        for label, cell in context.cells.items()
        if x[cell].size and y[cell].size
    ]  # fmt: skip
    if not points:
        return
    labels = [label for label in compared_labels(study) if any(p.level == label for p in points)]
    factors = " / ".join(contexts(study)[0].levels)
    tags = f" Beside each point: {factors}." if factors else ""
    time, passes = metric(name), metric("close_passes")
    yield Picture(
        name="tradeoff",
        section="trade-off",
        caption=(
            f"Mean {time.label} against mean {passes.label} of each cell, with "
            f"{100.0 * confidence:g} % intervals of the means (Student's t, as far as they are "
            f"possible). Down and to the left is better; a thin line joins cells that differ in "
            f"{study.definition.comparison.factor} alone.{tags}"
        ),
        alt="; ".join(
            f"{p.context} {p.level}: {p.x:.2f} {time.unit}, {p.y:.2f} {passes.label}"
            for p in points
        ),
        figure=tradeoff_figure(
            sorted(points, key=lambda point: labels.index(point.level)),
            level_colours(compared_labels(study), baseline_label(study)),
            x_label=(f"Mean {time.label}", time.unit),
            y_label=(f"Mean {passes.label}", passes.unit),
        ),
    )


def _fronts(study: StudyFolder) -> Iterator[Picture]:
    """Draw the cost of each level to the ego against its cost to the people."""
    frame, compared = study.fronts, study.definition.comparison.factor
    if frame.empty:
        return
    several = frame["ego"].nunique() > 1
    panels: list[tuple[str, list[FrontPoint]]] = []
    rows = frame.to_dict("records")
    for context in contexts(study):
        here = [row for row in rows if context_key(study, row) == context.key]
        for ego in dict.fromkeys(str(row["ego"]) for row in here):
            points = [_front_point(row, compared) for row in here if str(row["ego"]) == ego]
            named = [level.label for level in context.levels.values()]
            heading = named[0] if len(named) == 1 else context.short
            panels.append((f"{heading} ({ego})" if several else heading, points))
    percent = 100.0 * study.definition.comparison.confidence
    for number, first in enumerate(range(0, len(panels), PANELS_PER_PICTURE), start=1):
        part = panels[first : first + PANELS_PER_PICTURE]
        yield Picture(
            name="fronts" if number == 1 else f"fronts_{number}",
            section="trade-off",
            caption=(
                "The ego's mean time to its goal against the mean delay of the people, whose "
                f"twin does not feel it, with {percent:g} % intervals. Down and to the left is "
                "better for both. Filled, and joined by the dashed line: no other level is better "
                "on both sides. fronts.csv has the numbers."
            ),
            alt="; ".join(
                f"{heading} {p.level}: {p.x:.2f} s, {p.y:.2f} s{', on the front' * p.front}"
                for heading, points in part
                for p in points
            ),
            figure=fronts_figure(
                part,
                level_colours(compared_labels(study), baseline_label(study)),
                x_label=("Ego's mean time to its goal", "s"),
                y_label=("People's mean delay", "s"),
            ),
        )


def _front_point(row: Mapping[Any, Any], compared: str) -> FrontPoint:
    return FrontPoint(
        level_label(row[compared]),
        float(row["ego_time"]),
        float(row["people_delay"]),
        (float(row["ego_time_low"]), float(row["ego_time_high"])),
        (float(row["people_delay_low"]), float(row["people_delay_high"])),
        bool(row["front"]),
    )
