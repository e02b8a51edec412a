"""Blocks of measured text in pages, between marks that name them; each says its version.

A block begins with ``<!-- evidence: NAME -->`` and ends with ``<!-- end -->``. Its first line says
of which commit, day and sample it is. What follows is stored in ``docs/measured`` as well, each
table as a CSV and all else as text, so that a number that is changed by hand is found.
"""

from __future__ import annotations

import csv
import io
import re
import subprocess
from collections.abc import Iterable
from itertools import groupby
from pathlib import Path

from digests import HOUSE

BLOCK = re.compile(r"<!-- evidence: (?P<name>[^>]+?) -->\n(?P<text>.*?)<!-- end -->", re.DOTALL)
MEASURED = HOUSE / "docs" / "measured"
PACKAGES = ("giveway", "controller", "pedestrian_model", "fmus", "sumo_scenarios")
_BORDER = re.compile(r"[|: -]+")  # The line between the head and the rows of a table


def block_names(page: str) -> list[str]:
    """Names of all blocks of a page, in their order."""
    return [match["name"] for match in BLOCK.finditer(page)]


def filled(page: str, name: str, lines: list[str], version: str) -> str:
    """The page with other lines in one block.

    Args:
        page: Text of the page.
        name: Name of the block.
        lines: Markdown.
        version: Sentence that says of which commit and sample the lines are.

    Raises:
        ValueError: The page has no block of that name, or more than one.
    """
    if block_names(page).count(name) != 1:
        raise ValueError(
            f"no single block <!-- evidence: {name} --> ... <!-- end -->: expected one in the "
            "page; write both marks where the numbers stand"
        )
    text = "\n".join([f"*{version}*", "", *lines, ""])
    block = f"<!-- evidence: {name} -->\n{text}<!-- end -->"
    return BLOCK.sub(lambda match: block if match["name"] == name else match[0], page)


def present_version() -> tuple[str, str]:
    """Commit and date of the product code; a commit that is not what is there ends with "+"."""
    git = ["git", "-C", str(HOUSE)]
    last = [*git, "log", "-1", "--abbrev=10", "--format=%h %as", "--", *PACKAGES]
    commit, date = subprocess.run(last, capture_output=True, text=True, check=True).stdout.split()
    same = subprocess.run([*git, "diff", "--quiet", "HEAD", "--", *PACKAGES], check=False)
    return commit + "+" * bool(same.returncode), date


def stored_files(page: str, name: str, lines: Iterable[str]) -> dict[str, str]:
    """The files that store a block: the name of each and its text.

    Args:
        page: Name of the page, without its ending.
        name: Name of the block.
        lines: Its lines, without the first one.
    """
    stem = re.sub(r"[^a-z0-9]+", "_", f"{page} {name}".lower()).strip("_")
    parts = [(table, list(part)) for table, part in groupby(lines, lambda line: line[:1] == "|")]
    tables = [_csv(part) for table, part in parts if table]
    ends = [""] if len(tables) == 1 else [f"_{number}" for number in range(1, len(tables) + 1)]
    files = {f"{stem}{end}.csv": text for end, text in zip(ends, tables, strict=True)}
    rest = [line for table, part in parts if not table for line in part if line]
    return files | ({f"{stem}.txt": "\n".join(rest) + "\n"} if rest else {})


def _csv(lines: Iterable[str]) -> str:
    """The cells of a Markdown table as CSV, without the marks of code and of bold letters."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for line in lines:
        if not _BORDER.fullmatch(line):
            cells = re.split(r"(?<!\\)\|", line.strip().strip("|"))
            writer.writerow([re.sub(r"[`*\\]", "", cell).strip() for cell in cells])
    return text.getvalue()


def write_block(
    file: Path, name: str, lines: list[str], version: str, measured: Path = MEASURED
) -> None:
    """Write the lines of one block into its page, with links to the tables that store them."""
    before, new = file.read_text(encoding="utf-8"), stored_files(file.stem, name, lines)
    links = [f"[CSV](measured/{stored})" for stored in new if stored.endswith(".csv")]
    told = "; ".join([version.removesuffix("."), *links]) + "."
    file.write_text(filled(before, name, lines, told), encoding="utf-8")
    former = next(match["text"] for match in BLOCK.finditer(before) if match["name"] == name)
    for gone in stored_files(file.stem, name, former.splitlines()[1:]):
        (measured / gone).unlink(missing_ok=True)
    for stored, text in new.items():
        (measured / stored).write_text(text, encoding="utf-8")
