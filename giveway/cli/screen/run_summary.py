"""The summary of a run on one screen."""

from collections.abc import Iterator
from itertools import groupby

from rich.table import Column, Table
from rich.text import Text

from giveway.config.files.naming import title
from giveway.results.digest import digest, formatted
from giveway.results.run_result import RunResult
from giveway.run_data.tracks import counted

_KNOWN = ("scenario", "controller", "pedestrians", "seed", "ending", "ego")  # by the title


def summary_table(result: RunResult) -> Table:
    """Return a table of the most telling numbers, in groups, with units."""
    names = [ego.id for ego in result.egos] or [""]
    table = Table(
        "",
        "",
        *(Column(Text(name), justify="right") for name in names),
        "",
        title=Text(_title(result)),
        show_header=len(result.egos) > 1,
        title_justify="left",
    )
    for group, lines in groupby(digest(result), lambda line: line.group):
        table.add_section()
        shown = Text(group, style="dim")
        for line in lines:
            table.add_row(shown, line.label, *map(Text, line.values), line.unit)
            shown = Text()
    return table


def explanation(result: RunResult) -> Table:
    """Return a table of all numbers of ``summary.csv`` with their meanings."""
    rows = result.summary_rows
    names = [ego.id for ego in result.egos] or [""]
    table = Table(
        Column("column", overflow="fold", min_width=16),
        *(Column(Text(name), justify="right") for name in names),
        "unit",
        Column("meaning", overflow="fold"),
        title="All numbers of summary.csv",
        title_justify="left",
    )
    for column in result.schemas["summary"]:
        if column.name not in _KNOWN:
            cells = (formatted(row[column.name], "") for row in rows)
            table.add_row(column.name, *cells, column.unit or "", Text(column.description))
    for label, count in _counts(result):
        table.add_row("", count, *[""] * (len(names) - 1), "", label)
    return table


def _title(result: RunResult) -> str:
    config = result.egos[0].config if len(result.egos) == 1 else result.config
    who = f"{len(result.egos)} egos" if len(result.egos) > 1 else ""
    people = counted(len(result.crowd_track.ids))
    return f"{title(config, result.scenario.name, people, who)} - {result.ending}"


def _counts(result: RunResult) -> Iterator[tuple[str, str]]:
    """Yield the numbers of persons by their origin and end, and of vehicles that yielded."""
    for name, number in (result.manifest["pedestrians"] | result.manifest["traffic"]).items():
        if number:
            yield f"{name.replace('_', ' ')} (manifest.json)", f"{number:g}"
