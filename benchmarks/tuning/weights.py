"""Would other weights make the default better?

Run: python benchmarks/tuning/weights.py FILE [--draws 40]

Draws the planner's weights, distance and horizon at random, drives the same crowds (seeds of
tuning) with each, and with pid-tuned and the default, and keeps what came out in FILE, one line
each: it can be ended at any time and goes on where it was. The table has, best saving first, how
much of pid-tuned's delay is saved (the scenes of SAVING pooled), and by how much the people less
than 1.5 s from a collision, the share of steps with one and that of people with a post-encroachment
time below 1 s exceed pid-tuned's, at most and scene by scene; docs/controllers.md.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
from pathlib import Path
from typing import Any

import numpy as np

import giveway

STREAM = {"pedestrians": 30, "spawn_area": [23.3, -72.0, 33.2, -6.0], "walk": [0.0, 100.0]}
SCENES: dict[str, dict[str, Any]] = {
    "one-sided, 30": {"crowd": {"pedestrians": 30}},
    "two-sided, 30": {"crowd": {"pedestrians": 30, "two_sided": True}},
    "two-sided, 60": {"crowd": {"pedestrians": 60, "two_sided": True}},
    "stream, 30": {"crowd": STREAM},
    "encounter, medium": {"scenario": "encounter", "crowd": {"pedestrians": 24}},
    "encounter, dense": {"scenario": "encounter", "crowd": {"pedestrians": 48}},
}
SAVING = tuple(SCENES)[:5]
RANGES = {
    "precaution_weight": (2.0, 30.0),
    "minimum_distance": (0.5, 1.5),
    "threat_weight": (0.5, 3.0),
    "later_weight": (0.7, 1.3),
    "horizon": (2.0, 3.0),
}
NUMBERS = ("completion_time", "people_below_ttc", "share_below_ttc", "share_below_pet")


def drive(task: tuple[dict[str, float] | None, int]) -> dict[str, list[float]]:
    """Means of NUMBERS by scene, with these weights (None: of pid-tuned) and so many crowds."""
    planner, crowds = task
    who = {"controller": "pid-tuned"} if planner is None else {"controller_options": planner}
    seeds, found = range(1, 1 + crowds), {}
    for name, scene in SCENES.items():
        runs = [giveway.run({**who, **scene, "seed": seed}, pictures=False) for seed in seeds]
        found[name] = [float(np.mean([run.summary[n] for run in runs])) for n in NUMBERS]
    return found


def free(scene: dict[str, Any]) -> float:
    """The time [s] with nobody about."""
    crowd = {**scene["crowd"], "pedestrians": 0}
    return float(giveway.run({**scene, "crowd": crowd}, pictures=False).summary["completion_time"])


def draws(count: int) -> list[dict[str, float]]:
    """The default, and weights drawn evenly from RANGES on a logarithmic scale."""
    g = np.random.default_rng(19)
    return [{}] + [
        {name: round(float(np.exp(g.uniform(*np.log(ends)))), 2) for name, ends in RANGES.items()}
        for _ in range(count)
    ]


def show(rows: list[dict[str, Any]]) -> None:
    """Print the table."""
    rival = next(row["means"] for row in rows if row["planner"] is None)
    delay = sum(rival[name][0] - free(SCENES[name]) for name in SAVING)
    lines = []
    for row in rows:
        if row["planner"] is None:
            continue
        means = row["means"]
        saved = sum(rival[name][0] - means[name][0] for name in SAVING) / delay
        told = [f"{100 * saved:.0f} %"]
        for k, digits in enumerate((1, 2, 2), start=1):
            more = [means[name][k] - rival[name][k] for name in SCENES]
            told += [f"{max(more):+.{digits}f} ({', '.join(f'{x:+.{digits}f}' for x in more)})"]
        weights = ", ".join(f"{name} {value}" for name, value in row["planner"].items())
        lines.append((saved, "| " + " | ".join([*told, weights or "the default"]) + " |"))
    print("In turn: " + ", ".join(SCENES))
    print("| saved | most below 1.5 s more | TTC | PET | weights |\n|---|---|---|---|---|")
    print("\n".join(line for _, line in sorted(lines, reverse=True)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--draws", type=int, default=40)
    parser.add_argument("--seeds", type=int, default=24, help="crowds of each scene")
    parser.add_argument("--jobs", type=int, default=None)
    options = parser.parse_args()
    rows = []
    if options.file.exists():
        rows = [json.loads(line) for line in options.file.read_text("utf-8").splitlines()]
    known = [row["planner"] for row in rows]
    wanted = [planner for planner in (None, *draws(options.draws)) if planner not in known]
    tasks = [(planner, options.seeds) for planner in wanted]
    with multiprocessing.get_context("spawn").Pool(options.jobs) as pool:
        work = pool.imap(drive, tasks)
        for planner, means in zip(wanted, work, strict=True):
            rows.append({"planner": planner, "means": means})
            with options.file.open("a", encoding="utf-8") as file:
                file.write(json.dumps(rows[-1]) + "\n")
    show(rows)


if __name__ == "__main__":
    main()
