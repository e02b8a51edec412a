"""The ledger of all pages in docs/evidence.json: the code of each, and how long it took.

A change that leaves the drives as they are does not make a table wrong. So each page keeps digests
of ten fixed runs as well: where these still have the same bytes, ``--confirm`` enters the present
code, and the page says so. For a page without junctions the runs without them count.
"""

from __future__ import annotations

import functools
import hashlib
import json
from pathlib import Path
from typing import Any

import fingerprints
from blocks import present_version
from digests import HOUSE, digest_of
from page import DRIVING, Page

LEDGER = HOUSE / "docs" / "evidence.json"


def read_ledger(file: Path = LEDGER) -> dict[str, dict[str, Any]]:
    """The entries by page; none if the file is missing."""
    if not file.exists():
        return {}
    entries: dict[str, dict[str, Any]] = json.loads(file.read_text(encoding="utf-8"))
    return entries


def page_digest(page: Page) -> str:
    """Digest of a page's code, seeds, sample sizes and commands."""
    return digest_of(page.rooms, repr([(block.name, block.work) for block in page.blocks]))


def rest_digest(page: Page) -> str:
    """Digest of what ten fixed runs do not tell: samples, and rooms that are not about driving."""
    rooms = set(page.rooms) - set(DRIVING)
    return digest_of(rooms, repr([(block.name, block.work) for block in page.blocks]))


@functools.cache
def drive_digests() -> dict[str, str]:
    """Digest of each of ten fixed runs of the present code; takes a minute or more."""
    return {
        name: hashlib.sha256(
            json.dumps(fingerprints.in_a_process(name), sort_keys=True).encode()
        ).hexdigest()[:16]
        for name in fingerprints.RUNS
    }


def drives_the_same(page: Page, before: dict[str, str]) -> bool:
    """Whether the fixed runs that count for a page are as they were.

    Args:
        page: Page.
        before: Digests from :func:`drive_digests` when the page was made.
    """
    now = drive_digests()
    count = [
        name
        for name, settings in fingerprints.RUNS.items()
        if page.junctions or settings.get("scenario") != "junction"
    ]
    return [before.get(name) for name in count] == [now[name] for name in count]


def is_stale(page: Page, entries: dict[str, dict[str, Any]]) -> bool:
    """Whether the code or the sample of a page has changed since it was made."""
    return bool(entries.get(page.name, {}).get("digest") != page_digest(page))


def enter(page: Page, minutes: float, file: Path = LEDGER, **inputs: str) -> None:
    """Write that a page is of the present code.

    Args:
        page: Page that was made.
        minutes: How long its runs took.
        file: JSON file of all pages.
        inputs: SHA-256 of data outside the repository.
    """
    entries = read_ledger(file)
    commit, date = present_version()
    entries[page.name] = {
        "commit": commit,
        "date": date,
        "digest": page_digest(page),
        "minutes": round(minutes, 1),
        **inputs,
    }
    if set(DRIVING) <= set(page.rooms):
        entries[page.name] |= {"rest": rest_digest(page), "drives": drive_digests()}
    _write(entries, file)


def confirm(pages: dict[str, Page], file: Path = LEDGER) -> list[str]:
    """Enter the present code for stale pages whose samples and drives are still the same.

    Args:
        pages: All pages.
        file: JSON file of all pages.

    Returns:
        Names of the pages that are confirmed.
    """
    entries = read_ledger(file)
    commit, date = present_version()
    confirmed = []
    for page in pages.values():
        entry = entries.get(page.name, {})
        if not is_stale(page, entries) or entry.get("rest") != rest_digest(page):
            continue
        if drives_the_same(page, entry["drives"]):
            entry |= {"digest": page_digest(page), "confirmed": f"{commit} {date}"}
            confirmed.append(page.name)
    _write(entries, file)
    return confirmed


def _write(entries: dict[str, dict[str, Any]], file: Path) -> None:
    text = json.dumps(dict(sorted(entries.items())), indent=1)
    file.write_text(text + "\n", encoding="utf-8")


def listing(pages: dict[str, Page], entries: dict[str, dict[str, Any]]) -> list[str]:
    """One line for each page: version, minutes, and whether it is stale."""
    lines = [f"{'page':18}{'version':26}{'minutes':>8}  file"]
    for page in pages.values():
        entry = entries.get(page.name, {})
        version = f"{entry.get('commit', '-')} {entry.get('date', '')}"
        minutes = f"{entry['minutes']:.1f}" if "minutes" in entry else "-"
        state = "  kept" * page.kept + "  stale" * is_stale(page, entries)
        if "confirmed" in entry:
            state += f"  same drives at {entry['confirmed']}"
        lines.append(f"{page.name:18}{version:26}{minutes:>8}  {page.file}{state}")
    return lines
