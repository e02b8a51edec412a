"""The output that several commands share: findings, a file's place, errors in writing it."""

import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rich import markup
from rich.console import Console
from rich.table import Column, Table
from rich.text import Text

from giveway.cli.exit import visible
from giveway.errors import ResultsError
from giveway.results.json_text import json_text


def escape(text: str) -> str:
    """Return ``text`` with rich's markup escaped, since a user's names may look like it."""
    return markup.escape(visible(text))


def findings_table(
    title: str, styles: Mapping[str, str], findings: Iterable[tuple[str, str, str, str]]
) -> Table:
    """Return a table with a row per finding.

    Args:
        title: Title above the table.
        styles: Style of each level.
        findings: Level, subject, text and remedy of each finding; the remedy may be empty.
    """
    table = Table(
        Column(no_wrap=True),
        Column(no_wrap=True),
        Column(overflow="fold", ratio=1),
        title=Text(title),
        title_justify="left",
        show_header=False,
        box=None,
        pad_edge=False,
    )
    for level, subject, finding, remedy in findings:
        text = Text(visible(finding))  # not markup: ids, names and paths may contain brackets
        if remedy:
            text.append(f"\n-> {remedy}", style="italic")
        table.add_row(Text(level, style=styles[level]), Text(visible(subject)), text)
    return table


def numbers_of(*headings: str) -> list[Column]:
    """Return the columns of a table with names on the left and numbers under these headings."""
    return [Column(), *(Column(escape(heading), justify="right") for heading in headings)]


def print_place(console: Console, what: str, path: Path) -> None:
    """Print where a file has been written, on one line, so that the path can be copied."""
    where = f"{what} in [bold]{escape(str(path))}[/bold]"
    console.print(where, highlight=False, soft_wrap=True)


def print_notes(*notes: str) -> None:
    """Print remarks on standard error, one line each; empty ones are left out."""
    for note in filter(None, notes):
        sys.stderr.write(f"note: {visible(note)}\n")


def print_json(content: dict[str, Any]) -> None:
    """Print the findings of a command for a script: only JSON on standard output."""
    sys.stdout.write(json_text(content))


def print_list(names: dict[str, str], *, as_json: bool) -> None:
    """Print names with their descriptions, one line each, or as JSON."""
    if as_json:
        print_json(names)
        return
    for name, description in names.items():
        sys.stdout.write(f"{name:14} {description}\n")


@contextmanager
def writing(file: Path, remedy: str) -> Iterator[None]:
    """Make the folder of a file that is about to be written.

    Args:
        file: File that is written within the context.
        remedy: Advice for a file that cannot be written.

    Raises:
        ResultsError: the folder or the file cannot be written.
    """
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        yield
    except OSError as error:
        raise ResultsError(
            f"{file}: cannot be written ({error.strerror or error}); {remedy}"
        ) from error
