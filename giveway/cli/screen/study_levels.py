"""The table of levels in a terminal, in parts that fit its width."""

from collections.abc import Iterator, Sequence

from rich import box
from rich.console import Console, Group
from rich.table import Column, Table

from giveway.cli.screen.printing import escape
from giveway.reports.tables.level_table import BETTER, WORSE, LevelTable, Mean, level_table
from giveway.studies.folder.study_folder import StudyFolder

_GAP = 3  # Characters between two columns: padding on both sides, and a blank of the box
_COLOURS = {"better": "green", "worse": "red"}


def print_levels(console: Console, study: StudyFolder) -> None:
    """Print mean and half interval of every level: a block of rows per context."""
    table = level_table(study)
    if not table.rows:
        return
    confidence = f"{100 * study.definition.comparison.confidence:g} %"
    console.print(
        f"Means with half the width of their {confidence} interval; {BETTER} better, {WORSE} worse "
        f"than {escape(table.baseline)}, pair by pair",
        style="bold",
        highlight=False,
    )
    print_level_table(console, table)
    console.print(
        "All metrics and the ends of the intervals: levels.csv; differences: comparison.csv",
        highlight=False,
    )


def print_level_table(console: Console, table: LevelTable) -> None:
    """Print a table of levels in parts that fit the terminal."""
    parts = [_part(table, columns) for columns in _parts(table, console.width)]
    console.print(Group(*parts), highlight=False)


def _text(mean: Mean) -> str:
    return f"{mean.text} {mean.mark or ' '}"  # aligned with rows that have a mark


def _widths(table: LevelTable) -> list[int]:
    """Return the width of each column of means."""
    return [
        max(
            *map(len, _heading(*heading).split("\n")), *(len(_text(r.means[k])) for r in table.rows)
        )
        for k, heading in enumerate(table.headings)
    ]


def _names_width(table: LevelTable) -> int:
    return max(max(len(row.context), len(row.level) + 2) for row in table.rows)


def _parts(table: LevelTable, width: int) -> Iterator[list[int]]:
    """Yield the columns of each part."""
    room = width - _names_width(table)
    part: list[int] = []
    used = 0
    for column, needed in enumerate(_widths(table)):
        if part and used + needed + _GAP > room:
            yield part
            part, used = [], 0
        part.append(column)
        used += needed + _GAP
    yield part


def _part(table: LevelTable, columns: Sequence[int]) -> Table:
    widths = _widths(table)
    headings = {k: escape(_heading(*table.headings[k])) for k in columns}
    drawn = Table(
        Column(overflow="fold"),
        *(Column(h, justify="right", no_wrap=True, width=widths[k]) for k, h in headings.items()),
        box=box.SIMPLE_HEAD,
        pad_edge=False,
        show_edge=False,
    )
    context = ""
    for row in table.rows:
        if row.context != context:
            context = row.context
            drawn.add_row(f"[bold]{escape(context)}[/bold]")
        drawn.add_row(f"  {escape(row.level)}", *(_coloured(row.means[k]) for k in columns))
    drawn.add_row()
    return drawn


def _heading(name: str, unit: str) -> str:
    return f"{name}\n[{unit}]" if unit else name


def _coloured(mean: Mean) -> str:
    colour = _COLOURS.get(mean.verdict)
    text = escape(_text(mean))
    return f"[{colour}]{text}[/{colour}]" if colour else text
