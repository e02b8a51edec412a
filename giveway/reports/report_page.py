"""The report of a study: one self-contained HTML file, and the pictures as files."""

import json
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from giveway.config.files.layers import options
from giveway.errors import ResultsError, remedy
from giveway.figures.style import house_style, save_figure
from giveway.gate import require_no_link, write_whole
from giveway.metrics.ego_fields import EGO_FIELDS
from giveway.reports import findings_in_words as findings
from giveway.reports.choice import ExamplePair, WorstRun, example_pairs, worst_runs
from giveway.reports.embedding import inline_svg
from giveway.reports.examples import TITLES, Drive, example_pictures
from giveway.reports.labels import contexts
from giveway.reports.study_pictures import Picture, study_pictures
from giveway.reports.tables import readable_tables as tables
from giveway.reports.tables.level_table import levels_section
from giveway.reports.tables.published import published_frame, published_table
from giveway.reports.wording import pretty_unit
from giveway.studies.folder.study_folder import StudyFolder

REPORT = "report.html"
FIGURES = "figures"
_FORMATS = (".png", ".svg")
_EXAMPLES = 4  # Largest number of example pairs
_WORST = 5  # Largest number of runs for each reason
_NAMES = ("differences", "forest", "distributions", "tradeoff", "fronts", "example")


@dataclass(frozen=True)
class Drawn:
    """A picture in the page.

    Attributes:
        picture: Picture with its caption; its name is its id on the page.
        title: Title above it; may be empty.
        svg: Picture as SVG for the page.
        links: Label and address of the replays that belong to it.
    """

    picture: Picture
    title: str
    svg: Markup
    links: Sequence[tuple[str, str]] = ()


def shown_runs(
    study: StudyFolder, *, examples: int | None = None, worst: int | None = None
) -> list[str]:
    """Return the ids of the runs that a report with the same arguments names, each once."""
    examples, worst = _as_many(study, examples, worst)
    ids = [run for pair in example_pairs(study, examples) for run in (pair.run, pair.run_baseline)]
    ids += [run for row in worst_runs(study, worst) for run in (row.run, row.partner) if run]
    return list(dict.fromkeys(ids))


def _as_many(study: StudyFolder, examples: int | None, worst: int | None) -> tuple[int, int]:
    """Return the numbers of example pairs and extreme runs that a report shows.

    They grow with the study up to 150 runs, since the runs shown are made again.

    """
    runs = len(study.runs)
    if examples is None:
        examples = min(_EXAMPLES, 1 + runs // 50)
    return examples, min(_WORST, max(1, runs // 30)) if worst is None else worst


def write_report(
    study: StudyFolder,
    *,
    examples: int | None = None,
    worst: int | None = None,
    drives: Callable[[str], Sequence[Drive]] | None = None,
    replay: Callable[[str], Path | None] | None = None,
    target: Path | None = None,
) -> Path:
    """Draw the figures of a study and write its report.

    Both replace existing ones.

    Args:
        study: Folder of the study.
        examples: Largest number of example pairs that are drawn, or None to choose it by the
            study's size.
        worst: Number of runs listed for each reason, or None to choose it by the study's size.
        drives: Function that returns the drives of a run by its id, or None for no examples.
        replay: Function that returns the page that plays a run by its id, or None for no links.
        target: File to write, or None for ``report.html`` in the study's folder. Figures go to the
            folder ``figures`` of the study.

    Returns:
        The file that was written.

    Raises:
        ResultsError: the report cannot be written.
    """
    target = study.path / REPORT if target is None else target
    folder = study.path / FIGURES
    shown = shown_runs(study, examples=examples, worst=worst)
    replays = _replays(shown, replay, target)
    examples, worst = _as_many(study, examples, worst)
    pairs, extremes = example_pairs(study, examples), worst_runs(study, worst)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        require_no_link(folder / "figure", study.path)
        _clear(folder)
        pictures = [_drawn(picture, folder) for picture in study_pictures(study)]
        drawn, missing = _examples(folder, pairs, drives, replays)
        content = _content(study, extremes, replays)
        by_section = {
            name: [drawn for drawn in pictures if drawn.picture.section == name]
            for name in ("differences", "cells", "trade-off")
        }
        html = (
            page_environment()
            .get_template("report.html.j2")
            .render(**content, pictures=by_section, examples=drawn, missing=missing)
        )
        write_whole(target, html.encode("utf-8"))
    except OSError as error:
        raise ResultsError(
            f"{error.filename or target}: cannot be written ({error.strerror}); {remedy(error)}"
        ) from error
    return target


def _replays(
    runs: Iterable[str], replay: Callable[[str], Path | None] | None, target: Path
) -> dict[str, str]:
    """Return the addresses of replays, relative to the report."""
    found = {}
    for run in runs:
        page = None if replay is None else replay(run)
        if page is not None:
            seen = Path(os.path.relpath(page, target.parent)).as_posix()
            found[run] = quote(seen)
    return found


def _clear(folder: Path) -> None:
    """Make the folder of the figures, and remove the figures of a former report."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in _NAMES:
        for suffix in _FORMATS:
            for path in folder.glob(f"{name}*{suffix}"):
                path.unlink()


def _drawn(
    picture: Picture, folder: Path, title: str = "", links: Sequence[tuple[str, str]] = ()
) -> Drawn:
    """Write the picture's files, and draw it for the page."""
    picture.figure.draw_without_rendering()
    with house_style():  # no layout engine, which the user's settings may have chosen
        picture.figure.set_layout_engine(None)  # the arrangement is computed once, for all formats
    for suffix in _FORMATS:
        save_figure(picture.figure, folder / f"{picture.name}{suffix}")
    svg = Markup(inline_svg(picture.figure, picture.name.replace("_", "")))
    return Drawn(picture, title, svg, links)


def _examples(
    folder: Path,
    pairs: Sequence[ExamplePair],
    drives: Callable[[str], Sequence[Drive]] | None,
    replays: dict[str, str],
) -> tuple[list[Drawn], list[str]]:
    if drives is None:
        return [], []
    pictures, missing = example_pictures(pairs, drives)
    shown = []
    for pair, picture in pictures:
        runs = ((pair.treatment, pair.run), (pair.baseline, pair.run_baseline))
        links = [(f"{label} ({run})", replays[run]) for label, run in runs if run in replays]
        shown.append(_drawn(picture, folder, TITLES[pair.reason], links=links))
    return shown, missing


def _content(
    study: StudyFolder, extremes: Sequence[WorstRun], replays: dict[str, str]
) -> dict[str, Any]:
    definition = study.definition
    published = published_frame(study)
    some = not study.comparison.empty
    glance = tables.glance_table(study) if some else None
    return {
        "name": definition.name,
        "title": definition.description or definition.name,
        "lead": findings.lead(study),
        "facts": findings.facts(study),
        "findings": findings.findings(study) if some else [],
        "cautions": findings.cautions(study),
        "published": None if published is None else published_table(published),
        "confirmatory": tables.confirmatory_table(study) if some else None,
        "glance": glance if glance is not None and glance.rows else None,
        "comparison": tables.comparison_table(study) if some else None,
        "levels": levels_section(study),
        "situations": tables.situations_table(study) if len(study.situations) else None,
        "cells": tables.cells_table(study),
        "worst": tables.worst_tables(extremes, replays),
        "failures": tables.failures_table(study) if len(study.failures) else None,
        "execution": tables.settings_table(
            "execution-table", "How it was computed", _execution(study)
        ),
        "glossary": _glossary(study),
        "factors": _factors(study),
        "definition": json.dumps(
            definition.model_dump(mode="json", exclude_none=True), indent=2, ensure_ascii=False
        ),
        "manifest": json.dumps(study.manifest, indent=2, ensure_ascii=False),
        "software": tables.settings_table(
            "software-table", "Versions", study.manifest.get("software", {})
        ),
        "confidence": f"{100.0 * definition.comparison.confidence:g} %",
        "minimum_pairs": definition.comparison.minimum_pairs,
        "contexts": len(contexts(study)),
    }


def _execution(study: StudyFolder) -> dict[str, str]:
    frame = study.execution
    if frame.empty:
        return {}
    seconds, memory = (
        frame[name].astype(float).to_numpy(np.float64) for name in ("seconds", "memory")
    )
    seconds, memory = seconds[np.isfinite(seconds)], memory[np.isfinite(memory)]
    repeated = int((frame["attempts"] > 1).sum())
    workers = frame["worker"].fillna("").astype(str)
    found = {"runs": f"{len(frame):,}", "workers": f"{workers[workers != ''].nunique():,}"}
    if seconds.size:
        found["computing time"] = f"{seconds.sum():,.0f} s"
        found["a run, median"] = f"{1000.0 * float(np.median(seconds)):,.0f} ms"
        found["a run, longest"] = f"{seconds.max():,.2f} s"
        twins = float(np.nansum(frame["twin"].astype(float).to_numpy(np.float64)))
        if twins:
            found["of the computing time, for twins"] = f"{100.0 * twins / seconds.sum():.0f} %"
    if memory.size:
        found["memory of a worker, at most"] = f"{memory.max():,.0f} MB"
    return found | {"runs that were tried again": f"{repeated:,}"}


def _glossary(study: StudyFolder) -> list[dict[str, str]]:
    meanings = {field.name: field.description for field in (*EGO_FIELDS, *study.measured)}
    return [
        {
            "name": metric.name,
            "label": metric.label,
            "unit": pretty_unit(metric.unit),
            "better": metric.better,
            "meaning": meanings[metric.name],
        }
        for metric in study.metrics
    ]


def _factors(study: StudyFolder) -> list[tuple[str, str, str]]:
    """Return name, levels and meaning of each factor."""
    known = {".".join(option.location): option.field.description or "" for option in options()}
    return [
        (
            factor.name,
            ", ".join(level.label for level in factor.levels)
            + (f" [{pretty_unit(factor.unit)}]" if factor.unit else ""),
            known.get(factor.name, ""),
        )
        for factor in study.design.factors
    ]


def page_environment() -> Environment:
    """Return the environment of the templates, with the style and the script of a page."""
    environment = Environment(
        loader=PackageLoader("giveway.reports", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    folder = files("giveway.reports") / "templates"
    for name in ("report.css", "report.js"):
        text = (folder / name).read_text(encoding="utf-8")
        environment.globals[name.replace(".", "_")] = Markup(text)
    return environment
