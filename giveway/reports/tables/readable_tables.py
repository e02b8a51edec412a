"""A study's frames as readable tables: names in words, units, significant digits only."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from giveway.reports.choice import WorstRun
from giveway.reports.labels import level_label
from giveway.reports.tables.table import Cell, Table, number_cell, verdict_cell, whole_cell
from giveway.reports.wording import (
    digits_for,
    interval,
    number,
    pretty_unit,
    quantity,
    quantity_of,
    share,
)
from giveway.studies.contexts import other_factors, short_name
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.statistics import Metric, confirmatory, is_confirmatory, metric

SHOWN_IN_CELLS = (
    "completion_time",
    "longest_wait",
    "rms_jerk",
    "close_passes",
    "minimum_clearance",
    "minimum_ttc",
    "mpc_feasibility_rate",
)
MOST_FAILURES = 200


def comparison_table(study: StudyFolder) -> Table:
    """Return the whole comparison."""
    frame = study.comparison
    names = _distinguishing(study, frame)
    headings = [*map(short_name, names), "situation", "metric"]
    filters = tuple(range(len(headings)))
    verdict = len(headings) + 2
    headings += ["mean difference", "interval", "verdict", "pairs", "share", "treatment mean"]
    headings += ["baseline mean", "median difference", "q", "kind"]
    labels = {known.name: _with_unit(known) for known in study.metrics}
    primary = is_confirmatory(frame, study.definition)
    rows = [
        [
            *(_level(row[name]) for name in names),
            Cell(row["situation"]),
            Cell(labels[row["metric"]], "text"),
            *_numbers(row),
            Cell("confirmatory" if named else "exploratory"),
        ]
        for row, named in zip(frame.to_dict("records"), primary, strict=True)
    ]
    percent = 100.0 * study.definition.comparison.confidence
    return Table(
        name="comparison-table",
        caption=f"Paired differences, treatment minus baseline, with {percent:g} % intervals",
        headings=headings,
        rows=rows,
        filters=(*filters, verdict, len(headings) - 1),
    )


def _numbers(row: Mapping[Any, Any]) -> list[Cell]:
    wide = row["ci_high"] - row["ci_low"]
    digits = digits_for(wide) if math.isfinite(wide) else 2
    return [
        number_cell(row["mean_difference"], digits),
        Cell(interval(row["ci_low"], row["ci_high"])),
        verdict_cell(str(row["verdict"])),
        whole_cell(row["n"]),
        Cell(share(row["share"]), "number"),
        number_cell(row["treatment_mean"], max(digits, 2)),
        number_cell(row["baseline_mean"], max(digits, 2)),
        number_cell(row["median_difference"], digits),
        _probability(row["q_value"]),
    ]


def _probability(value: float) -> Cell:
    if math.isfinite(value) and value < 0.001:
        return Cell("< 0.001", "number")
    return number_cell(value, 3)


def confirmatory_table(study: StudyFolder) -> Table | None:
    """Return the differences of the primary outcome, or None if the study names none."""
    outcome = study.definition.primary_outcome
    if outcome is None:
        return None
    frame, known = confirmatory(study.comparison, study.definition), metric(outcome.metric)
    names = _distinguishing(study, frame)
    least = quantity_of(outcome.smallest_effect, known.unit)
    rows = [
        [
            *(_level(row[name]) for name in names),
            *_numbers(row)[:4],
            _probability(row["p_holm"]),
            Cell(row["smaller_effects"]),
        ]
        for row in frame.to_dict("records")
    ]
    headings = ["mean difference", "interval", "verdict", "pairs", "p (Holm)"]
    return Table(
        name="confirmatory-table",
        caption=f"Confirmatory differences: {_with_unit(known)}, {outcome.situation}",
        headings=[*map(short_name, names), *headings, f"effects below {least}"],
        rows=rows,
        note=f"The smallest effect of interest is {least}: {outcome.reason}. Excluded: the "
        "interval has larger effects alone. Possible: it has both. Only these: it has smaller "
        "ones alone. The verdict is that of the test after Holm over this table.",
    )


def glance_table(study: StudyFolder) -> Table:
    """Return every metric in the general situation: a column per context and treatment."""
    frame = study.comparison[study.comparison["situation"] == "general"]
    several = frame["treatment"].nunique() > 1
    egos = frame["ego"].nunique() > 1
    names = other_factors(study.design, study.definition.comparison)
    columns: dict[str, dict[str, Mapping[Any, Any]]] = {}
    for row in frame.to_dict("records"):
        parts = [f"{short_name(name)} = {level_label(row[name])}" for name in names]
        parts += [level_label(row["treatment"])] if several or not names else []
        parts += [f"ego {row['ego']}"] if egos else []
        columns.setdefault(", ".join(parts), {})[str(row["metric"])] = row
    rows = []
    for known in study.metrics:
        cells = [_glance(column.get(known.name)) for column in columns.values()]
        if any(cell.kind != "na" for cell in cells):
            rows.append([Cell(_with_unit(known), link=f"#metric-{known.name}"), *cells])
    return Table(
        name="glance-table",
        caption="Mean differences of all pairs: better, worse, or = no difference shown",
        headings=["metric", *columns],
        rows=rows,
    )


def _glance(row: Mapping[Any, Any] | None) -> Cell:
    if row is None or not math.isfinite(row["mean_difference"]) or row["verdict"] == "N.A.":
        return Cell("N.A.", "na")
    text = number(row["mean_difference"], digits_for(row["ci_high"] - row["ci_low"]))
    verdict = str(row["verdict"])
    return Cell(f"{text} {verdict if verdict in {'better', 'worse'} else '='}",
                verdict_cell(verdict).kind)  # fmt: skip


def situations_table(study: StudyFolder) -> Table:
    """Return the numbers of pairs in which both, one or neither stopped."""
    frame = study.situations
    names = _distinguishing(study, frame)
    shares = {
        "share_both_stop": "both stop",
        "share_neither_stops": "neither stops",
        "share_only_treatment_stops": "only treatment stops",
        "share_only_baseline_stops": "only baseline stops",
    }
    rows = [
        [
            *(_level(row[name]) for name in names),
            whole_cell(row["pairs"]),
            *(Cell(share(row[name]), "number") for name in shares),
            whole_cell(row["lost"]),
            whole_cell(row["incomplete"]),
        ]
        for row in frame.to_dict("records")
    ]
    headings = [*map(short_name, names), "pairs", *shares.values()]
    return Table(
        name="situations-table",
        caption="How often the vehicle had to stop",
        headings=[*headings, "lost", "incomplete"],
        rows=rows,
        note="Lost: one side has no result. Incomplete: one side did not reach its goal.",
    )


def cells_table(study: StudyFolder) -> Table:
    """Return each cell: its levels, its runs, means of the main metrics."""
    runs = study.runs
    names = [factor.name for factor in study.design.factors]
    shown = [
        name for name in SHOWN_IN_CELLS if pd.to_numeric(runs[name], errors="coerce").notna().any()
    ]
    rows = []
    for cell in study.design.cells:
        here = runs[runs["cell"] == cell.number]
        lost = here["ending"].isin(["failed", "crashed"])
        rows.append(
            [
                whole_cell(cell.number),
                *(_level(cell.levels[name].label) for name in names),
                whole_cell(here["run"].nunique()),
                whole_cell(int(lost.sum())),
                Cell(share(_completed(here[~lost])), "number"),
                *(_mean(here[name]) for name in shown),
            ]
        )
    quantities = [_with_unit(metric(name)) for name in shown]
    return Table(
        name="cells-table",
        caption="The cells of the study, with means over their runs",
        headings=["cell", *map(short_name, names), "runs", "no result", "completed", *quantities],
        rows=rows,
    )


def _completed(rows: pd.DataFrame) -> float:
    return float(rows["completed"].astype(float).mean()) if len(rows) else math.nan


def _mean(column: pd.Series) -> Cell:
    values = pd.to_numeric(column, errors="coerce").to_numpy(float)
    values = values[np.isfinite(values)]
    return number_cell(float(values.mean()) if values.size else math.nan)


def worst_tables(worst: Iterable[WorstRun], replays: Mapping[str, str]) -> list[Table]:
    """Return one table per reason, in which runs link to their replay."""
    groups: dict[str, list[WorstRun]] = {}
    for run in worst:
        groups.setdefault(run.reason, []).append(run)
    tables = []
    for number_, (reason, runs) in enumerate(groups.items(), start=1):
        paired = any(run.partner for run in runs)
        what = "difference of " if paired else ""
        headings = [what + metric(runs[0].metric).label, "run"]
        headings += ["baseline's run"] if paired else []
        egos = any(run.ego not in {"", "ego"} for run in runs)
        headings += ["ego"] if egos else []
        rows = [
            [
                Cell(quantity(run.value, run.unit), "number"),
                Cell(run.run, link=replays.get(run.run, "")),
                *([Cell(run.partner, link=replays.get(run.partner, ""))] if paired else []),
                *([Cell(run.ego)] if egos else []),
                Cell(run.cell, "text"),
            ]
            for run in runs
        ]
        tables.append(Table(f"worst-{number_}", reason, [*headings, "levels"], rows))
    return tables


def failures_table(study: StudyFolder) -> Table:
    """Return the runs without a result, the reason, and how to repeat them."""
    frame = study.failures
    rows = [
        [
            Cell(str(row["run"])),
            Cell(str(row["ending"])),
            Cell(str(row["cause"]), "text"),
            Cell(str(row["reproduce"]), "code"),
        ]
        for row in frame.head(MOST_FAILURES).to_dict("records")
    ]
    more = len(frame) - len(rows)
    return Table(
        name="failures-table",
        caption="Runs without a result",
        headings=["run", "ending", "cause", "to make it again"],
        rows=rows,
        note=f"{more:,} more are in failures.csv." if more > 0 else "",
    )


def settings_table(name: str, caption: str, values: Mapping[str, object]) -> Table:
    """Return names and values, as in a manifest."""
    rows = [[Cell(str(key)), Cell(str(value))] for key, value in values.items()]
    return Table(name, caption, ["name", "value"], rows)


def _distinguishing(study: StudyFolder, frame: pd.DataFrame) -> list[str]:
    """Return the columns that distinguish the rows of ``frame``, without situation and metric."""
    names = other_factors(study.design, study.definition.comparison)
    names = [name for name in names if name in frame.columns]
    return names + [name for name in ("ego", "treatment") if frame[name].nunique() > 1]


def _level(value: object) -> Cell:
    label = level_label(value)
    try:
        float(label)
    except ValueError:
        return Cell(label)
    return Cell(label, "number")


def _with_unit(known: Metric) -> str:
    return f"{known.label} [{pretty_unit(known.unit)}]" if known.unit else known.label
