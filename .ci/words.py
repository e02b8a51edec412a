"""List and count docstrings without a grammatical head, and fail above a limit.

A first line is headless if it opens with a relative clause ("Which ..."), a preposition ("Of ..."),
or a word that refers to other text ("Likewise", "None"). An entry of ``Args`` is genitive if a
preposition follows its colon ("config: of the ego."). CONTRIBUTING.md has the rules of writing.

    python .ci/words.py                               lists everything in the five packages
    python .ci/words.py giveway/ego --headless 2 --genitive 0     fails above 2 % or above 0
"""

import argparse
import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

PACKAGES = ("giveway", "controller", "pedestrian_model", "fmus", "sumo_scenarios")

_RELATIVE = "what which who whom whose whether where when how why that as than if while once until"
_PREPOSITIONS = (
    "of from in on at by for to with without after before behind beyond under over within between "
    "beside below above along per against among during since through towards"
)
_REFERENCES = "none nothing likewise also not else otherwise and or but so same ditto"
_HEADLESS = frozenset(f"{_RELATIVE} {_PREPOSITIONS} {_REFERENCES}".split())

_ABSENCE = re.compile(r";\s+(None|False|nan|nothing|nobody|-1|empty)\s*:", re.IGNORECASE)
_ENTRY = re.compile(r"^ {4}(\*{0,2}[\w, *]+?)(?: \([^)]*\))?:\s+(\S+)")
_GENITIVE = frozenset(f"{_PREPOSITIONS} likewise as".split())

_Documented = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Module


class Defect(NamedTuple):
    """A defect of a docstring: its place, its kind and the line of text."""

    path: Path
    line: int
    kind: str
    text: str


def headless(docstring: str) -> bool:
    """Return whether the docstring's first line has no grammatical head."""
    first = docstring.strip().splitlines()[0]
    words = re.findall(r"\w+", re.sub(r"\([^)]*\)|\[[^\]]*\]", "", first))
    return not words or words[0].lower() in _HEADLESS


def absence(docstring: str) -> bool:
    """Return whether the first line tells absence by a fragment ("...; None: ...")."""
    return _ABSENCE.search(docstring.strip().splitlines()[0]) is not None


def genitives(docstring: str) -> list[str]:
    """Return the entries of ``Args`` and its sister sections that open with a preposition."""
    found, inside = [], False
    for line in docstring.splitlines():
        if not line.startswith(" "):
            inside = line.strip() in {"Args:", "Attributes:", "Parameters:"}
        elif inside and (entry := _ENTRY.match(line)) and entry[2].lower() in _GENITIVE:
            found.append(line.strip())
    return found


def defects(path: Path) -> Iterator[Defect | None]:
    """Yield the defects of a file's docstrings, and None for each docstring that was read."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, _Documented) or not (docstring := ast.get_docstring(node)):
            continue
        yield None
        line = node.body[0].lineno
        first = docstring.splitlines()[0]
        if headless(docstring):
            yield Defect(path, line, "headless", first)
        if absence(docstring):
            yield Defect(path, line, "absence", first)
        yield from (Defect(path, line, "genitive", entry) for entry in genitives(docstring))


def main() -> int:
    """List the defects; the exit code is 1 if a limit is exceeded."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("paths", nargs="*", type=Path, default=[Path(p) for p in PACKAGES])
    parser.add_argument("--headless", type=float, metavar="%", help="largest share of docstrings")
    parser.add_argument("--genitive", type=int, metavar="N", help="largest number of entries")
    parser.add_argument("--quiet", action="store_true", help="print the counts only")
    given = parser.parse_args()
    files = [f for p in given.paths for f in (sorted(p.rglob("*.py")) if p.is_dir() else [p])]
    read = [d for file in files for d in defects(file)]
    found = [d for d in read if d is not None]
    total = len(read) - len(found)
    if not given.quiet:
        for d in found:
            print(f"{d.path}:{d.line}: {d.kind}: {d.text}")
    counts = {k: sum(d.kind == k for d in found) for k in ("headless", "absence", "genitive")}
    share = 100 * (counts["headless"] + counts["absence"]) / max(total, 1)
    print(
        f"{total} docstrings: {counts['headless']} headless, {counts['absence']} end in a fragment "
        f"of absence (together {share:.1f} %); {counts['genitive']} genitive entries"
    )
    return (given.headless is not None and share > given.headless) or (
        given.genitive is not None and counts["genitive"] > given.genitive
    )


if __name__ == "__main__":
    sys.exit(main())
