"""Points and colours of giveway beside those of Euro NCAP's calculator, for 200 random tables.

    python benchmarks/ncap/official_points.py --python PATH/bin/python --keep FILE.json.gz
    python benchmarks/ncap/official_points.py --compare FILE.json.gz

PATH is an environment with ``pip install euroncap-rating-2026``. The first command asks the
calculator and keeps tables and answers; the second compares them with giveway, as the tests do
with the kept file tests/giveway/ncap/official_points.json.gz.
"""

import argparse
import gzip
import json
import random
import subprocess
from collections import Counter
from pathlib import Path
from typing import Any

from giveway.ncap.protocol import Cell, read_protocol
from giveway.ncap.rating import colour_of, rate, rounded, verified

PROTOCOL = read_protocol("euroncap-2026")
EDGES = (0.01, 9.99, 10.0, 10.01, 19.99, 20.0, 20.01, 29.99, 30.0, 30.01, 2.0, 11.99, 12.0, 8.0)
DRAWN = {False: 3, True: 2}  # verified cells of the standard and of the extended range


def main() -> None:
    """Ask the calculator, or compare."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--python", type=Path)
    parser.add_argument("--tables", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--compare", type=Path)
    wanted = parser.parse_args()
    if wanted.compare is None:
        tables = [table_of(random.Random(wanted.seed * 1000 + n), n) for n in range(wanted.tables)]
        kept = asked(wanted.python, tables)
        text = json.dumps(kept, separators=(",", ":")).encode()
        wanted.keep.write_bytes(gzip.compress(text, mtime=0))
    else:
        kept = json.loads(gzip.decompress(wanted.compare.read_bytes()))
    found = [difference for table in kept["tables"] for difference in differences(table)]
    print(f"calculator {kept['calculator']}: {len(kept['tables'])} tables")
    for what, count in sorted(coverage(kept["tables"]).items()):
        print(f"  {what}: {count}")
    print(f"{len(found)} differences", *found[:20], sep="\n  ")


def table_of(draw: random.Random, number: int) -> dict[str, Any]:
    """Return a random table: an impact speed for each cell, and measured ones for some.

    The first table has no impacts, the second only full ones.
    """
    worse = (0.0, 1.0)[number] if number < 2 else draw.choice((0.05, 0.15, 0.3, 0.5, 0.8))
    impacts = [_impact(draw, cell, worse, whole=number == 1) for cell in PROTOCOL.cells]
    measured = []
    for test in PROTOCOL.tests:
        for extended, count in DRAWN.items():
            # at 50 and 60 km/h the calculator takes verified cells of CPLA for those of a warning
            cells = [
                (place, cell)
                for place, cell in enumerate(PROTOCOL.cells)
                if cell.test is test and cell.extended == extended
                if not (test.name == "CPLA" and cell.speed in {50, 60})
            ]
            for place, cell in draw.sample(cells, count if number % 2 else 0):
                near = max(0.0, impacts[place] + draw.choice((-3, -2, -1.99, -1, 0, 1, 1.99, 2, 3)))
                value = draw.choice((near, _impact(draw, cell, 0.5, whole=False)))
                measured.append([place, round(value, 2)])
    return {"impacts": impacts, "measured": measured}


def _impact(draw: random.Random, cell: Cell, worse: float, *, whole: bool) -> float:
    if whole:
        return float(cell.speed)
    if draw.random() >= worse:
        return 0.0
    edges = [edge for edge in EDGES if edge <= cell.speed]
    return draw.choice((draw.choice(edges), round(draw.uniform(0.0, cell.speed), 2)))


def asked(python: Path, tables: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the tables with the calculator's answers."""
    names = [cell.key for cell in PROTOCOL.cells]
    questions = [
        {
            "cells": [
                [*name, impact] for name, impact in zip(names, table["impacts"], strict=True)
            ],
            "measured": [[*names[place], value] for place, value in table["measured"]],
        }
        for table in tables
    ]
    script = Path(__file__).with_name("calculator.py")
    done = subprocess.run(
        [python, script], input=json.dumps(questions), capture_output=True, text=True, check=True
    )
    answer = json.loads(done.stdout)
    return {
        "calculator": answer["calculator"],
        "tables": [t | a for t, a in zip(tables, answer["answers"], strict=True)],
    }


def differences(table: dict[str, Any]) -> list[str]:
    """Return where giveway differs from the calculator in one table."""
    cells, found = PROTOCOL.cells, []
    colours = [colour_of(PROTOCOL, *pair) for pair in zip(cells, table["impacts"], strict=True)]
    for cell, impact, ours, theirs in zip(
        cells, table["impacts"], colours, table["colours"], strict=True
    ):
        if ours != theirs:
            found.append(f"{cell.label} {impact}: {ours}, calculator {theirs}")
    checks = []
    for (place, value), theirs in zip(table["measured"], table["checked"], strict=True):
        verdict, applied = verified(PROTOCOL, cells[place], colours[place], value)
        checks.append((cells[place].key, verdict))
        told = {"better": "incorrect"}.get(verdict, verdict)
        if [told, applied] != [theirs[0].lower(), theirs[1]]:
            found.append(f"{cells[place].label} {value}: {verdict} {applied}, calculator {theirs}")
    given = {cell.key: colour for cell, colour in zip(cells, colours, strict=True)}
    rating = rate(PROTOCOL, given, checks, zeroes=False)
    for test in PROTOCOL.tests:
        ours_ = rating.tests[test.name]
        # the calculator adds the night, which is all green in these tables
        both = [
            rounded(ours_.standard + test.standard_points, 3),
            rounded(ours_.extended + test.extended_points, 3),
        ]
        if both != table["points"][test.name]:
            found.append(f"{test.name}: {both}, calculator {table['points'][test.name]}")
    return found


def coverage(tables: list[dict[str, Any]]) -> Counter[str]:
    """Return how often each band, verdict, discount and step of the extended range occurs."""
    counts: Counter[str] = Counter()
    for table in tables:
        for cell, colour in zip(PROTOCOL.cells, table["colours"], strict=True):
            counts[f"{min(cell.speed, 50)} km/h, {colour}"] += 1
        for verdict, _ in table["checked"]:
            counts[f"verification: {verdict.lower()}"] += 1
        for test in PROTOCOL.tests:
            share = (table["points"][test.name][1] - test.extended_points) / test.extended_points
            counts[f"extended range: {100 * share:.1f} % of the points"] += 1
        zero = PROTOCOL.cells.index(next(c for c in PROTOCOL.cells if c.key == ("CPNA", 75, 10)))
        counts[f"CPNA 75 % at 10 km/h {table['colours'][zero]}"] += 1
    return counts


if __name__ == "__main__":
    main()
