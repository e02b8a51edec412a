"""Counts the first runs, of the seeds 1 to 20, that look alarming to a stranger, and says why.

Run: python benchmarks/bounds/first_runs.py [--seeds 20] [--controller mpc]

Alarming is a clearance below 0.3 m at more than 1 m/s or below 0.5 m at more than 2 m/s, a braking
of more than 3 m/s^2, a stand of more than 20 s with the way free, or a contact. Drives in which
people come so near only at the last tenth of the body or behind it are counted apart: they walk
closely behind a car that drives away.
"""

from __future__ import annotations

import argparse

import numpy as np

import giveway

SCENARIOS = ("shared_space", "encounter", "crossings", "junction")
BODY = 0.27  # radius [m] of a person
PASSES = (0.3, 1.0), (0.5, 2.0)  # clearance [m] and speed [m/s] of alarming passes
BRAKING, STAND, STANDING = 3.0, 20.0, 0.1  # [m/s^2], [s], [m/s]
NAMES = "passes", "behind only", "braking", "stands", "contacts"


def alarms(result: giveway.RunResult) -> set[str]:
    """The kinds of alarm of a drive."""
    ego, rows, found = result.ego, result.trajectories, set()
    length, width = result.shape.length, result.shape.width
    rows = rows[rows["id"].isin(set(result.pedestrians["id"]))]
    at = np.searchsorted(ego["time"].to_numpy(), rows["time"].to_numpy() - 1e-9)
    front = ego.iloc[at]
    heading = np.radians(90.0 - front["angle"].to_numpy())
    x, y = (rows[axis].to_numpy() - front[axis].to_numpy() for axis in "xy")
    along = x * np.cos(heading) + y * np.sin(heading)
    beside = np.abs(y * np.cos(heading) - x * np.sin(heading)) - width / 2.0
    outside = np.maximum(np.maximum(along, -length - along), 0.0), np.maximum(beside, 0.0)
    clearance, speed = np.hypot(*outside) - BODY, front["speed"].to_numpy()
    near = np.any([(clearance < gap) & (speed > fast) for gap, fast in PASSES], axis=0)
    behind = along < -0.9 * length
    if (near & ~behind).any():
        found.add("passes")
    elif near.any():
        found.add("behind only")
    summary = result.summary
    if round(summary["peak_deceleration"], 1) > BRAKING:  # firm braking has 3.0
        found.add("braking")
    free = (ego["waits_for"].fillna("") == "") & (ego["speed"] < STANDING)
    stands = free.groupby((free != free.shift()).cumsum()).sum() * ego["time"].diff().median()
    if stands.max() > STAND:
        found.add("stands")
    if summary["overlaps"]:
        found.add("contacts")
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--controller", default="mpc")
    chosen = parser.parse_args()
    print("| scenario | alarming seeds |", " | ".join(NAMES), "|")
    print("|---" * (len(NAMES) + 2) + "|")
    for scenario in SCENARIOS:
        each = {
            seed: alarms(
                giveway.run({"scenario": scenario, "controller": chosen.controller, "seed": seed})
            )
            for seed in range(1, chosen.seeds + 1)
        }
        seeds = [[seed for seed, found in each.items() if name in found] for name in NAMES]
        number = sum(bool(found - {"behind only"}) for found in each.values())
        cells = (" ".join(map(str, some)) or "none" for some in seeds)
        print(f"| {scenario} | {number} of {chosen.seeds} |", " | ".join(cells), "|", flush=True)


if __name__ == "__main__":
    main()
