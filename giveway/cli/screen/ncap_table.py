"""The tables of consumer tests in a terminal: a letter of the colour and the impact speed."""

from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from giveway.cli.screen.printing import escape, numbers_of
from giveway.ncap.table import DriverTable
from giveway.reports.ncap_page import Square, lead_of, matrices_of, reactions_of, verification_of

_STYLES = {
    "green": "green",
    "yellow": "yellow",
    "orange": "dark_orange",
    "brown": "orange4",
    "red": "red",
    "failed": "bold red",
}


def print_ncap(console: Console, tables: Sequence[DriverTable]) -> None:
    """Print the matrices of each driver, and the result in a sentence."""
    for number, table in enumerate(tables):
        if number:
            heading = f"Not a Euro NCAP rating: {escape(table.driver)} drives"
            console.print(heading, style="bold", highlight=False)
        else:
            console.print(table.protocol.title, style="bold", highlight=False)
        for matrix in matrices_of(table):
            lines = Table(*numbers_of(*(f"{speed}" for speed in matrix.speeds)), box=None)
            lines.columns[0].no_wrap = True
            for name, squares in matrix.rows:
                lines.add_row(escape(name), *map(_shown, squares))
            points = f" ({matrix.points})" if matrix.points else ""
            console.print(escape(f"{matrix.name}: {matrix.title}{points}"), highlight=False)
            console.print(lines)
        for name, here, there, verdict in verification_of(table):
            told = f"{name}: {here} km/h, measured {there}: {verdict}"
            console.print(told, highlight=False)
        console.print(lead_of(table), highlight=False)
        if reactions := reactions_of(table):
            console.print(f"[yellow]It brakes though nobody is there:[/] {reactions}")


def _shown(square: Square) -> str:
    """Return the letter of a colour, and the number unless it is 0."""
    if not square.text:
        return ""
    style = _STYLES.get(square.colour, "")
    number = square.text
    if number in {"0.0", "failed"}:
        number = ""
    elif len(number) > len("0.0"):
        number = f"{float(number):.0f}"
    text = escape(square.letter + number)
    return f"[{style}]{text}[/]" if style else text
