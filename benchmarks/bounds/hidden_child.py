"""Drives past parked cars, with a child that runs out between two of them at every unlucky moment.

Run: python benchmarks/bounds/hidden_child.py [--instants 24] [--out FOLDER]

The scenario is `parked_cars`. For each driver the drive without the child tells when its front is
at the gap. Then the child gets to the side of the car at `--instants` instants, 0.125 s apart,
about that time. Printed are, by driver: the time of the drive without the child and its median
speed past the cars, the contacts of the moving front and of the sides, the highest impact speed,
and the most by which an impact is faster than physics allows: that after braking as hard as the
car can, from the first step after the child is perceived on. `--out` gets ``hidden_child.csv``, one
row per drive, and the picture ``hidden_child.png``.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
from markdown_table import markdown

import giveway
from sumo_scenarios import find

mpl.use("Agg")
from matplotlib import pyplot as plt

DRIVERS: dict[str, dict[str, object]] = {
    "mpc, nobody comes out": {"safety.hidden_speed": 0.0},
    "mpc, 0.3 m/s (default)": {},
    "mpc, 0.5 m/s": {"safety.hidden_speed": 0.5},
    "mpc, 1.0 m/s": {"safety.hidden_speed": 1.0},
    "mpc, no layer": {"safety.enabled": False, "rules.hidden_people": False},
    "pid-tuned, 0.3 m/s": {"controller": "pid-tuned"},
    "idm": {"controller": "idm", "rules.hidden_people": False, "safety.enabled": False},
    "careful-driver": {
        "controller": "careful-driver",
        "rules.hidden_people": False,
        "safety.enabled": False,
    },
}
FOLDER = find("parked_cars").folder
GAP, STARTS, SIDE = 89.0, -7.0, -2.75  # m: the child's x and first y; the car's side
PACE, RADIUS, ROW = 5.0 / 3.6, 0.27, (45.0, 122.0)  # m/s; m; m
MOVES = 0.1  # m/s
STEP, HARDEST, NEVER = 0.125, 8.0, 1000.0  # s between instants; m/s^2; s


@dataclass(frozen=True)
class Drive:
    """One drive: when the child came, and what became of it."""

    driver: str
    offset: float  # s between the front at the gap and the child at the car's side
    first_sight: float  # m from the front bumper to the child's line when it came in sight
    speed: float  # m/s then
    contact: str  # "front", "side", "stands" (the child runs into the car at rest) or none
    impact: float  # m/s at the contact with the front; NaN without one
    allowed: float  # m/s, what physics allows


def run(changes: dict[str, object], begin: float) -> giveway.RunResult:
    """Drive past the cars; the child starts ``begin`` [s] after the run's start."""
    files = {"path": str(FOLDER / "child.csv"), "dataset": str(FOLDER / "child.toml")}
    child = {"name": "child", "kind": "child"} | files
    base = {"scenario": "parked_cars", "crowd.recorded": [child | {"begin": begin}]}
    return giveway.run(base | changes)


def drive(driver: str, changes: dict[str, object], begin: float, offset: float) -> Drive:
    """One drive with the child, and what came of it."""
    result = run(changes, begin)
    ego, rows = result.ego, result.trajectories
    contact, impact = contact_of(rows[rows["id"].str.startswith("child")], result)
    seen = result.sights
    if not len(seen):
        return Drive(driver, offset, np.nan, np.nan, contact, impact, np.nan)
    now = ego.iloc[int(np.argmin((ego["time"] - seen["time"].iloc[0]).abs()))]
    distance, speed = GAP - RADIUS - now["x"], float(now["speed"])
    left = max(distance - speed * (ego["time"].iloc[1] - ego["time"].iloc[0]), 0.0)
    allowed = float(np.sqrt(max(speed * speed - 2.0 * HARDEST * left, 0.0)))
    return Drive(driver, offset, float(distance), speed, contact, float(impact), allowed)


def contact_of(child: pd.DataFrame, result: giveway.RunResult) -> tuple[str, float]:
    """Return what a child touched first, and the speed [m/s] of a front that moved into it.

    Args:
        child: Rows of the child in ``trajectories.csv``.
        result: Drive along the x axis.
    """
    both, shape = child.merge(result.ego, on="time", suffixes=("", "_ego")), result.shape
    along, across = both["x"] - both["x_ego"], (both["y"] - both["y_ego"]).abs() - shape.width / 2
    near_x = np.maximum(np.maximum(along, -shape.length - along), 0.0)
    touched = np.hypot(near_x, np.maximum(across, 0.0)) < RADIUS
    if not touched.any():
        return "", np.nan
    first = touched.idxmax()
    speed = float(both["speed_ego"][first])
    if along[first] <= -0.05:
        return "side", np.nan
    return ("front", speed) if speed > MOVES else ("stands", np.nan)


def main() -> None:
    """Print the table, and write the drives and their picture if asked to."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--instants", type=int, default=24)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    rows, drives = [], []
    for driver, changes in DRIVERS.items():
        free = run(changes, NEVER).ego
        past = free[free["x"].between(*ROW)]
        passes = float(np.interp(GAP, free["x"], free["time"] - free["time"].iloc[0]))
        runs = (SIDE - RADIUS - STARTS) / PACE  # s until it is at the car's side
        offsets = STEP * (np.arange(options.instants) - options.instants / 2)
        mine = [drive(driver, changes, passes + t - runs, float(t)) for t in offsets]
        drives += mine
        front = [one for one in mine if one.contact == "front"]
        rows.append(
            {
                "driver": driver,
                "time without the child [s]": float(free["time"].iloc[-1] - free["time"].iloc[0]),
                "past the cars [km/h]": 3.6 * float(past["speed"].median()),
                "hit by the moving front": len(front),
                "into its side": sum(one.contact == "side" for one in mine),
                "fastest impact [km/h]": _most(d.impact for d in front),
                "above physics [km/h]": _most(d.impact - d.allowed for d in front),
            }
        )
    print(markdown(pd.DataFrame(rows)))
    if options.out is not None:
        options.out.mkdir(parents=True, exist_ok=True)
        table = pd.DataFrame([asdict(one) for one in drives])
        table.to_csv(options.out / "hidden_child.csv", index=False)
        _draw(table, options.out / "hidden_child.png")


def _most(speeds: Iterable[float]) -> float:
    """The highest of some speeds [m/s] in km/h, or NaN without any."""
    return 3.6 * max(speeds, default=np.nan)


def _draw(table: pd.DataFrame, file: Path) -> None:
    """Impact speed over first-sight distance, beside what braking physics allows."""
    figure, axes = plt.subplots(figsize=(8.0, 5.0), layout="constrained")
    for driver, mine in table.groupby("driver", sort=False):
        impact = 3.6 * mine["impact"].fillna(0.0)
        axes.plot(mine["first_sight"], impact, "o", ms=4, alpha=0.7, label=driver)
    distance = np.linspace(0.0, 12.0, 200)
    for speed, style in ((30.0, "-"), (20.0, "--"), (10.0, ":")):
        v = speed / 3.6
        left = np.maximum(distance - 0.05 * v, 0.0)
        allowed = 3.6 * np.sqrt(np.maximum(v * v - 2.0 * HARDEST * left, 0.0))
        axes.plot(distance, allowed, style, color="black", lw=1, label=f"physics, {speed:g} km/h")
    axes.set(xlabel="distance at first sight [m]", ylabel="impact speed [km/h]", xlim=(0, 12))
    axes.legend(fontsize=8)
    figure.savefig(file, dpi=120)


if __name__ == "__main__":
    main()
