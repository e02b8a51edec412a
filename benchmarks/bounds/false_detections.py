"""Measures what false detections cost: drives with cameras that see people who are not there.

Run: python benchmarks/bounds/false_detections.py [--seeds 10] [--out FOLDER]

The scenarios are `shared_space` and `parked_cars` without its child. Printed are, by scenario and
kind of false detections: how many there were per drive, the mean time of the drives, the mean and
the largest loss against the same seed without any, the mean share of steps in which the safety
layer acted, the mean number of brakings above 4 m/s^2 with nobody and nothing within 15 m ahead,
and all contacts with moving fronts. `--out` gets ``false_detections.csv``, one row per drive.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas as pd
from markdown_table import markdown

import giveway
from sumo_scenarios import find

FOLDER = find("parked_cars").folder
NEVER = 1000.0  # s
CHILD = {
    "name": "child",
    "path": str(FOLDER / "child.csv"),
    "dataset": str(FOLDER / "child.toml"),
    "begin": NEVER,
}
SCENARIOS: dict[str, dict[str, object]] = {
    "shared_space": {"scenario": "shared_space", "perception.sensor": "sight"},
    "parked_cars": {"scenario": "parked_cars", "crowd.recorded": [CHILD], "time_limit": 300.0},
}
KINDS = {  # rate [1/s] per camera, speed [m/s]
    "none": (0.0, 0.0),
    "0.1/s, standing": (0.1, 0.0),
    "0.1/s, walking": (0.1, 1.4),
    "1/s, standing": (1.0, 0.0),
    "1/s, walking": (1.0, 1.4),
}


def drive(scenario: str, kind: str, seed: int) -> dict[str, object]:
    """Return the row of one drive."""
    rate, speed = KINDS[kind]
    made_up = {"sensor_options.false_rate": rate, "sensor_options.false_speed": speed}
    base = {"seed": seed, "sumo.baseline": False}
    result = giveway.run(SCENARIOS[scenario] | base | made_up)
    summary = result.summary
    return {
        "scenario": scenario,
        "false detections": kind,
        "seed": seed,
        "per drive": int(result.sights["id"].astype(str).str.startswith("false:").sum()),
        "time [s]": float(summary["completion_time"]),
        "layer acts [%]": 100.0 * float(summary["safety_share"]),
        "hard brakings for nothing": int(summary["hard_brakes_without_cause"]),
        "frontal contacts": int(summary["frontal_contacts"]),
    }


def summarised(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the table by scenario and kind, of one row per drive."""
    keys = ["scenario", "false detections"]
    free = rows[rows["false detections"] == "none"].set_index(["scenario", "seed"])["time [s]"]
    rows = rows.assign(
        lost=rows["time [s]"]
        - free.loc[list(zip(rows["scenario"], rows["seed"], strict=True))].to_numpy()
    )
    by = rows.groupby(keys, sort=False)
    table = by[["per drive", "time [s]", "layer acts [%]", "hard brakings for nothing"]].mean()
    table.insert(2, "lost, mean [s]", by["lost"].mean())
    table.insert(3, "lost, most [s]", by["lost"].max())
    table["frontal contacts"] = by["frontal contacts"].sum()
    return table.reset_index()


def main() -> None:
    """Print the table, and write the drives if asked to."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    rows = pd.DataFrame(
        drive(scenario, kind, seed)
        for scenario in SCENARIOS
        for kind in KINDS
        for seed in range(1, options.seeds + 1)
    )
    print(markdown(summarised(rows)))
    if options.out is not None:
        options.out.mkdir(parents=True, exist_ok=True)
        rows.to_csv(options.out / "false_detections.csv", index=False)


if __name__ == "__main__":
    main()
