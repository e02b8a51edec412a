"""What ``giveway study`` prints: the plan before, the findings after."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import pandas as pd
    from rich.console import Console

    from giveway.studies.folder import StudyFolder
    from giveway.studies.plan import Plan

_SHOWN = (
    ("completion_time", "general"),
    ("longest_wait", "stop-and-wait"),
    ("completion_time", "non-stop"),
    ("rms_jerk", "general"),
    ("minimum_clearance", "general"),
    ("overlaps", "general"),
)
_BYTES_PER_RUN = 4096  # a file's block on most disks


def print_plan(
    console: Console, planned: Plan, seconds: float, by_cell: Mapping[str, float], out: Path
) -> None:
    """The cells, and what running them will take."""
    definition = planned.definition
    table = Table(title=escape(f"Study {definition.name}: {definition.description}"))
    table.add_column("cell", justify="right")
    for factor in planned.design.factors:
        table.add_column(escape(factor.name), justify="right")
    table.add_column("s per run", justify="right")
    for entry in planned.cells:
        labels = [escape(level.label) for level in entry.cell.levels.values()]
        number = str(entry.cell.number)
        table.add_row(number, *labels, f"{by_cell[number]:.3f}")
    console.print(table)
    most = "at most " if definition.precision is not None else ""
    first, last = planned.seeds[0], planned.seeds[-1]
    console.print(
        f"{most}{len(planned):,} runs: {len(planned.cells)} cells with seeds {first} to {last}; "
        f"about {_duration(seconds)} and {len(planned) * _BYTES_PER_RUN / 1e6:.0f} MB in "
        f"{escape(str(out))}",
        highlight=False,
    )


def print_summary(
    console: Console, study: StudyFolder, elapsed: float, workers: int | None
) -> None:
    """The comparison's main rows, failures, and where everything is."""
    comparison = study.comparison
    if study.definition.reference:
        _print_reference(console, study)
    elif len(comparison):
        console.print(comparison_table(study, comparison))
    by = "" if workers is None else f" on {workers} worker(s)"
    console.print(
        f"{len(study.records):,} runs in {_duration(elapsed)}{by}; tables in "
        f"[bold]{escape(str(study.path))}[/bold]",
        highlight=False,
    )
    failures = study.failures
    if len(failures):
        first = failures.iloc[0]
        console.print(
            f"[yellow]{len(failures)} run(s) have no result[/yellow], see failures.csv; the first: "
            f"{escape(str(first['run']))}: {escape(str(first['cause']))}",
            highlight=False,
        )


def comparison_table(study: StudyFolder, comparison: pd.DataFrame) -> Table:
    """Mean differences with their intervals, a row per context, treatment and metric."""
    compared = study.definition.comparison.factor
    context = [factor.name for factor in study.design.factors if factor.name != compared]
    baseline = comparison["baseline"].iloc[0]
    table = Table(title=escape(f"{compared}: difference to {baseline}, per pair"))
    for name in (*context, compared):
        table.add_column(escape(name))
    for heading in ("situation", "metric", "mean difference", "95 % interval", "n", ""):
        table.add_column(heading, justify="right" if "i" in heading else "left")
    for metric, situation in _SHOWN:
        chosen = comparison[
            (comparison["metric"] == metric) & (comparison["situation"] == situation)
        ]
        for row in chosen.to_dict("records"):
            labels = [escape(str(row[name])) for name in context]
            table.add_row(*labels, escape(str(row["treatment"])), *_cells(row))
    return table


def _cells(row: Mapping[Any, Any]) -> tuple[str, ...]:
    unit = "" if not isinstance(row["unit"], str) else f" {row['unit']}"
    if math.isnan(row["mean_difference"]):
        mean, interval = "N.A.", ""
    else:
        mean = f"{row['mean_difference']:+.3f}{unit}"
        interval = f"{row['ci_low']:+.3f} ... {row['ci_high']:+.3f}"
    return row["situation"], row["metric"], mean, interval, f"{row['n']:,}", row["verdict"]


def _print_reference(console: Console, study: StudyFolder) -> None:
    from giveway.studies.statistics import PUBLISHED, table2

    frame = table2(study.comparison)
    if frame.empty:
        console.print(comparison_table(study, study.comparison))
        return
    others = list(frame.columns[: list(frame.columns).index("ego")])
    situations = list(dict.fromkeys(situation for _, situation in PUBLISHED))
    percent = f"{100 * study.definition.comparison.confidence:g} %"
    title = f"Yang & Özgüner 2019, table 2: MPC minus PID in s, mean and {percent} interval"
    table = Table(title=escape(title), show_lines=True)
    for name in (*others, "pedestrians"):
        table.add_column(escape(name))
    for situation in situations:
        what = "longest wait" if situation == "stop-and-wait" else "completion time"
        table.add_column(f"{situation}\n({what})", justify="right")
    for context, rows in frame.groupby([*others, "ego", "pedestrians"], sort=False):
        labels = [escape(str(value)) for value in (*context[: len(others)], context[-1])]
        by_situation = rows.set_index("situation").to_dict("index")
        table.add_row(*labels, *(_beside(by_situation[name]) for name in situations))
    console.print(table)


def _beside(row: Mapping[Any, Any]) -> str:
    """Ours above, the published number below."""
    published = "N.A." if math.isnan(row["published"]) else f"{row['published']:+.2f}"
    if math.isnan(row["mean_difference"]):
        ours = "N.A."
    else:
        interval = f"{row['ci_low']:+.2f} ... {row['ci_high']:+.2f}"
        ours = f"[bold]{row['mean_difference']:+.2f}[/bold]\n{interval}"
    return f"{ours}\nn = {row['n']:,}\npaper {published}"


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    if seconds < 5400:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h"
