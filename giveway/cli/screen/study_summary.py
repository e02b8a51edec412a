"""The output of ``giveway study``: the plan before the runs, the findings after them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rich import box
from rich.padding import Padding
from rich.table import Column, Table

from giveway.cli.screen.printing import escape
from giveway.cli.screen.study_levels import print_levels
from giveway.reports.findings_in_words import primary_outcome
from giveway.reports.labels import level_label
from giveway.reports.wording import counted
from giveway.studies.contexts import other_factors
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.plan import Plan
from giveway.studies.statistics import METRICS, metric, precise_enough

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

_SHOWN = (
    ("completion_time", "general"),
    ("longest_wait", "stop-and-wait"),
    ("completion_time", "non-stop"),
    ("rms_jerk", "general"),
    ("close_passes", "general"),
    ("minimum_clearance", "general"),
    ("overlaps", "general"),
    ("mean_people_delay", "general"),
)
_OF_TWINS = frozenset({"mean_people_delay"})  # not shown in a study without counterfactual runs
_MOST_ROWS = 40  # Largest number of rows: about a screen; comparison.csv has all
_BYTES_PER_RUN = 4096  # Size [bytes] of a run's file: a block on most disks


def print_plan(
    console: Console, planned: Plan, seconds: float, by_cell: Mapping[str, float], out: Path
) -> None:
    """Print the cells, and what running them will take."""
    definition = planned.definition
    title = f"Study {definition.name}"
    title += f": {definition.description}" if definition.description else ""
    names = (escape(factor.name) for factor in planned.design.factors)
    table = Table(
        Column("cell", justify="right"),
        *(Column(name, justify="right", overflow="fold") for name in names),
        Column("s per run", justify="right"),
        title=escape(title),
    )
    for entry in planned.cells:
        labels = [escape(level.label) for level in entry.cell.levels.values()]
        number = str(entry.cell.number)
        table.add_row(number, *labels, _trial(by_cell[number]))
    console.print(table)
    most = "at most " if definition.precision is not None else ""
    first, last = planned.seeds[0], planned.seeds[-1]
    seeds = f"seed {first}" if first == last else f"seeds {first} to {last}"
    console.print(
        f"{most}{counted(len(planned), 'run')}: {counted(len(planned.cells), 'cell')} with "
        f"{seeds}; about {_duration(seconds)} and {len(planned) * _BYTES_PER_RUN / 1e6:.1f} MB in "
        f"{escape(str(out))}",
        highlight=False,
    )


def _trial(seconds: float) -> str:
    return "failed" if math.isnan(seconds) else f"{seconds:.3f}"


class Effort(NamedTuple):
    """The number of runs that a session has made, and what they took."""

    made: int
    elapsed: float  # time [s]
    workers: int | None  # number of processes, or None if a cluster made them


def print_summary(console: Console, study: StudyFolder, effort: Effort) -> None:
    """Print the main results of the study, its failures, and the places of the files."""
    if study.definition.reference:
        _print_reference(console, study)
    elif study.definition.table == "levels":
        print_levels(console, study)
    else:
        print_comparison(console, study)
    if study.definition.primary_outcome is not None and len(study.comparison):
        console.print(escape(primary_outcome(study)), highlight=False)
    _print_precision(console, study)
    print_runs(console, study, effort)


def print_runs(console: Console, study: StudyFolder, effort: Effort) -> None:
    """Print the number of runs, the time that they took, and those without a result."""
    made, elapsed, workers = effort
    by = "" if workers is None else f" on {counted(workers, 'worker')}"
    there = len(study.records)
    new = "" if made == there else f", {made:,} of them made now,"
    console.print(
        f"{counted(there, 'run')}{new} in {_duration(elapsed)}{by}; tables in "
        f"[bold]{escape(str(study.path))}[/bold]",
        highlight=False,
    )
    failures = study.failures
    if len(failures):
        first = failures.iloc[0]
        cells = list(dict.fromkeys(str(cell) for cell in failures["cell"]))
        where = f"cell{'s'[: len(cells) > 1]} {', '.join(cells[:8])}{' ...' * (len(cells) > 8)}"
        verb = "has" if len(failures) == 1 else "have"
        console.print(
            f"[yellow]{len(failures):,} of {counted(there, 'run')} {verb} no result[/yellow] "
            f"({where}), see failures.csv; the first, "
            f"{escape(str(first['run']))}: {escape(str(first['cause']))}; --resume --retry-failed "
            "makes them again",
            highlight=False,
        )


def print_comparison(console: Console, study: StudyFolder) -> None:
    """Print mean differences with intervals: a table per metric, a row per context and level."""
    comparison = study.comparison
    if comparison.empty:
        return
    if study.runs["mean_speed"].isna().all() and study.failures.empty:
        console.print("The runs have no ego: every metric is an ego's, nothing can be compared")
        return
    wanted = study.definition.comparison
    treatments = comparison["treatment"].unique()
    what = f"{treatments[0]} minus" if len(treatments) == 1 else "difference to"
    console.print(
        f"{escape(f'{wanted.factor}: {what} {wanted.baseline}')}, pair by pair: better, worse, or "
        "= no difference shown",
        style="bold",
        highlight=False,
    )
    missing, left, fewest = [], _MOST_ROWS, math.inf
    known_metrics = {known.name: known for known in study.metrics}
    own = [(known.name, "general") for known in study.metrics[len(METRICS) :]]
    primary = study.definition.primary_outcome
    first = [] if primary is None else [(primary.metric, primary.situation)]
    for name, situation in dict.fromkeys((*first, *_SHOWN, *own)):
        known = known_metrics[name]
        chosen = comparison[(comparison["metric"] == name) & (comparison["situation"] == situation)]
        few = chosen[chosen["verdict"] == "N.A."]["n"]
        if (chosen["n"] == 0).all():
            if name not in _OF_TWINS:
                missing.append(f"{known.label} ({situation})")
        elif left > 0:
            fewest = min(fewest, few[few > 0].min() if (few > 0).any() else math.inf)
            unit = f" [{known.unit}]" if known.unit else ""
            title = f"{known.label}{unit}, {situation}: {known.better} is better"
            console.print(f"\n {escape(title)}", highlight=False)
            table = _metric_table(study, chosen.head(left))
            console.print(Padding(table, (0, 0, 0, 1)))
            left -= len(chosen)
    _print_lacking(console, study, fewest)
    if missing:
        console.print(f"In no pair on both sides: {', '.join(missing)}", highlight=False)
    console.print(
        f"All {len(known_metrics)} metrics, in every situation and context: comparison.csv, and "
        f"giveway report {escape(str(study.path))}",
        highlight=False,
    )


def _print_lacking(console: Console, study: StudyFolder, fewest: float) -> None:
    """Print how many pairs are missing for intervals, if ``fewest`` pairs are too few."""
    if fewest < math.inf:
        wanted = study.definition.comparison.minimum_pairs
        more = wanted - int(fewest)
        console.print(
            f"Intervals need {wanted} pairs: {more} more where there are "
            f"{int(fewest)}; --resume --runs {_seeds_for(study, more)} adds seeds",
            highlight=False,
        )


def _metric_table(study: StudyFolder, chosen: pd.DataFrame) -> Table:
    wanted = study.definition.comparison
    names = other_factors(study.design, wanted)
    names += ["ego"] if study.comparison["ego"].nunique() > 1 else []
    names += ["treatment"] if study.comparison["treatment"].nunique() > 1 else []
    short = _short([wanted.factor if name == "treatment" else name for name in names])
    numbers = ("mean", f"{100 * wanted.confidence:g} % interval", "n")
    table = Table(
        *(Column(escape(heading), overflow="fold") for heading in short),
        *(Column(heading, justify="right", no_wrap=True) for heading in numbers),
        Column(no_wrap=True),
        box=box.SIMPLE_HEAD,
        pad_edge=False,
        show_edge=False,
    )
    for row in chosen.to_dict("records"):
        table.add_row(*(escape(level_label(row[name])) for name in names), *_cells(row))
    return table


def _seeds_for(study: StudyFolder, more: int) -> int:
    """Return the number of seeds for ``more`` further pairs, if each seed gives one."""
    return study.definition.replications + more


def _short(names: Sequence[str]) -> Iterator[str]:
    """Yield the last part of each factor's name, if no two of them are the same."""
    last = [*(name.rpartition(".")[2] for name in names), "seed"]  # the seed is the crowd's
    for name, short in zip(names, last, strict=False):
        yield short if short and last.count(short) == 1 else name


def _cells(row: Mapping[Any, Any]) -> tuple[str, ...]:
    if math.isnan(row["mean_difference"]):
        return "N.A.", "", f"{row['n']:,}", ""
    if math.isnan(row["ci_low"]):
        return f"{row['mean_difference']:+.3f}", "", f"{row['n']:,}", ""
    interval = f"{row['ci_low']:+.3f} ... {row['ci_high']:+.3f}"
    verdict = row["verdict"] if row["verdict"] in {"better", "worse"} else "="
    return f"{row['mean_difference']:+.3f}", interval, f"{row['n']:,}", verdict


def _print_precision(console: Console, study: StudyFolder) -> None:
    """Print whether the seeds were enough, if the study sets a precision."""
    wanted = study.definition.precision
    if wanted is None:
        return
    seeds, most = len(study.seeds), study.definition.replications
    enough = seeds < most
    if not enough:
        compared = study.definition.comparison
        enough, _ = precise_enough(study.runs, study.design, compared, wanted, seeds=seeds)
    known = metric(wanted.metric)
    what = f"{known.label} ({wanted.situation}) to {wanted.width:g} {known.unit}".rstrip()
    if enough:
        console.print(f"Precise enough, {what}, with {counted(seeds, 'seed')}", highlight=False)
    else:
        console.print(
            f"[yellow]Not precise enough[/yellow], {what}, with all {counted(seeds, 'seed')}: "
            "allow more by --runs and --resume",
            highlight=False,
        )


def _print_reference(console: Console, study: StudyFolder) -> None:
    from giveway.studies.statistics import PUBLISHED, table2

    frame = table2(study.comparison)
    if frame.empty:
        print_comparison(console, study)
        return
    others = list(frame.columns[: list(frame.columns).index("ego")])
    situations = list(dict.fromkeys(situation for _, situation in PUBLISHED))
    percent = f"{100 * study.definition.comparison.confidence:g} %"
    title = f"Yang & Özgüner 2019, table 2: MPC minus PID in s, mean and {percent} interval"
    what = {"stop-and-wait": "longest wait"}
    headings = [f"{one}\n({what.get(one, 'completion time')})" for one in situations]
    table = Table(
        *map(escape, (*others, "pedestrians")),
        *(Column(heading, justify="right") for heading in headings),
        title=escape(title),
        show_lines=True,
    )
    for context, rows in frame.groupby([*others, "ego", "pedestrians"], sort=False):
        labels = [escape(str(value)) for value in (*context[: len(others)], context[-1])]
        by_situation = rows.set_index("situation").to_dict("index")
        table.add_row(*labels, *(_ours_and_published(by_situation[name]) for name in situations))
    console.print(table)
    few = frame.loc[(frame["verdict"] == "N.A.") & (frame["n"] > 0), "n"]
    _print_lacking(console, study, few.min() if len(few) else math.inf)


def _ours_and_published(row: Mapping[Any, Any]) -> str:
    """Return the study's number above the published one."""
    published = "N.A." if math.isnan(row["published"]) else f"{row['published']:+.2f}"
    if math.isnan(row["mean_difference"]):
        ours = "N.A."
    else:
        known = not math.isnan(row["ci_low"])
        interval = f"\n{row['ci_low']:+.2f} ... {row['ci_high']:+.2f}" if known else ""
        ours = f"[bold]{row['mean_difference']:+.2f}[/bold]{interval}"
    return f"{ours}\nn = {row['n']:,}\npaper {published}"


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    if seconds < 5400:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h"
