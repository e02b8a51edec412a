"""The command ``giveway study``: the plan, a progress bar, tables, pictures, report."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console

from giveway.cli.commands.study_session import make_study
from giveway.cli.screen.printing import print_json
from giveway.cli.screen.study_summary import print_summary
from giveway.config.files.foreign_code import foreign_code
from giveway.studies.definition import changed, read_definition
from giveway.studies.statistics import confirmatory
from giveway.studies.study_files import find_study
from giveway.studies.study_options import StudyOptions
from giveway.studies.varying import chosen, varied


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
    session = make_study(console, definition, origin, out, options, dry_run=request.dry_run)
    if session is None:
        return 0
    study = session.study
    print_summary(console, study, session.effort)
    if request.report:
        from giveway.cli.commands.report_command import write_all

        imported = {one.name for cell in session.plan.cells for one in foreign_code(cell.config)}
        write_all(study, console, trusted=imported)  # the user has just confirmed these
    if request.as_json:
        print_json(
            {
                "study": str(study.path),
                "runs": len(study.records),
                "made": session.effort.made,
                "failed": len(study.failures),
                "seconds": session.effort.elapsed,
                "levels": study.levels.to_dict("records"),
                "comparison": study.comparison.to_dict("records"),
                "confirmatory": confirmatory(study.comparison, study.definition).to_dict("records"),
            }
        )
    return 1 if len(study.failures) else 0
