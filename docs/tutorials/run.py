"""Run the tutorials as they are printed: ``python docs/tutorials/run.py [NAME ...]``.

A page is gone through from top to bottom in an empty folder. Blocks of ``sh`` are run by bash,
blocks of ``python`` by Python, and what stands below ``<!-- file: NAME -->`` is written to that
file. ``<!-- beside: NAME -->`` copies a file of this folder. After ``<!-- prints -->`` the block
shows what the commands before it have printed, with ``...`` for what is left out. In the end a
table tells how many blocks ran, and how many lines the pages show that were printed.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator

HERE = Path(__file__).parent
MARK = re.compile(r"<!-- (file|beside|prints|not run)(?:: (.+?))? -->")
FENCE = "```"
LONGEST = 900.0  # [s] of one block


class TutorialError(Exception):
    """A page does not do what it says."""


class Block(NamedTuple):
    """A block of a page."""

    line: int  # where it begins
    language: str
    mark: str  # file, beside, prints, not run, or nothing
    name: str  # what the mark names
    text: str


def tutorials() -> list[str]:
    """The names of the tutorials, in the order in which they are meant to be read."""
    listed = re.findall(r"\]\((\w+)\.md\)", (HERE / "index.md").read_text(encoding="utf-8"))
    return list(dict.fromkeys(listed))


def blocks(page: str) -> Iterator[Block]:
    """Go through the fenced blocks and the marks of a page."""
    lines = iter(enumerate(page.splitlines(), start=1))
    mark, name = "", ""
    for number, line in lines:
        if found := MARK.fullmatch(line):
            mark, name = found[1], found[2] or ""
            if mark == "beside":
                yield Block(number, "", mark, name, "")
                mark, name = "", ""
        elif line.startswith(FENCE):
            text: list[str] = []
            for _, inside in lines:
                if inside.startswith(FENCE):
                    break
                text.append(inside)
            yield Block(number, line.removeprefix(FENCE), mark, name, "\n".join(text) + "\n")
            mark, name = "", ""
        elif line.strip() and mark:
            raise TutorialError(f"line {number}: no block follows <!-- {mark} -->")


def play(name: str, folder: Path, *, show: bool = True) -> tuple[int, int]:
    """Go through one tutorial in a folder; return the number of blocks and of lines that agree."""
    ran = agreed = 0
    page = (HERE / f"{name}.md").read_text(encoding="utf-8")
    environment = surroundings(folder)
    printed = ""
    for block in blocks(page):
        place = f"{name}.md, line {block.line}"
        if block.mark == "beside":
            shutil.copyfile(HERE / block.name, folder / block.name)
        elif block.mark == "file":
            file = folder / block.name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(block.text, encoding="utf-8")
        elif block.mark == "prints":
            compare(block.text, printed, place)
            agreed += len(block.text.splitlines())
        elif not block.mark and block.language in {"sh", "python"}:
            if show:
                print(f"  {place}", file=sys.stderr, flush=True)
            printed = execute(block, folder, environment, place)
            ran += 1
    return ran, agreed


def surroundings(folder: Path) -> dict[str, str]:
    """The variables of a tutorial's commands: this Python's, packages installed into the folder."""
    installed = folder / ".installed"
    here = os.environ.get("PYTHONPATH")
    return os.environ | {
        "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]),
        "PYTHONPATH": os.pathsep.join([str(installed), *([here] if here else [])]),
        "PIP_TARGET": str(installed),
        "PIP_NO_DEPS": "1",
        "PIP_NO_BUILD_ISOLATION": "0",  # pip reads this as: no isolation
        "PIP_DISABLE_PIP_VERSION_CHECK": "1",
        "COLUMNS": "100",
    }


def execute(block: Block, folder: Path, environment: dict[str, str], place: str) -> str:
    """Run a block, and return what it prints."""
    command = ["bash", "-eu", "-o", "pipefail", "-c", block.text]
    if block.language == "python":
        command = [sys.executable, "-c", block.text]
    done = subprocess.run(
        command,
        cwd=folder,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=LONGEST,
        check=False,
    )
    if done.returncode:
        raise TutorialError(f"{place}: exit code {done.returncode}\n{done.stdout}")
    return done.stdout


def compare(shown: str, printed: str, place: str) -> None:
    """Raise unless every line that the page shows was printed; ``...`` stands for anything."""
    there = [" ".join(line.split()) for line in printed.splitlines()]
    for line in shown.splitlines():
        pattern = re.escape(" ".join(line.split())).replace(re.escape("..."), ".*")
        if not any(re.fullmatch(pattern, other) for other in ["", *there]):
            raise TutorialError(f"{place}: not printed: {line!r}; what was:\n{printed}")


def main() -> int:
    """Run the tutorials that are named, or all."""
    parser = argparse.ArgumentParser(description="Run the tutorials as they are printed.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(tutorials()))
    parser.add_argument("--keep", type=Path, help="work here, and leave what is made")
    arguments = parser.parse_args()
    if strange := set(arguments.names) - set(tutorials()):
        parser.error(f"no tutorial {sorted(strange)[0]!r}: there are {', '.join(tutorials())}")
    failed = 0
    print("| tutorial | blocks that ran | lines that were printed as shown |\n|---|---|---|")
    for name in arguments.names or tutorials():
        began = time.perf_counter()
        with tempfile.TemporaryDirectory() as temporary:
            folder = (arguments.keep / name).resolve() if arguments.keep else Path(temporary)
            folder.mkdir(parents=True, exist_ok=True)
            try:
                ran, agreed = play(name, folder)
            except (TutorialError, subprocess.TimeoutExpired) as error:
                print(f"{name} failed: {error}", file=sys.stderr)
                failed += 1
                continue
        print(f"| [{name}](tutorials/{name}.md) | {ran} | {agreed} |", flush=True)
        print(f"{name}: {time.perf_counter() - began:.0f} s", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
