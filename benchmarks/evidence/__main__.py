"""Make the measured blocks of README and docs anew: ``python benchmarks/evidence [PAGE ...]``.

Without a name it makes each page that is stale: whose code, seeds or samples have changed since.
It can be ended at any time and goes on where it was. ``--list`` names all pages, ``--check`` the
stale ones; ``--quick`` proves with a few seeds that everything can be made, and writes no page.
``--confirm`` compares ten fixed runs with those of the time at which a page was made: where the
code has changed and the drives have not, the page is not stale any more.
``--kept NAME`` makes a table of a long campaign, or of data that are not in the repository.
"""

from __future__ import annotations

import argparse
import hashlib
import sys
import tempfile
import time
from pathlib import Path

sys.path.extend(
    str(Path(__file__).resolve().parents[1] / room) for room in ("speed", "tuning", "tools")
)

from blocks import present_version, write_block
from digests import HOUSE, digest_of, file_digest
from ledger import confirm, enter, is_stale, listing, read_ledger
from page import Page
from pages import PAGES
from work import Command, Study

SECONDS = "seconds.txt"


class Maker:
    """Makes pages in a folder that keeps what was run."""

    def __init__(self, out: Path, jobs: int, quick: bool, data: Path | None) -> None:
        self.out = out
        self.jobs = jobs
        self.quick = quick
        self.data = data

    def done(self, work: Study | Command, page: Page) -> Path:
        """Run what is missing of a study or command; what other code has made is not used."""
        made_of = f"{digest_of(page.rooms, repr(work))} {self.quick}"
        if self.data is not None:
            made_of += file_digest(self.data)
        folder = self.out / f"{work.name}-{hashlib.sha256(made_of.encode()).hexdigest()[:10]}"
        folder.mkdir(parents=True, exist_ok=True)
        began = time.monotonic()
        try:
            return work.make(folder / "made", self.jobs, self.quick, self.data)
        finally:
            with (folder / SECONDS).open("a", encoding="utf-8") as file:
                file.write(f"{time.monotonic() - began:.1f}\n")

    def make(self, page: Page) -> None:
        """Run what a page is about and write its blocks; a quick one is printed instead."""
        commit, date = present_version()
        seconds = {}
        for block in page.blocks:
            print(f"{page.name}: {block.name}", flush=True)
            found = self.done(block.work, page)
            folder = found.parents[0] if isinstance(block.work, Study) else found.parents[1]
            lines = (folder / SECONDS).read_text(encoding="utf-8").split()
            seconds[folder] = sum(map(float, lines))
            lines = block.make(found)
            if self.quick:
                print("\n".join(lines), flush=True)
                continue
            version = f"Commit {commit} ({date}); {block.work.sample}."
            if page.kept:
                version = f"Kept: `{self._command(page)}`. {version}"
            write_block(HOUSE / page.file, block.name, lines, version)
        print(f"{page.name}: {sum(seconds.values()) / 60.0:.1f} minutes", flush=True)
        if not self.quick:
            inputs = {} if self.data is None else {"data": file_digest(self.data)}
            enter(page, sum(seconds.values()) / 60.0, **inputs)

    def _command(self, page: Page) -> str:
        data = "" if self.data is None else f" --data {self.data.name}"
        return f"python benchmarks/evidence --kept {page.name}{data}"


def parsed() -> argparse.Namespace:
    """The arguments of the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    ours = [name for name, page in PAGES.items() if not page.kept]
    kept = [name for name, page in PAGES.items() if page.kept]
    parser.add_argument("pages", nargs="*", metavar="PAGE", help=", ".join(ours))
    parser.add_argument("--kept", choices=kept, help="make this kept table")
    parser.add_argument("--data", type=Path, help="data outside the repository, for --kept")
    parser.add_argument("--out", type=Path, help="folder that keeps the runs")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--quick", action="store_true", help="a few seeds; writes no page")
    parser.add_argument("--list", action="store_true", help="name all pages, and what is stale")
    parser.add_argument("--confirm", action="store_true", help="stale pages with the same drives")
    parser.add_argument("--check", action="store_true", help="name stale pages only; 1 if any is")
    options = parser.parse_args()
    if strange := sorted(set(options.pages) - set(ours)):
        parser.error(f"no page {strange[0]!r}: expected one of {', '.join(ours)}")
    if options.data is not None and not options.data.exists():
        parser.error(f"--data {options.data}: no such file or folder")
    return options


def main() -> int:
    """Make what is asked for."""
    options = parsed()
    entries = read_ledger()
    if options.list:
        print("\n".join(listing(PAGES, entries)))
        return 0
    if options.confirm:
        print("\n".join(confirm(PAGES)))
        return 0
    stale = [name for name, page in PAGES.items() if is_stale(page, entries)]
    if options.check:
        print("\n".join(stale))
        return 1 if stale else 0
    wanted = options.pages or [name for name in stale if not PAGES[name].kept]
    if options.kept is not None:
        wanted = [options.kept]
    with tempfile.TemporaryDirectory() as scratch:
        out = options.out or Path(scratch if options.quick else "results/evidence")
        maker = Maker(out.absolute(), options.jobs, options.quick, options.data)
        for name in wanted:
            maker.make(PAGES[name])
    return 0


if __name__ == "__main__":
    sys.exit(main())
