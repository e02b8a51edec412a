"""The table of docs/ablation.md from its study.

Run: giveway study ablation --out FOLDER
     python benchmarks/evidence/ablation.py FOLDER                # as Markdown, on the terminal
     python benchmarks/evidence/ablation.py FOLDER --write        # into docs/ablation.md
"""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas as pd

PAGE = Path(__file__).parents[1] / "docs" / "ablation.md"
BEGIN, END = "<!-- table -->\n", "<!-- end of table -->"
DEFAULT = "mpc"
WIDTH = 1.96  # standard errors of a paired difference
MEANS = (("completion_time", 1), ("longest_wait", 1), ("rms_jerk", 1), ("conflicts", 1))
DIFFERENCES = ("completion_time", "longest_wait", "rms_jerk", "conflicts")


def table(folder: Path) -> list[str]:
    """Lines of Markdown: means of each variant, and its paired differences from the default."""
    runs = pd.read_csv(folder / "runs.csv", low_memory=False)
    variants = pd.read_csv(folder / "cells.csv").set_index("cell").variant
    by = {variants[cell]: of.set_index("seed") for cell, of in runs.groupby("cell")}
    lines = [
        "| variant | completion [s] | longest wait [s] | RMS jerk [m/s³] | conflicts | frontal "
        "| layer acts [%] | less `mpc`: completion [s] | longest wait [s] | RMS jerk | conflicts |",
        "|" + "---|" * 11,
    ]
    for variant in variants:
        of, default = by[variant], by[DEFAULT]
        told = [variant] + [f"{of[name].mean():.{digits}f}" for name, digits in MEANS]
        told += [str(int(of.frontal_contacts.sum())), f"{100.0 * of.safety_share.mean():.2f}"]
        for name in DIFFERENCES:
            less = (of[name] - default[name]).dropna()
            wide = WIDTH * less.sem()
            sure = "**" if abs(less.mean()) > wide > 0.0 else ""
            told.append(f"{sure}{less.mean():+.1f}{sure} ± {wide:.1f}")
        if variant == DEFAULT:
            told[-len(DIFFERENCES) :] = [""] * len(DIFFERENCES)
        lines.append("| " + " | ".join(told) + " |")
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="into docs/ablation.md")
    options = parser.parse_args()
    lines = "\n".join(table(options.folder)) + "\n"
    if options.write:
        text = PAGE.read_text(encoding="utf-8")
        before, rest = text.split(BEGIN)
        PAGE.write_text(before + BEGIN + lines + END + rest.split(END)[1], encoding="utf-8")
    else:
        print(lines)


if __name__ == "__main__":
    main()
