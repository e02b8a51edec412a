"""The report of a risk: one self-contained HTML page."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from markupsafe import Markup

from giveway.errors import ResultsError, remedy
from giveway.gate import MANIFEST, read_json, write_whole
from giveway.reports.embedding import inline_svg
from giveway.reports.report_page import REPORT, page_environment
from giveway.reports.tables.table import Cell, Table, number_cell
from giveway.reports.wording import counted
from giveway.risk.cause_tables import given_event_frame, likeliest_frame
from giveway.risk.causes import components_of, events_known
from giveway.risk.definition import dump_risk
from giveway.risk.estimators import LEAST_EVENTS, LEAST_VECTORS
from giveway.risk.pictures import pictures
from giveway.risk.risk_folder import RiskFolder
from giveway.risk.tables import (
    events_frame,
    per_kilometre,
    severity_frame,
    stages_frame,
    why_frame,
)

_WORST = 10  # Largest number of runs in the table of the worst
_INPUTS = 12  # Largest number of inputs in the table of those given the event
_EVENTS = {
    "frontal": "a frontal contact",
    "side": "a contact at a side",
    "contact": "a contact",
    "mais3": "an injury of MAIS3+",
    "red-light": "a red light that is run",
}
_CAPTIONS = {
    "convergence": "The estimate and its interval by the number of runs, or the probability to be "
    "beyond each level, a line for each repeat",
    "region": "Runs with the event among the others, in the plane of the two inputs with the "
    "largest indices; a person's start and speed are in standard deviations",
}


@dataclass(frozen=True)
class Drawn:
    """A picture of the page: its name, its caption, and its drawing."""

    name: str
    caption: str
    svg: Markup


@dataclass(frozen=True)
class Section:
    """A section of the page.

    Attributes:
        name: Id on the page.
        title: Title above it.
        sentences: Items of the list at its head.
        manner: Style class of this list.
        pictures: Pictures below the list.
        tables: Tables below the pictures.
    """

    name: str
    title: str
    sentences: Sequence[str] = ()
    manner: str = "findings"
    pictures: Sequence[Drawn] = ()
    tables: Sequence[Table] = ()


def write_risk_page(risk: RiskFolder, replays: Mapping[str, str] | None = None) -> Path:
    """Write ``report.html`` into the folder of a risk, and return its path.

    Args:
        risk: Folder of the risk.
        replays: Address of the page that plays a run, by the run's id.

    Raises:
        ResultsError: runs are missing, or the disk is full.
    """
    target = risk.path / REPORT
    definition = risk.plan.definition
    page = (
        page_environment()
        .get_template("risk.html.j2")
        .render(
            name=definition.name,
            title=f"How likely is {event_in_words(definition.event)}?",
            lead=answer(risk),
            facts=_facts(risk),
            sections=_sections(risk, replays or {}),
            definition=dump_risk(definition),
            manifest=json.dumps(read_json(risk.path / MANIFEST), indent=2, ensure_ascii=False),
        )
    )
    try:
        write_whole(target, page.encode("utf-8"), within=risk.path)
    except OSError as error:
        raise ResultsError(
            f"{target}: cannot be written ({error.strerror}); {remedy(error)}"
        ) from error
    return target


def event_in_words(event: str) -> str:
    """Return an event of the option ``--event`` with its article."""
    _, beyond, speed = event.partition(">")
    return f"a frontal impact above {speed.strip()} km/h" if beyond else _EVENTS[event]


def answer(risk: RiskFolder) -> str:
    """Return the estimate in words."""
    definition, estimate = risk.plan.definition, risk.estimate
    share = f"{100.0 * definition.confidence:g} %"
    kilometre = per_kilometre(risk, estimate)
    per_km = kilometre.high == kilometre.high  # not nan
    told = f"{event_in_words(definition.event).capitalize()} "
    if not estimate.events or not estimate.probability:
        over = f", or {kilometre.high:.2g} per km" if per_km else ""
        most = f"its probability in a run is below {estimate.high:.2g}{over} ({share}, one-sided)"
        return f"{told}was not met: {most}."
    told += (
        f"has a probability of {estimate.probability:.2g} in a run ({share}: "
        f"{estimate.low:.2g} to {estimate.high:.2g})"
    )
    if per_km:
        told += f", or {kilometre.rate:.2g} per km ({kilometre.low:.2g} to {kilometre.high:.2g})"
    return f"{told}. The interval may not hold, see below." if estimate.doubts else f"{told}."


def _facts(risk: RiskFolder) -> list[tuple[str, str]]:
    definition, estimate = risk.plan.definition, risk.estimate
    names = [one.name for one in risk.plan.inputs.scalars]
    placed = counted(risk.plan.inputs.people, "person") if risk.plan.inputs.people else ""
    return [
        ("scenario", str(risk.plan.config(risk.runs[0][0].vector).scenario)),
        ("method", definition.method),
        ("runs", f"{estimate.runs:,}"),
        ("with the event", f"{estimate.events:,}"),
        ("without a result", f"{estimate.failed:,}"),
        ("random", ", ".join(filter(None, ["the seed", *names, placed]))),
    ]


def _sections(risk: RiskFolder, replays: Mapping[str, str]) -> list[Section]:
    drawn = {
        name: Drawn(name, _CAPTIONS[name], Markup(inline_svg(figure, name)))  # our own drawing
        for name, figure in pictures(risk).items()
    }
    estimate = risk.estimate
    doubts = [f"The interval may not hold: {doubt}." for doubt in estimate.doubts]
    return [
        Section(
            "estimate",
            "Estimate",
            doubts or ["No reason is known to doubt the interval."],
            "cautions" if doubts else "findings",
            [drawn["convergence"]],
            _tables(_table("stages", "Levels and stages", stages_frame(estimate.stages))),
        ),
        Section("weights", "Weights", _weights(risk)),
        Section(
            "severity",
            "Severity",
            [
                "Published curves by the speed of the impact, where they hold; no curve holds for "
                "children and at sides."
            ],
            tables=[_table("severity-table", "Injuries at frontal contacts", severity_frame(risk))],
        ),
        _why(risk, drawn.get("region")),
        Section(
            "failures",
            "Runs with the event",
            ["Any of them is made again by giveway rerun, with all its tables."],
            tables=_tables(
                _table("likeliest", "The likeliest", likeliest_frame(risk), replays),
                _table("worst", "The worst", events_frame(risk).head(_WORST), replays),
            ),
        ),
    ]


def _weights(risk: RiskFolder) -> list[str]:
    """Return how evenly the events share the estimate."""
    sample = risk.estimate.sample
    if sample is None:
        return ["There is no run with the event."]
    weights = sample.weights / sample.weights.sum()
    return [
        f"The estimate rests on {events_known(risk):,} different vectors with the event, worth "
        f"{1.0 / float(weights @ weights):,.0f} of equal weight.",
        f"The largest weight of one is {100.0 * float(weights.max()):.2g} % of all.",
    ]


def _why(risk: RiskFolder, region: Drawn | None) -> Section:
    given, known = given_event_frame(risk), events_known(risk)
    sentences = []
    if given.empty and components_of(risk):
        sentences = [
            f"The inputs given the event are not known: {known:,} different vectors have it, and "
            f"{LEAST_EVENTS} are needed."
        ]
    if risk.indices and risk.indices[0].used < LEAST_VECTORS:
        sentences.append(
            f"The indices of the criticality mean little: they are from {risk.indices[0].used} "
            f"base vectors, and {LEAST_VECTORS} are needed."
        )
    if not risk.indices:
        sentences.append("giveway risk with --why adds the indices of the criticality.")
    tables = _tables(
        _table("given", "Inputs given the event, the most telling first", given.head(_INPUTS)),
        _table("why-table", "Sobol indices of the criticality", why_frame(risk.indices)),
    )
    return Section("why", "Why", sentences, "findings", [] if region is None else [region], tables)


def _tables(*tables: Table) -> list[Table]:
    """Return the tables that have rows."""
    return [table for table in tables if table.rows]


def _table(
    name: str, caption: str, frame: pd.DataFrame, replays: Mapping[str, str] | None = None
) -> Table:
    """Return a frame as a table; columns without any content are left out."""
    filled = frame.dropna(axis=1, how="all")
    filled = filled[[column for column in filled if (filled[column].astype(str) != "").any()]]
    headings = [str(column).replace("_", " ") for column in filled]
    rows = [
        [_cell(column, value, replays or {}) for column, value in row.items()]
        for row in filled.to_dict("records")
    ]
    return Table(name, caption, headings, rows)


def _cell(column: Any, value: Any, replays: Mapping[str, str]) -> Cell:
    if column == "run" and value in replays:
        return Cell(f"{value}: replay", link=replays[value])
    if isinstance(value, bool | str):
        return Cell(str(value), "code" if column == "reproduce" else "")
    if isinstance(value, int):
        return Cell(f"{value:,}", "number")
    return Cell(f"{value:.4g}", "number") if value == value else number_cell(float("nan"))
