"""The tables of docs/models.md from their studies.

Run: giveway study models --first-seed 551 --out FOLDER
     giveway study beliefs --runs 24 --first-seed 301 --out BELIEFS
     python benchmarks/evidence/models.py FOLDER                # as Markdown, on the terminal
     python benchmarks/evidence/models.py BELIEFS --write       # into docs/models.md
"""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas as pd

PAGE = Path(__file__).parents[1] / "docs" / "models.md"
STUDIES = {"driver": "table", "belief": "beliefs"}  # what is compared: between which marks
PLAIN = ("vci", "constant-velocity")  # what is believed, beside the truth
SIGNS = {"better": " **+**", "worse": " **−**"}
MEANS = (
    ("completion_time", "time [s]", 1),
    ("longest_wait", "longest wait [s]", 1),
    ("rms_jerk", "RMS jerk [m/s³]", 1),
    ("conflicts", "conflicts", 1),
    ("mean_people_delay", "people's mean delay [s]", 2),
)


def table(folder: Path) -> list[str]:
    """Lines of Markdown: what is compared before each model of people, with signs."""
    runs = pd.read_csv(folder / "runs.csv", low_memory=False)
    cells = pd.read_csv(folder / "cells.csv")
    compared = pd.read_csv(folder / "comparison.csv")
    factor = factor_of(folder)
    general = compared[compared.situation == "general"]
    by = general.set_index(["scene", "people", "treatment", "metric"])
    titles = [title for _, title, _ in MEANS]
    lines = [f"| scene | people | {factor} | " + " | ".join(titles) + " | frontal | side |"]
    lines.append("|" + "---|" * (len(titles) + 5))
    for row in cells.itertuples():
        level = getattr(row, factor)
        if factor == "belief" and level not in (row.people, *PLAIN):
            continue
        of = runs[runs.cell == row.cell]
        told = [str(row.scene), str(row.people), f"`{level}`"]
        for name, _, digits in MEANS:
            key = (row.scene, row.people, level, name)
            verdict = by.verdict[key] if key in by.index else ""
            told.append(f"{of[name].mean():.{digits}f}" + SIGNS.get(str(verdict), ""))
        told += [str(int(of[name].sum())) for name in ("frontal_contacts", "side_contacts")]
        lines.append("| " + " | ".join(told) + " |")
    return lines


def factor_of(folder: Path) -> str:
    """What a study compares."""
    columns = pd.read_csv(folder / "cells.csv").columns
    return next(factor for factor in STUDIES if factor in columns)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="into docs/models.md")
    options = parser.parse_args()
    lines = "\n".join(table(options.folder)) + "\n"
    if options.write:
        text = PAGE.read_text(encoding="utf-8")
        mark = STUDIES[factor_of(options.folder)]
        begin, end = f"<!-- {mark} -->\n", f"<!-- end of {mark} -->"
        before, rest = text.split(begin)
        PAGE.write_text(before + begin + lines + end + rest.split(end)[1], encoding="utf-8")
    else:
        print(lines)


if __name__ == "__main__":
    main()
