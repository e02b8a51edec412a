"""What each assumption about people costs.

Run: python benchmarks/evidence/people_at_worst.py [--seeds 20]

Crowds of the default scenario (30 people, from one side and from both) and of the encounters are
driven through with each model of people's worst motion below ``pid-tuned`` and ``mpc``. What the
columns mean: docs/safety.md.
"""

from __future__ import annotations

import argparse
import multiprocessing
from typing import Any, NamedTuple, get_args

import numpy as np

import giveway
from controller import PeopleName
from giveway.studies.statistics.bootstrap import mean_interval, seed_of

SCENES: dict[str, dict[str, Any]] = {
    "one-sided, 30": {"crowd": {"pedestrians": 30}},
    "two-sided, 30": {"crowd": {"pedestrians": 30, "two_sided": True}},
    "encounter, 24": {"scenario": "encounter", "crowd": {"pedestrians": 24}},
}
CONTROLLERS = ("pid-tuned", "mpc")
NUMBERS = (
    "completion_time",
    "longest_wait",
    "conflicts",
    "safety_share",
    "frontal_contacts",
    "beyond_assumption",
    "contacts_beyond",
)


class Task(NamedTuple):
    """One run."""

    scene: str
    controller: str
    people: str
    seed: int


def examine(task: Task) -> list[float]:
    """The numbers of a run."""
    config = {"controller": task.controller, "seed": task.seed, "safety": {"people": task.people}}
    summary = giveway.run({**SCENES[task.scene], **config}).summary
    return [float(summary[name]) for name in NUMBERS]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=None)
    options = parser.parse_args()
    names, seeds = get_args(PeopleName), range(1, options.seeds + 1)
    print("mean, and mean paired difference to worst-case in the completion time [95 % interval]")
    print(
        f"{'':40}{'time [s]':>9} {'saved [s]':>22} {'wait':>6} {'confl.':>6} {'layer':>7}", end=""
    )
    print(f" {'frontal':>7} {'beyond':>7} {'hit':>4}")
    with multiprocessing.get_context("spawn").Pool(options.jobs) as pool:
        for scene in SCENES:
            for controller in CONTROLLERS:
                base = None
                for name in names:
                    tasks = [Task(scene, controller, name, seed) for seed in seeds]
                    found = np.array(pool.map(examine, tasks, 1))
                    base = found[:, 0] if base is None else base
                    saved = _interval(base - found[:, 0], f"{scene} {controller} {name}")
                    time, wait, conflicts, layer = found[:, :4].mean(axis=0)
                    frontal, beyond, hit = found[:, 4:].sum(axis=0)
                    print(
                        f"{scene:14} {controller:10}{name:15}{time:9.2f} {saved:>22} {wait:6.2f} "
                        f"{conflicts:6.2f} {layer:7.2%} {frontal:7.0f} {beyond:7.0f} {hit:4.0f}",
                        flush=True,
                    )


def _interval(values: np.ndarray, name: str) -> str:
    if not values.any():
        return "-"
    between = mean_interval(values, confidence=0.95, resamples=2000, seed=seed_of([name]))
    return f"{values.mean():.2f} [{between.low:.2f}, {between.high:.2f}]"


if __name__ == "__main__":
    main()
