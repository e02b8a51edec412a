"""The command ``giveway ncap``: a car in consumer tests with people, and their table."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from giveway._version import __version__
from giveway.cli.commands.study_session import make_study
from giveway.cli.screen.ncap_table import print_ncap
from giveway.cli.screen.printing import print_json, print_place
from giveway.cli.screen.study_summary import print_runs
from giveway.errors import ResultsError
from giveway.ncap.request import NcapRequest, forget_course, requested_ncap
from giveway.ncap.table import DriverTable, outcomes_of, tables_of, write_ncap
from giveway.reports.ncap_page import ncap_page
from giveway.studies.folder.atomic_files import write_atomically
from giveway.studies.folder.lock import NCAP_FILES
from giveway.studies.plan import Plan
from giveway.studies.study_options import StudyOptions


def ncap_command(
    request: NcapRequest,
    options: StudyOptions,
    *,
    dry_run: bool = False,
    quiet: bool = False,
    as_json: bool = False,
) -> int:
    """Test a car and return the exit code: 0, or 1 if cells have no result.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet or as_json)
    asked = requested_ncap(request)
    try:
        session = make_study(
            console, asked.definition, "giveway ncap", asked.out, options, dry_run=dry_run
        )
    finally:
        forget_course(request, asked.out)
    if session is None:
        return 0
    outcomes = outcomes_of(session.study, asked.protocol, asked.runs, asked.width)
    tables = tables_of(asked.protocol, outcomes, asked.measured)
    frame = write_ncap(asked.out, tables)
    page = ncap_page(asked.protocol, tables, _facts(request, session.plan), _footer(request))
    write_atomically(asked.out / NCAP_FILES[1], page)
    if all(one.failure for one in outcomes):
        raise ResultsError(f"{asked.out}: no cell has a result; {outcomes[0].failure}")
    print_ncap(console, tables)
    print_runs(console, session.study, session.effort)
    print_place(console, "Table", asked.out / NCAP_FILES[1])
    if as_json:
        print_json(
            {
                "ncap": str(asked.out),
                "protocol": asked.protocol.title,
                "points": _points(tables[0]),
                "table": frame.to_dict("records"),
            }
        )
    return 1 if any(one.failure for one in outcomes) else 0


def _points(table: DriverTable) -> float | None:
    rating = table.rating
    return None if rating is None else rating.total


def _facts(request: NcapRequest, plan: Plan) -> list[tuple[str, str]]:
    """Return facts about the car and its perception."""
    (config, *_) = plan.cells[0].config.each_ego()
    latency = float(config.sensor_options.get("latency", 0.0))  # type: ignore[arg-type]
    width = config.vehicle.width or 2.0
    return [
        ("car", Path(request.car).name),
        ("width", f"{width:g} m"),
        ("sensor", config.perception.sensor),
        ("latency", f"{latency:g} s"),
        ("people out of hiding", f"{config.safety.hidden_speed:g} m/s"),
        ("assumption about people", config.safety.people),
    ]


def _footer(request: NcapRequest) -> str:
    profile = "" if request.profile is None else f" with the profile {request.profile.name}"
    return (
        f"giveway {__version__}, {Path(request.car).name}{profile}, seed {request.seed}. "
        "docs/ncap.md tells sources and limits."
    )
