"""A session of a study on the command line: its plan, or its runs with their progress."""

import time
from pathlib import Path
from typing import NamedTuple

from rich.console import Console

from giveway.cli.screen.study_progress import study_progress
from giveway.cli.screen.study_summary import Effort, print_plan
from giveway.precompile import compile_kernels_once
from giveway.processes.processors import processors
from giveway.studies.definition import StudyDefinition
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.plan import Plan, plan
from giveway.studies.study import estimate, run_study
from giveway.studies.study_options import StudyOptions


class Session(NamedTuple):
    """A study of which this session has made the missing runs."""

    study: StudyFolder
    plan: Plan
    effort: Effort


def make_study(
    console: Console,
    definition: StudyDefinition,
    origin: str,
    out: Path,
    options: StudyOptions,
    *,
    dry_run: bool,
) -> Session | None:
    """Make the missing runs of a study; a dry run prints the plan and returns None.

    Args:
        console: Console to print on.
        definition: Definition of the study.
        origin: Place where the definition comes from, for messages.
        out: Folder of the study.
        options: Options of the computation.
        dry_run: True to estimate the time only.

    Raises:
        GivewayError: one line that says what to do.
    """
    planned = plan(definition, origin)
    compile_kernels_once(console)
    if dry_run:
        with console.status("Trying one run of each cell ..."):
            seconds, by_cell = estimate(planned, options)
        print_plan(console, planned, seconds, by_cell, out)
        return None
    began = time.monotonic()
    with study_progress(console, definition.name) as watcher:
        study = run_study(definition, origin, out, options, watcher)
    workers = None if options.cluster else options.jobs or processors()
    return Session(study, planned, Effort(watcher.made, time.monotonic() - began, workers))
