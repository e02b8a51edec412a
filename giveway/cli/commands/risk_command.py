"""The command ``giveway risk``: the probability of an event in a run, with its interval."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rich.console import Console

from giveway.cli.screen.printing import print_json, print_place
from giveway.cli.screen.risk_summary import print_risk
from giveway.cli.screen.study_progress import study_progress
from giveway.precompile import compile_kernels_once
from giveway.risk.pictures import write_pictures
from giveway.risk.requested import requested_risk
from giveway.risk.session import run_risk
from giveway.risk.tables import per_kilometre
from giveway.studies.study_options import StudyOptions

_UNPRINTED = {"stages", "sample"}  # Attributes of an estimate that are no part of the JSON


@dataclass(frozen=True)
class RiskRequest:
    """The risk that the user wants to know, and what is to be shown."""

    subject: str
    changes: dict[str, Any]  # keys of the risk; None where a flag is not given
    fixed: tuple[str, ...]
    random: tuple[str, ...]
    config: Path | None
    out: Path | None
    pictures: bool
    quiet: bool
    as_json: bool


def risk_command(request: RiskRequest, options: StudyOptions) -> int:
    """Estimate a probability and return the exit code: 0, or 1 if runs have no result.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=request.quiet or request.as_json)
    definition, origin = requested_risk(
        request.subject, request.changes, request.fixed, request.random, request.config
    )
    out = request.out or Path("results") / f"risk_{definition.name}"
    compile_kernels_once(console)
    with study_progress(console, definition.name) as watcher:
        folder = run_risk(definition, origin, out, options, watcher)
    print_risk(console, folder)
    if request.pictures:
        write_pictures(folder)
    print_place(console, "Tables and picture", out)
    if request.as_json:
        estimate = {
            key: value for key, value in asdict(folder.estimate).items() if key not in _UNPRINTED
        }
        kilometre = asdict(per_kilometre(folder, folder.estimate))
        print_json({"risk": str(out), "event": definition.event, **estimate, "per_km": kilometre})
    return 1 if any(record.failed for _, record in folder.runs) else 0
