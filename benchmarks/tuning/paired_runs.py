"""What a change does to how the ego drives: the same runs before and after, compared in pairs.

Run: PYTHONPATH=BEFORE python benchmarks/tuning/paired_runs.py --write before.json [--seeds 101 221]
     PYTHONPATH=AFTER python benchmarks/tuning/paired_runs.py --write after.json [--seeds 101 221]
     python benchmarks/tuning/paired_runs.py --compare before.json after.json
     ... --people                           # before people of other models: docs/planner.md
     ... --options '{"controller_options": {"horizon": 3}}'     # in all of the runs

Only public names are used, so that two states of the repository can be compared. A difference is
the mean over the seeds, with its 95 % bootstrap interval. What counts is many seeds: a run in which
one decision falls otherwise goes on differently from there.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

KINDS: dict[str, dict[str, Any]] = {
    "30 people": {"crowd": {"pedestrians": 30}},
    "30 people, from both sides": {"crowd": {"pedestrians": 30, "two_sided": True}},
    "street": {"scenario": "street"},
}
PEOPLE: dict[str, dict[str, Any]] = {
    f"{name}, {model}": {"scenario": scenario, "crowd": {"pedestrians": count, "model": model}}
    for name, scenario, count in (("crowd", "shared_space", 30), ("encounter", "encounter", 24))
    for model in ("vci", "gap-acceptance", "orca", "social-force")
}
SHOWN = (
    "completed",
    "completion_time",
    "total_wait",
    "longest_wait",
    "close_passes",
    "conflicts",
    "people_below_ttc",
    "share_below_ttc",
    "minimum_ttc_moving",
    "maximum_drac",
    "rms_jerk",
    "peak_deceleration",
    "hard_brakes",
    "minimum_clearance",
    "overlaps",
    "safety_share",
)
_RESAMPLES = 2000


def summaries(
    seeds: range, kinds: dict[str, dict[str, Any]], options: dict[str, Any]
) -> dict[str, dict[str, float]]:
    """The numbers of the summary of each run, by kind and seed."""
    import giveway

    found = {}
    for name, kind in kinds.items():
        for seed in seeds:
            result = giveway.run({**options, "seed": seed, **kind})
            numbers = {k: v for k, v in result.summary.items() if isinstance(v, (int, float))}
            found[f"{name} / {seed}"] = numbers
    return found


def show(before: dict[str, dict[str, float]], after: dict[str, dict[str, float]]) -> None:
    """Print the means of both and their difference, kind by kind."""
    g = np.random.default_rng(0)
    for name in {**KINDS, **PEOPLE}:
        runs = [run for run in before if run.startswith(f"{name} / ") and run in after]
        if runs:
            print(f"{name}, {len(runs)} pairs")
        for quantity in SHOWN if runs else ():
            pairs = np.array([(before[run][quantity], after[run][quantity]) for run in runs])
            pairs = pairs.astype(np.float64)
            pairs = pairs[np.isfinite(pairs).all(axis=1)]
            if not len(pairs):
                continue
            change = pairs[:, 1] - pairs[:, 0]
            means = g.choice(change, (_RESAMPLES, len(change))).mean(axis=1)
            low, high = np.percentile(means, [2.5, 97.5])
            one, two = pairs.mean(axis=0)
            told = f"{one:9.4f} {two:9.4f}   {change.mean():+8.4f} [{low:+.4f}, {high:+.4f}]"
            print(f"  {quantity:20} {told}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", type=Path, help="run, and write the summaries here")
    parser.add_argument("--compare", type=Path, nargs=2, help="two such files")
    parser.add_argument("--seeds", type=int, nargs=2, default=(1, 31), help="first, last plus one")
    parser.add_argument("--controller", default="mpc")
    parser.add_argument("--people", action="store_true", help="of four models, two scenes each")
    parser.add_argument("--options", type=json.loads, default={}, help="of all runs, as JSON")
    options = parser.parse_args()
    if options.write is not None:
        common = {"controller": options.controller, **options.options}
        kinds = PEOPLE if options.people else KINDS
        found = summaries(range(*options.seeds), kinds, common)
        options.write.write_text(json.dumps(found), encoding="utf-8")
    if options.compare is not None:
        show(*(json.loads(file.read_text(encoding="utf-8")) for file in options.compare))


if __name__ == "__main__":
    main()
