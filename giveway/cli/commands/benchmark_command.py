"""The command ``giveway benchmark``: the drives of a controller in frozen scenes, and the table."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from rich.console import Console

from giveway.cli.commands.study_session import make_study
from giveway.cli.screen.benchmark_table import print_benchmark
from giveway.cli.screen.printing import print_json, print_place
from giveway.cli.screen.study_summary import print_runs
from giveway.studies.benchmark import FILE, ORIGIN, benchmark_of, rivals, write_benchmark
from giveway.studies.definition import changed
from giveway.studies.study_options import StudyOptions
from giveway.studies.varying import chosen


class BenchmarkRequest(NamedTuple):
    """The controllers that the user wants to compare, and how."""

    controllers: tuple[str, ...]
    config: Path | None
    only: tuple[str, ...]
    runs: int | None
    out: Path | None
    dry_run: bool
    quiet: bool
    as_json: bool = False


def benchmark_command(request: BenchmarkRequest, options: StudyOptions) -> int:
    """Drive the controllers through the benchmark and return the exit code.

    It is 1 if some drives have no result, otherwise 0.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=request.quiet or request.as_json)
    definition = benchmark_of(request.controllers, request.config)
    changes: dict[str, Any] = {}
    if request.only:
        changes["only"] = chosen(request.only)
    if request.runs is not None:
        changes["replications"] = request.runs
    definition = changed(definition, changes, ORIGIN)
    out = request.out or Path("results") / definition.name
    session = make_study(console, definition, ORIGIN, out, options, dry_run=request.dry_run)
    if session is None:
        return 0
    study = session.study
    table = write_benchmark(study)
    kept = rivals()
    print_benchmark(console, table, kept)
    print_runs(console, study, session.effort)
    print_place(console, "Table", out / FILE)
    if request.as_json:
        print_json(
            {
                "study": str(out),
                "failed": len(study.failures),
                "seconds": session.effort.elapsed,
                "table": table.to_dict("records"),
                "rivals": kept.to_dict("records"),
            }
        )
    return 1 if len(study.failures) else 0
