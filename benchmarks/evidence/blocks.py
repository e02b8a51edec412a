"""Blocks of measured text in pages, between marks that name them; each says its version.

A block begins with ``<!-- evidence: NAME -->`` and ends with ``<!-- end -->``. Its first line says
of which commit, day and sample it is. ``docs/blocks.json`` has a digest of each block as its
command wrote it, by its name, so that a number that is changed by hand is found.
"""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
from pathlib import Path

from digests import HOUSE

BLOCK = re.compile(r"<!-- evidence: (?P<name>[^>]+?) -->\n(?P<text>.*?)<!-- end -->", re.DOTALL)
DIGESTS = HOUSE / "docs" / "blocks.json"
PACKAGES = ("giveway", "controller", "pedestrian_model", "fmus", "sumo_scenarios")


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


def digests_of(page: str) -> list[tuple[str, str]]:
    """The name and digest of each block of a page."""
    return [
        (match["name"], hashlib.sha256(match["text"].encode()).hexdigest()[:16])
        for match in BLOCK.finditer(page)
    ]


def write_block(
    file: Path, name: str, lines: list[str], version: str, digests: Path = DIGESTS
) -> None:
    """Write the lines of one block into its page, and its digest in the place of the former one."""
    before = file.read_text(encoding="utf-8")
    page = filled(before, name, lines, version)
    file.write_text(page, encoding="utf-8")
    entries = json.loads(digests.read_text(encoding="utf-8"))
    former, new = dict(digests_of(before))[name], dict(digests_of(page))[name]
    entries[name] = sorted({*entries.get(name, ()), new} - ({former} - {new}))
    digests.write_text(json.dumps(dict(sorted(entries.items())), indent=1) + "\n", encoding="utf-8")
