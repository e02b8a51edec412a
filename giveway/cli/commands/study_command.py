"""The command ``giveway study``: the plan, a progress bar, tables, pictures, report."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from giveway.cli.screen.printing import print_json
from giveway.cli.screen.study_summary import print_plan, print_summary
from giveway.config.files.foreign_code import foreign_code
from giveway.precompile import compile_kernels_once
from giveway.processes.processors import processors
from giveway.studies.definition import changed, read_definition
from giveway.studies.plan import plan
from giveway.studies.statistics import confirmatory
from giveway.studies.study import StudyOptions, StudyProgress, estimate, run_study
from giveway.studies.study_files import find_study
from giveway.studies.varying import chosen, varied

_REFRESH = 0.2  # Wall-clock time [s] between two redraws
_LINE = 30.0  # Time [s] between two lines without a terminal


@dataclass(frozen=True)
class StudyRequest:
    """The study that the user requested, and how it is to be computed."""

    study: str | None  # None if the study consists of variations from flags
    vary: tuple[str, ...]
    only: tuple[str, ...]
    config: Path | None
    out: Path | None
    runs: int | None
    first_seed: int | None
    twin: bool | None
    dry_run: bool
    report: bool
    quiet: bool
    as_json: bool = False


def study_command(request: StudyRequest, options: StudyOptions) -> int:
    """Run a study and return the exit code: 0, or 1 if some of its runs have no result.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=request.quiet or request.as_json)
    if request.study is None:
        origin, definition = "--vary", varied(request.vary, request.config)
    else:
        origin, definition = request.study, read_definition(find_study(request.study))
    wanted = {"replications": request.runs, "first_seed": request.first_seed}
    changes: dict[str, Any] = {key: value for key, value in wanted.items() if value is not None}
    if request.only:
        changes["only"] = chosen(request.only)
    if request.twin is not None:
        changes["run"] = definition.run | {"twin": request.twin}
    definition = changed(definition, changes, origin)
    out = request.out or Path("results") / f"study_{definition.name}"
    planned = plan(definition, origin)
    compile_kernels_once(console)
    if request.dry_run:
        with console.status("Trying one run of each cell ..."):
            seconds, by_cell = estimate(planned, options)
        print_plan(console, planned, seconds, by_cell, out)
        return 0
    began = time.monotonic()
    with study_progress(console, definition.name) as watcher:
        study = run_study(definition, origin, out, options, watcher)
    elapsed = time.monotonic() - began
    workers = None if options.cluster else options.jobs or processors()
    print_summary(console, study, made=watcher.made, elapsed=elapsed, workers=workers)
    if request.report:
        from giveway.cli.commands.report_command import write_all

        imported = {one.name for cell in planned.cells for one in foreign_code(cell.config)}
        write_all(study, console, trusted=imported)  # the user has just confirmed these
    if request.as_json:
        print_json(
            {
                "study": str(study.path),
                "runs": len(study.records),
                "made": watcher.made,
                "failed": len(study.failures),
                "seconds": elapsed,
                "levels": study.levels.to_dict("records"),
                "comparison": study.comparison.to_dict("records"),
                "confirmatory": confirmatory(study.comparison, study.definition).to_dict("records"),
            }
        )
    return 1 if len(study.failures) else 0


@contextmanager
def study_progress(console: Console, name: str) -> Iterator[_Watcher]:
    """Show a bar with rate, remaining time and failures.

    Without a terminal, a line is printed from time to time.
    """
    if console.quiet:
        yield _Watcher()
    elif console.is_terminal:
        columns = (
            TextColumn("{task.description}"),
            BarColumn(bar_width=None),
            TextColumn("{task.fields[state]}"),
            TimeRemainingColumn(),
        )
        with Progress(*columns, console=console, transient=True, refresh_per_second=4) as bar:
            yield _Bar(bar, name)
    else:
        yield _Lines(console, name)


class _Watcher:
    """A watcher that counts the runs that this session makes, and shows nothing.

    Attributes:
        made: Number of runs made so far.
    """

    def __init__(self) -> None:
        self._began = time.monotonic()
        self.made = 0

    def __call__(self, state: StudyProgress) -> None:
        self.made = state.made
        self.show(state)

    def show(self, state: StudyProgress) -> None:
        """Show the progress of the study."""

    def text(self, state: StudyProgress) -> str:
        """Return the number of runs so far, runs per second of this session, and failures."""
        elapsed = time.monotonic() - self._began
        rate = state.made / elapsed if elapsed else 0.0
        failed = f"  {state.failed} failed" if state.failed else ""
        return f"{state.finished:,}/{state.total:,} runs  {rate:.1f}/s{failed}"


class _Bar(_Watcher):
    def __init__(self, bar: Progress, name: str) -> None:
        super().__init__()
        self._bar = bar
        self._task = bar.add_task(f"study {name}", total=None, state="")
        self._drawn = 0.0

    def show(self, state: StudyProgress) -> None:
        now = time.monotonic()
        if now - self._drawn < _REFRESH and state.finished < state.total:
            return
        self._drawn = now
        self._bar.update(
            self._task, total=state.total, completed=state.finished, state=self.text(state)
        )


class _Lines(_Watcher):
    def __init__(self, console: Console, name: str) -> None:
        super().__init__()
        self._console = console
        self._name = name
        self._told = time.monotonic()

    def show(self, state: StudyProgress) -> None:
        now = time.monotonic()
        if state.latest is None or now - self._told < _LINE:
            return
        self._told = now
        left = (state.total - state.finished) / state.made * (now - self._began)
        text = f"study {self._name}: {self.text(state)}, about {left / 60.0:.0f} min left"
        self._console.print(text, highlight=False)
