"""What noise in perceived positions costs: python benchmarks/evidence/noise.py [--seeds 60].

Crowds of the default scenario (30 people) are driven through as they are, with white noise of 0.1 m
in x and in y, and with a tracker between that and the controllers; docs/safety.md.
"""

from __future__ import annotations

import argparse
import multiprocessing
from typing import Any, NamedTuple

import numpy as np

import giveway

CONTROLLERS = ("mpc", "pid-tuned")
SEEN: dict[str, dict[str, Any]] = {
    "exactly": {},
    "raw": {"position_noise": 0.1, "tracker": False},
    "tracked": {"position_noise": 0.1},
}
NUMBERS = ("completion_time", "rms_jerk", "conflicts", "safety_share", "frontal_contacts")
FIRST = 301


class Task(NamedTuple):
    """One run."""

    controller: str
    seen: str
    seed: int


def examine(task: Task) -> list[float]:
    """The numbers of a run."""
    run = {"controller": task.controller, "seed": task.seed, "crowd": {"pedestrians": 30}}
    summary = giveway.run({**run, "perception": SEEN[task.seen]}).summary
    return [float(summary[name]) for name in NUMBERS]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=60)
    parser.add_argument("--jobs", type=int, default=None)
    options = parser.parse_args()
    seeds = range(FIRST, FIRST + options.seeds)
    tasks = [Task(c, seen, seed) for c in CONTROLLERS for seen in SEEN for seed in seeds]
    with multiprocessing.get_context("spawn").Pool(options.jobs) as pool:
        found = np.array(pool.map(examine, tasks, chunksize=4))
    means = found.reshape(len(CONTROLLERS), len(SEEN), len(seeds), -1).mean(axis=2)
    print(
        "| | people seen | completion [s] | RMS jerk [m/s³] | conflicts | layer acts | contacts |"
    )
    print("|---|---|---|---|---|---|---|")
    for controller, rows in zip(CONTROLLERS, means, strict=True):
        for seen, (time, jerk, conflicts, share, contacts) in zip(SEEN, rows, strict=True):
            numbers = f"{time:.2f} | {jerk:.1f} | {conflicts:.1f} | {100 * share:.2f} %"
            print(f"| `{controller}` | {seen} | {numbers} | {contacts * len(seeds):.0f} |")


if __name__ == "__main__":
    main()
