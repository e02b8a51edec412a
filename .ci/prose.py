"""Counts the prose of README and docs, and the minutes to a stranger's first result.

Code, tables, headings, pictures, comments and evidence blocks do not count; a table's cell of more
than 25 words does. A way leads through README to one of its doors, and through the linked
page to ``<!-- first result -->``, or its first section, at 200 words or typed characters a minute.

    python .ci/prose.py --pages      # of each page: words, words per sentence, sentences over 40
    python .ci/prose.py --words 30000 --mean 17 --long 1 --minutes 5    # fails above a limit
"""

import argparse
import re
import sys
from pathlib import Path

_ROOT = Path(__file__).resolve().parents[1]
_PAGES = ("README.md", "docs/**/*.md", "fmus/README.md", "sumo_scenarios/README.md")
_WAYS = {
    "I have a SUMO scenario": "docs/any_scenario.md",
    "I have a vehicle FMU": "docs/vehicles.md",
    "I have a controller": "docs/plugins.md",
    "I have a question for a paper": "docs/studies.md",
}
_CODE = re.compile(r"^ *```(\w*)\n(.*?)^ *```", re.MULTILINE | re.DOTALL)
_COMMENT = re.compile(r"<!-- evidence.*?<!-- end -->|<!--.*?-->", re.DOTALL)
_RESULTS = ("<!-- first result -->", "\n## ")
_TYPED = ("sh", "python", "toml", "xml")


def sentences(text: str) -> list[int]:
    """Return the number of words of each sentence; inline code counts as one word."""
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", _COMMENT.sub("", _CODE.sub("", text)))
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", re.sub(r"`[^`]*`", "X", text))
    lines = [line.strip() for line in text.splitlines() if not line.startswith("#")]
    cells = [cell for line in lines if line.startswith("|") for cell in line.split("|")]
    prose = "\n".join("" if line.startswith("|") else line for line in lines)
    parts = re.split(r"\n\s*\n|(?:^|\n)(?:[*-]|\d+\.) ", prose)
    parts += [cell for cell in cells if len(cell.split()) > 25]
    found = [s.split() for part in parts for s in re.split(r"(?<=[.!?])[)*]*\s+", part)]
    return [len(words) for words in found if words]


def minutes(readme: str, door: str, page: str) -> float:
    """Return the time [min] from the first line of README to the first result of a door's page."""
    before, after = readme.split(f"**{door}", 1)
    door = re.split(r"\n\n(?:\*\*|!|## )", after)[0]
    end = next((mark for mark in _RESULTS if mark in page), None)
    way = f"{door}\n\n{page.split(end)[0]}"
    typed = next(code for kind, code in _CODE.findall(before) if kind == "sh")
    typed += "".join(code for kind, code in _CODE.findall(way) if kind in _TYPED)
    return (sum(sentences(f"{before}\n\n{way}")) + len(typed)) / 200


def main() -> int:
    """Print the counts; the exit code is 1 if a limit is exceeded."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--root", type=Path, default=_ROOT, help="folder of README and docs")
    parser.add_argument("--pages", action="store_true", help="print the counts of each page")
    for limit in ("--words", "--mean", "--long", "--minutes"):
        parser.add_argument(limit, type=float, default=float("inf"), metavar="N")
    given = parser.parse_args()
    texts = {f: f.read_text("utf-8") for place in _PAGES for f in sorted(given.root.glob(place))}
    pages = {str(file.relative_to(given.root)): sentences(text) for file, text in texts.items()}
    for name, n in sorted(pages.items(), key=lambda page: -sum(page[1])) if given.pages else ():
        print(f"{sum(n):6} {sum(n) / max(len(n), 1):6.1f} {sum(k > 40 for k in n):4}  {name}")
    lengths = [length for page in pages.values() for length in page]
    mean = sum(lengths) / max(len(lengths), 1)
    long = 100 * sum(length > 40 for length in lengths) / max(len(lengths), 1)
    print(f"{sum(lengths)} words, {mean:.1f} a sentence, {long:.1f} % of sentences over 40")
    readme = texts[given.root / "README.md"]
    times = {door: minutes(readme, door, texts[given.root / page]) for door, page in _WAYS.items()}
    for door, time in times.items():
        print(f"{time:.1f} min: {door}")
    measured = (sum(lengths), mean, long, max(times.values()))
    limits = (given.words, given.mean, given.long, given.minutes)
    return any(value > limit for value, limit in zip(measured, limits, strict=True))


if __name__ == "__main__":
    sys.exit(main())
