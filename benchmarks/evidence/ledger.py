"""What docs/evidence.json knows of each page: of which code it is, and how long it took."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from blocks import present_version
from digests import HOUSE, digest_of
from pages import Page

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
        lines.append(f"{page.name:18}{version:26}{minutes:>8}  {page.file}{state}")
    return lines
