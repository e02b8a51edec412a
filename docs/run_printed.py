"""Run the ``giveway`` commands of README and docs: ``python docs/run_printed.py [PAGE ...]``.

Each page has a scratch folder in which the repository's own files lie as in a checkout, and those
results of README's commands that it names. Commands are run from top to bottom; what cannot be is
listed: commands with a name in capitals (``CITR_FOLDER``), those of a block below
``<!-- not run -->``, those that name a file or a plug-in of the reader's, and, without ``--all``,
studies of more than a few runs. With ``--folder`` it can be ended and resumed: what has passed
there is not run again. Tutorials have a runner of their own (``tutorials/run.py``), pictures too
(``make_figures.py``).
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from collections import Counter
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
README = ROOT / "README.md"
PAGES = [
    README,
    ROOT / "CONTRIBUTING.md",
    *sorted((ROOT / "docs").rglob("*.md")),
    ROOT / "fmus" / "README.md",
    ROOT / "sumo_scenarios" / "README.md",
]
STATE = "printed.json"  # what has passed, in the scratch folder
LONGEST = 1800.0  # [s] of one command
ENDS = {"&&", "||", ";", "|", ">", ">>", "2>"}
BLOCK = re.compile(
    r"(?:^<!-- (not run) -->\n+)?^( *)```(\w*)[^\n]*\n(.*?)^\2```", re.DOTALL | re.MULTILINE
)
PLACEHOLDER = re.compile(r"^[A-Z][A-Z_]{3,}$|\bHOST\b|\.\.\.|…")
PLUG_INS = {"careful", "shy", "patient", "school-zone", "fast-and-near"}  # Names of examples
NAMING = {"--controller", "--crowd-model", "--rule", "--metric", "controller", "model", "rule"}
FEW = 5  # runs per cell of a study that is not slow


class Printed(NamedTuple):
    """A command that a page prints."""

    page: Path
    words: tuple[str, ...]  # behind "giveway"
    out: str  # the file into which the shell would write what it prints; or empty
    shown: bool  # only: its block is not to be run

    @property
    def text(self) -> str:
        """As it is printed."""
        return shlex.join(("giveway", *self.words)) + (f" > {self.out}" if self.out else "")


def commands_in(text: str) -> list[tuple[list[str], str]]:
    """The words behind each ``giveway`` in shell lines, and the file that takes its output."""
    found = []
    for line in text.replace("\\\n", " ").splitlines():
        if not re.match(r"\s*(\$ )?(.* && )?(\S*/)?giveway\s", line):
            continue
        lexer = shlex.shlex(line, posix=True, punctuation_chars=";|&>")
        lexer.whitespace_split = True
        words = list(lexer)
        words = words[words.index(next(w for w in words if w.endswith("giveway"))) + 1 :]
        end = next((at for at, word in enumerate(words) if word in ENDS), len(words))
        out = words[end + 1] if words[end : end + 1] == [">"] else ""
        found.append((words[:end], out))
    return found


def printed_on(page: Path) -> list[Printed]:
    """The commands of a page, from top to bottom, each once."""
    found = []
    for mark, _, language, text in BLOCK.findall(page.read_text(encoding="utf-8")):
        if language in {"", "sh", "bash"}:
            for words, out in commands_in(text):
                found.append(Printed(page, tuple(words), out, bool(mark)))
    return list(dict.fromkeys(found))


def is_slow(words: tuple[str, ...]) -> bool:
    """Whether a command makes many runs."""
    if words[0] != "study" or "--dry-run" in words:
        return False
    counts = [words[at + 1] for at, word in enumerate(words) if word in {"--runs", "--seeds"}]
    return not counts or int(counts[-1]) > FEW


def why_not(command: Printed, folder: Path, readme: Path, *, slow: bool) -> str:
    """Why a command is not run; empty: it is."""
    words = ("", *command.words)
    if command.shown:
        return "only shown"
    if any(PLACEHOLDER.search(word) for word in words):
        return "a placeholder"
    if "--install-completion" in words:
        return "it changes the shell's settings"
    if is_slow(command.words) and not slow:
        return "slow: --all"
    ours = {path.name for path in ROOT.iterdir()} - {"results"}
    for before, word in pairwise(words):
        if before in NAMING and (word.partition(".")[0] in PLUG_INS or ":" in word):
            return f"{word} is a plug-in of the reader's"
        named = re.search(r"/|\.(toml|fmu|sumocfg|py|csv)$", word) and not word.startswith("-")
        if not named or before in {"--out", "-o", "--draft"} or Path(word).parts[0] in ours:
            continue
        if not (folder / word).exists() and (readme / word).exists():
            (folder / word).parent.mkdir(parents=True, exist_ok=True)
            (folder / word).symlink_to(readme / word)
        if not (folder / word).exists():
            return f"{word} is not there"
    return ""


def prepare(folder: Path) -> None:
    """Lay the repository's files into a page's folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for path in ROOT.iterdir():
        here = folder / path.name
        if path.name not in {"results", ".git"} and not here.is_symlink() and not here.exists():
            here.symlink_to(path)


def run(command: Printed, folder: Path) -> str:
    """Run a command; why it failed, or nothing."""
    words = [sys.executable, "-m", "giveway", *command.words]
    told = os.environ | {"COLUMNS": "100", "NO_COLOR": "1"}
    try:
        done = subprocess.run(
            words,
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=LONGEST,
            env=told,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"not finished within {LONGEST:g} s"
    if done.returncode:
        lines = (done.stderr.strip() or done.stdout.strip()).splitlines() or ["no message"]
        return f"exit {done.returncode}: {lines[-1]}"
    if command.out:
        (folder / command.out).write_text(done.stdout, encoding="utf-8")
    return ""


def run_page(page: Path, scratch: Path, *, slow: bool) -> Counter[str]:
    """Run a page's commands, and print how each went; how many passed, failed and were not run."""
    name = page.relative_to(ROOT).as_posix()
    folder, readme = (scratch / str(p.relative_to(ROOT)).replace("/", "_") for p in (page, README))
    state = scratch / STATE
    count: Counter[str] = Counter()
    for command in printed_on(page):
        prepare(folder)
        passed = json.loads(state.read_text(encoding="utf-8")) if state.is_file() else {}
        if command.text in passed.get(name, []):
            count["passed"] += 1
            continue
        if reason := why_not(command, folder, readme, slow=slow):
            count["not run"] += 1
            print(f"  not run  {name}: {command.text}  ({reason})", flush=True)
            continue
        begun = time.monotonic()
        failure = run(command, folder)
        count["failed" if failure else "passed"] += 1
        head = "FAILED  " if failure else f"{time.monotonic() - begun:6.1f} s"
        print(f"  {head} {name}: {command.text}" + (f"\n    {failure}" * bool(failure)), flush=True)
        if not failure:
            passed.setdefault(name, []).append(command.text)
            state.write_text(json.dumps(passed, indent=1), encoding="utf-8")
    return count


def main() -> int:
    """Run what is asked for; 1: something failed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pages", nargs="*", help="like README.md docs/encounters.md; none: all")
    parser.add_argument("--all", action="store_true", help="large studies, too: hours")
    parser.add_argument("--folder", type=Path, help="scratch folder that is kept, to resume in")
    asked = parser.parse_args()
    tutorials = ROOT / "docs" / "tutorials"
    pages = [(ROOT / name).resolve() for name in asked.pages] or [
        page for page in PAGES if tutorials not in page.parents
    ]
    if unknown := [page for page in pages if page not in PAGES]:
        parser.error(f"{unknown[0]}: no page of README and docs")
    total: Counter[str] = Counter()
    with tempfile.TemporaryDirectory(prefix="giveway-printed-") as temporary:
        for page in pages:
            total += run_page(page, (asked.folder or Path(temporary)).resolve(), slow=asked.all)
    print(", ".join(f"{total[what]} {what}" for what in ("passed", "failed", "not run")))
    return 1 if total["failed"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
