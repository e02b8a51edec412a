"""Drives past a school, with children who cross in groups from between parked cars.

Run: python benchmarks/bounds/school_run.py [--instants 9] [--out FOLDER]

The scenario is `school_run`, once as it is, with children within the assumption about people who
are not seen, and once with those of its file `running.toml`, who are beyond it. Each driver makes
`--instants` drives per variant, in which the groups set out for meetings from 6 m before to 6 m
behind those of the scenario. Printed are, by variant and driver: the median time and the median
speed past the cars, the hardest braking of all drives, the drives with a moving front that hit a
child, the children whom fronts hit and the highest speed, and the children who walked into a side.
`--out` gets ``school_run.csv``, one row per drive.
"""

from __future__ import annotations

import argparse
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
from hidden_child import DRIVERS, contact_of
from markdown_table import markdown

import giveway
from sumo_scenarios import find

NAMES = (
    "mpc, nobody comes out",
    "mpc, 0.3 m/s (default)",
    "mpc, no layer",
    "pid-tuned, 0.3 m/s",
    "idm",
    "careful-driver",
)
ROW, SHIFT = (45.0, 121.0), 6.0  # m: the parked cars; the farthest meeting from the scenario's
FILES = {"within": "school_run.giveway.toml", "beyond": "running.toml"}


def children(variant: str, shift: float) -> list[dict[str, object]]:
    """Return the children of a variant with their meetings moved by ``shift`` [m]."""
    file = find("school_run").folder / FILES[variant]
    crowd = tomllib.loads(file.read_text(encoding="utf-8"))["crowd"]
    return [child | {"meet_x": child["meet_x"] + shift} for child in crowd["scripted"]]


def drive(variant: str, driver: str, shift: float) -> dict[str, object]:
    """Return the row of one drive."""
    scripted = children(variant, shift)
    base = {"scenario": "school_run", "sumo.baseline": False, "crowd.scripted": scripted}
    result = giveway.run(base | DRIVERS[driver])
    ego, rows = result.ego, result.trajectories
    met = [contact_of(rows[rows["id"] == child["name"]], result) for child in scripted]
    return {
        "children": variant,
        "driver": driver,
        "shift": shift,
        "time [s]": float(result.summary["completion_time"]),
        "past the cars [km/h]": 3.6 * float(ego[ego["x"].between(*ROW)]["speed"].median()),
        "hardest braking [m/s²]": float(result.summary["peak_deceleration"]),
        "by the front": sum(contact == "front" for contact, _ in met),
        "fastest [km/h]": 3.6
        * max((v for contact, v in met if contact == "front"), default=np.nan),
        "into a side": sum(contact == "side" for contact, _ in met),
    }


def summarised(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the table by variant and driver, of one row per drive."""
    by = rows.groupby(["children", "driver"], sort=False)
    table = by[["time [s]", "past the cars [km/h]"]].median()
    table["hardest braking [m/s²]"] = by["hardest braking [m/s²]"].max()
    table["drives"] = by.size()
    table["that hit a child"] = by["by the front"].agg(lambda hit: int((hit > 0).sum()))
    table["children hit by the front"] = by["by the front"].sum()
    table["fastest [km/h]"] = by["fastest [km/h]"].max()
    table["into a side"] = by["into a side"].sum()
    return table.reset_index()


def main() -> None:
    """Print the table, and write the drives if asked to."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--instants", type=int, default=9)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    shifts = np.linspace(-SHIFT, SHIFT, options.instants)
    rows = pd.DataFrame(
        drive(variant, driver, float(shift))
        for variant in FILES
        for driver in NAMES
        for shift in shifts
    )
    print(markdown(summarised(rows)))
    if options.out is not None:
        options.out.mkdir(parents=True, exist_ok=True)
        rows.to_csv(options.out / "school_run.csv", index=False)


if __name__ == "__main__":
    main()
