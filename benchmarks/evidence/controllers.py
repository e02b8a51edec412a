"""The tables of docs/controllers.md from a study of controllers.

Run: giveway study controllers --runs 50 --first-seed 501 --out FOLDER
     python benchmarks/evidence/controllers.py FOLDER                # as Markdown, on the terminal
     python benchmarks/evidence/controllers.py FOLDER --write        # into docs/controllers.md
The same of: giveway study attitudes --first-seed 551 --out FOLDER
With --margins: where the default is non-inferior, and how much of the rival's delay it saves, of a
study of any of the scenes.

Seeds from 501 on were never looked at while the default was tuned.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from weights import SAVING, SCENES, free

from giveway.studies.statistics.bootstrap import seed_of

BASELINE = "pid-tuned"
SIGNS = {"better": " **+**", "worse": " **−**"}
PAGE = Path(__file__).parents[1] / "docs" / "controllers.md"


class Column(NamedTuple):
    """A column of the table."""

    name: str
    title: str
    digits: int
    interval: bool = False
    scale: float = 1.0


COLUMNS = (
    Column("completion_time", "completion [s]", 1, interval=True),
    Column("longest_wait", "longest wait [s]", 1, interval=True),
    Column("stops", "stops", 1),
    Column("rms_jerk", "RMS jerk [m/s³]", 1, interval=True),
    Column("peak_deceleration", "hardest braking [m/s²]", 1),
    Column("conflicts", "conflicts", 1, interval=True),
    Column("share_below_ttc", "TTC < 1.5 s", 2),
    Column("minimum_pet", "least PET [s]", 2),
    Column("minimum_clearance", "least clearance [m]", 2),
    Column("mean_people_delay", "people's mean delay [s]", 2, interval=True),
    Column("safety_share", "layer acts [%]", 2, scale=100.0),
)
BRIEFLY = ("completion_time", "longest_wait", "rms_jerk", "conflicts", "share_below_ttc",
           "mean_people_delay")  # fmt: skip
#: How much worse the default may be, [unit of the metric]; on streets MORE_CONFLICTS.
MARGINS = {
    "completion_time": ("time [s]", 0.3),
    "longest_wait": ("longest wait [s]", 0.3),
    "rms_jerk": ("RMS jerk [m/s³]", 0.2),
    "conflicts": ("conflicts", 0.2),
    "share_below_ttc": ("TTC < 1.5 s", 0.03),
    "share_below_pet": ("PET < 1 s", 0.02),
    "share_below_pet_person_first": ("of these, the ego after the person", 0.02),
    "mean_people_delay": ("people's mean delay [s]", 0.2),
}
MORE_CONFLICTS = 0.4
RESAMPLES = 10_000
SUMS = (("frontal_contacts", "frontal"), ("side_contacts", "side"))


def table(folder: Path, who: str, columns: Sequence[Column]) -> list[str]:
    """Lines of Markdown: means and half their 95 % intervals by scene and ``who`` drives."""
    runs = pd.read_csv(folder / "runs.csv", low_memory=False)
    cells = pd.read_csv(folder / "cells.csv")
    levels = pd.read_csv(folder / "levels.csv")
    comparison = pd.read_csv(folder / "comparison.csv")
    general = comparison[comparison.situation == "general"]
    verdicts = general.set_index(["scene", "treatment", "metric"]).verdict
    spread = levels.set_index(["scene", who, "metric"])
    titles = [column.title for column in columns] + [title for _, title in SUMS]
    lines = [f"| scene | {who} | " + " | ".join(titles) + " |"]
    lines.append("|" + "---|" * (len(titles) + 2))
    for scene, group in cells.groupby("scene", sort=False):
        for cell, name in zip(group.cell, group[who], strict=True):
            of = runs[runs.cell == cell]
            told = [scene if name == group[who].iloc[0] else "", name]
            told += [entry(c, (scene, name, c.name), spread, verdicts) for c in columns]
            told += [str(int(of[name].sum())) for name, _ in SUMS]
            lines.append("| " + " | ".join(str(cell) for cell in told) + " |")
    return lines


def entry(
    column: Column, key: tuple[object, object, str], spread: pd.DataFrame, verdicts: pd.Series
) -> str:
    """A cell of the table; a sign where the difference to the baseline is beyond chance."""
    if key not in spread.index:
        return "-"
    found = spread.loc[key]
    if pd.isna(found["mean"]):
        return "-"
    said = f"{column.scale * found['mean']:.{column.digits}f}"
    if column.interval and pd.notna(found.ci_low):
        said += f" ±{column.scale * (found.ci_high - found.ci_low) / 2:.{column.digits}f}"
    return said + SIGNS.get(str(verdicts.get(key, "")), "")


def differences(folder: Path) -> list[str]:
    """Lines of Markdown: paired differences of the default to the baseline, scene by scene."""
    comparison = pd.read_csv(folder / "comparison.csv")
    shown = ("completion_time", "longest_wait", "rms_jerk", "conflicts", "mean_people_delay")
    kept = comparison[(comparison.situation == "general") & (comparison.treatment == "mpc")]
    by = kept.set_index(["scene", "metric"])
    lines = ["| scene | time [s] | longest wait [s] | RMS jerk [m/s³] | conflicts | "
             "people's mean delay [s] |", "|---|---|---|---|---|---|"]  # fmt: skip
    for scene in kept.scene.drop_duplicates():
        told = [str(scene)]
        for metric in shown:
            row = by.loc[(scene, metric)] if (scene, metric) in by.index else None
            if row is None or pd.isna(row.ci_low):
                told.append("-")
            else:
                told.append(
                    f"{row.mean_difference:+.2f} [{row.ci_low:+.2f}, {row.ci_high:+.2f}]"
                    + SIGNS.get(str(row.verdict), "")
                )
        lines.append("| " + " | ".join(told) + " |")
    return lines


def margins(folder: Path) -> list[str]:
    """Lines of Markdown: where the upper end of the difference's interval is within the margin.

    Where it is not, the difference and its interval: in bold where all of that is beyond.
    """
    comparison = pd.read_csv(folder / "comparison.csv")
    kept = comparison[(comparison.situation == "general") & (comparison.treatment == "mpc")]
    by = kept.set_index(["scene", "metric"])
    shown = {name: told for name, told in MARGINS.items() if name in set(kept.metric)}
    titles = [f"{title} (+{margin:g})" for title, margin in shown.values()]
    lines = ["| scene | " + " | ".join(titles) + " |", "|" + "---|" * (len(titles) + 1)]
    for scene in kept.scene.drop_duplicates():
        told = [str(scene)]
        for metric, (_, margin) in shown.items():
            if metric == "conflicts" and str(scene).startswith("street"):
                margin = MORE_CONFLICTS
            row = by.loc[(scene, metric)] if (scene, metric) in by.index else None
            if row is None or pd.isna(row.ci_high):
                told.append("-")
            elif row.ci_high <= margin:
                told.append("yes")
            else:
                said = f"{row.mean_difference:+.2f} [{row.ci_low:+.2f}, {row.ci_high:+.2f}]"
                told.append(f"**{said}**" if row.ci_low > margin else said)
        lines.append("| " + " | ".join(told) + " |")
    return lines


def saved(folder: Path) -> list[str]:
    """Lines of Markdown: how much of the baseline's delay the default saves, where there is much.

    A delay is the time beyond the drive with nobody about. Those of a scene's runs are added up,
    and so are those of all scenes; the interval is the bootstrap's percentiles, in which everything
    of one seed is one sample. Empty if the study lacks one of the scenes.
    """
    runs = pd.read_csv(folder / "runs.csv", low_memory=False)
    by = runs.set_index(["scene", "controller", "seed"]).sort_index()
    if not {(scene, who) for scene in SAVING for who in ("mpc", BASELINE)} <= {
        key[:2] for key in by.index
    }:
        return []
    delays, savings, conflicts = {}, {}, {}
    for scene in SAVING:
        theirs, ours = by.loc[(scene, BASELINE)], by.loc[(scene, "mpc")]
        delays[scene] = theirs.completion_time - free(SCENES[scene])
        savings[scene] = theirs.completion_time - ours.completion_time
        conflicts[scene] = ours.conflicts - theirs.conflicts
    lines = ["| scene | crowds | delay of `pid-tuned` [s] | of it saved | conflicts, `mpc` more |",
             "|---|---|---|---|---|"]  # fmt: skip
    for name, scenes in [(scene, [scene]) for scene in SAVING] + [("all five", list(SAVING))]:
        delay, saving, more = (
            pd.concat([of[scene] for scene in scenes], axis=1).dropna().to_numpy().sum(axis=1)
            for of in (delays, savings, conflicts)
        )
        g = np.random.default_rng(seed_of([name, "saved"]))
        drawn = g.integers(0, len(delay), (RESAMPLES, len(delay)))
        share = saving[drawn].sum(axis=1) / delay[drawn].sum(axis=1)
        low, high = 100.0 * np.percentile(share, (2.5, 97.5))
        few, many = np.percentile(more[drawn].mean(axis=1) / len(scenes), (2.5, 97.5))
        lines.append(
            f"| {name} | {len(delay)} | {delay.mean() / len(scenes):.1f} | "
            f"{100.0 * saving.sum() / delay.sum():.0f} % [{low:.0f}, {high:.0f}] | "
            f"{more.mean() / len(scenes):+.2f} [{few:+.2f}, {many:+.2f}] |"
        )
    return lines


def write(name: str, lines: list[str]) -> None:
    """Put lines between the marks of that name in the page."""
    text = PAGE.read_text(encoding="utf-8")
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
    before, rest = text.split(begin)
    after = rest.split(end)[1]
    PAGE.write_text(before + begin + "\n".join(lines) + "\n" + end + after, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="into docs/controllers.md")
    parser.add_argument("--margins", action="store_true", help="these and what is saved")
    options = parser.parse_args()
    if options.margins:
        found = {"saved": saved(options.folder), "margins": margins(options.folder)}
    elif "driver" in pd.read_csv(options.folder / "cells.csv"):
        briefly = [column for column in COLUMNS if column.name in BRIEFLY]
        found = {"attitudes": table(options.folder, "driver", briefly)}
    else:
        found = {
            "differences": differences(options.folder),
            "saved": saved(options.folder),
            "margins": margins(options.folder),
            "all scenes": table(options.folder, "controller", COLUMNS),
        }
    for name, lines in found.items():
        if not lines:
            continue  # the study lacks the scenes for it
        if options.write:
            write(name, lines)
        else:
            print("\n".join(lines), end="\n\n")


if __name__ == "__main__":
    main()
