"""Drives of vehicles whose forces act late, beside one that answers at once, over paired seeds.

Run: python benchmarks/bounds/own_plants.py FOLDER --out OUT [--vehicles a,b] [--runs 30] [--jobs 1]

FOLDER has the FMUs; the first one named is the reference. Each is identified first; the profile
stays in OUT. The drives are a study in OUT, which can be ended and resumed: `crossings` with the
controller that is named, no flag but --vehicle and --profile.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from giveway.studies.definition import make_definition
from giveway.studies.study import run_study
from giveway.studies.study_options import StudyOptions

VEHICLES = "ideal1200,p6_deadtime,p9_truck"
COUNTED = (
    "stops_without_cause",
    "red_lights_run",
    "failures_to_yield",
    "frontal_contacts",
    "side_contacts",
    "vehicle_contacts",
    "hard_brakes",
)


def main() -> None:
    """Identify the vehicles, make the drives, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--vehicles", default=VEHICLES)
    parser.add_argument("--scenario", default="crossings")
    parser.add_argument("--controller", default="mpc")
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=30, help="seeds of each vehicle")
    parser.add_argument("--jobs", type=int, default=1)
    chosen = parser.parse_args()
    names = chosen.vehicles.split(",")
    chosen.out.mkdir(parents=True, exist_ok=True)
    study = chosen.out / f"{chosen.scenario}-{chosen.controller}"
    definition = make_definition(
        {
            "name": "own-plants",
            "replications": chosen.runs,
            "first_seed": chosen.first_seed,
            "table": "levels",
            "run": {"scenario": chosen.scenario, "controller": chosen.controller},
            "factors": {
                "vehicle": {name: vehicle(chosen.folder, name, chosen.out) for name in names}
            },
        },
        "own_plants.py",
    )
    options = StudyOptions(jobs=chosen.jobs, resume=(study / "manifest.json").exists())
    table = run_study(definition, "own_plants.py", study, options).runs
    drives = {name: table[table["vehicle"] == name].set_index("seed") for name in names}
    print(f"| vehicle | arrived | time [s] | over {names[0]} | TTC, 5 % [s] | {head()} |")
    print("|---" * (5 + len(COUNTED)) + "|")
    for name, one in drives.items():
        print(row(name, one, drives[names[0]]))


def head() -> str:
    """Return the titles of what is counted."""
    return " | ".join(name.replace("_", " ") for name in COUNTED)


def vehicle(folder: Path, name: str, out: Path) -> dict[str, Any]:
    """Return the level of one vehicle, which is identified if its profile is not there yet."""
    fmu, profile = folder / f"{name}.fmu", out / f"{name}.toml"
    if not profile.exists():
        command = [sys.executable, "-m", "giveway", "fmu", "identify", str(fmu), "-o", str(profile)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, cwd=out)
    return {"vehicle": {"fmu": str(fmu.resolve()), "profile": str(profile.resolve())}}


def row(name: str, one: pd.DataFrame, reference: pd.DataFrame) -> str:
    """Return the row of one vehicle: means, the 5 % quantile of the least TTC, and sums."""
    both = one.index.intersection(reference.index)
    time = one["completion_time"].fillna(one["simulated_time"])
    usual = reference["completion_time"].fillna(reference["simulated_time"])
    over = time[both].mean() / usual[both].mean()
    ttc = np.nanquantile(one["minimum_ttc"], 0.05)
    sums = " | ".join(f"{one[key].sum():.0f}" for key in COUNTED)
    arrived = f"{one['completed'].astype(bool).sum()} of {len(one)}"
    return f"| {name} | {arrived} | {time.mean():.1f} | {over:.3f} | {ttc:.2f} | {sums} |"


if __name__ == "__main__":
    main()
