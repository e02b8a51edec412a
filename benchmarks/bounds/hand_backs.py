"""Measures where people are put in SUMO when they are handed back, and who stays held too long.

Run: python benchmarks/bounds/hand_backs.py --out FOLDER SCENARIO... [--seeds 1-10] [--limit 200]

Each drive has no ego. Its zone is a comb over the whole network: strips of 12 m, 40 m apart, which
everybody enters and leaves again and again. A jump is what SUMO's own output (`fcd`) shows beyond a
walk of 2 m/s in the steps of a hand-back. FOLDER holds one row per drive, so that the command can
be ended and resumed; the sums are printed of all rows.
"""

from __future__ import annotations

import argparse
import csv
import json
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections import defaultdict
from pathlib import Path
from typing import NamedTuple

import numpy as np
import shapely

from giveway.walkways import WalkNetwork

TOOTH, PITCH, MARGIN = 12.0, 40.0, 5.0  # [m] width and distance of strips; the zone's hysteresis
WALK = 2.0  # fastest walk [m/s]
HELD, STUCK = 20.0, 60.0  # times [s] after leaving the zone
COUNTS = ["taken_over", "handed_back", "arrived", "continued", "walking"]
FOUND = ["over_1m", "over_2m", "late", "stuck"]
FIELDS = ["drive", *COUNTS, *FOUND, "largest", "said"]


class Walk(NamedTuple):
    """The rows of one person in a run."""

    times: np.ndarray
    places: np.ndarray


def comb(boundary: tuple[float, float, float, float], seed: int) -> str:
    """The corners of a comb over a network; even seeds have horizontal strips if there is room."""
    x_min, y_min, x_max, y_max = boundary
    vertical = bool(seed % 2) or y_max - y_min < PITCH
    low, high = (x_min, x_max) if vertical else (y_min, y_max)
    base, top = (y_min - 20.0, y_max) if vertical else (x_min - 20.0, x_max)
    offset = np.random.default_rng(seed).uniform(0.0, PITCH)
    corners = [(low - PITCH, base - 1.0), (low - PITCH, base)]
    for start in np.arange(low - PITCH + offset, high, PITCH):
        stop = start + TOOTH
        corners += [(start, base), (start, top), (stop, top), (stop, base)]
    corners += [(high + PITCH, base), (high + PITCH, base - 1.0)]
    points = corners if vertical else [(y, x) for x, y in corners]
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in points)


def told_by_sumo(fcd: Path) -> dict[str, Walk]:
    """Return where SUMO has each person at the end of each step."""
    rows: dict[str, list[tuple[float, float, float]]] = defaultdict(list)
    for _, element in ET.iterparse(fcd):
        if element.tag == "timestep":
            time = float(element.get("time", "nan"))
            for person in element.iter("person"):
                x, y = float(person.get("x", "nan")), float(person.get("y", "nan"))
                rows[person.get("id", "")].append((time, x, y))
            element.clear()
    return {name: walk_of(some) for name, some in rows.items()}


def told_by_us(trajectories: Path) -> dict[str, Walk]:
    """Return where the run had each person whom it held."""
    rows: dict[str, list[tuple[float, float, float]]] = defaultdict(list)
    with trajectories.open() as stream:
        for row in csv.DictReader(stream):
            rows[row["id"]].append((float(row["time"]), float(row["x"]), float(row["y"])))
    return {name: walk_of(some) for name, some in rows.items()}


def walk_of(rows: list[tuple[float, float, float]]) -> Walk:
    """Return rows of time, x and y as arrays."""
    array = np.array(rows)
    return Walk(array[:, 0], array[:, 1:])


def jumps(held: Walk, told: Walk, step: float) -> list[tuple[float, float]]:
    """Time [s] and length [m] beyond a walk of each hand-back of one person.

    SUMO's output names a step by its beginning; the run by the instant.
    """
    found = []
    gaps = np.flatnonzero(np.diff(held.times) > step + 1e-6)
    for last in held.times[np.append(gaps, len(held.times) - 1)]:
        rows = np.flatnonzero((told.times > last - 1.5 * step) & (told.times < last + 2.5 * step))
        if len(rows) > 1 and told.times[rows[-1]] > last + 0.5 * step:
            way = np.hypot(*np.diff(told.places[rows], axis=0).T)
            beyond = way - WALK * np.diff(told.times[rows])
            found.append((float(last), max(float(beyond.max()), 0.0)))
    return found


def longest_outside(held: Walk, zone: shapely.Geometry) -> float:
    """Return the longest time [s] for which a person is held outside of the zone."""
    outside = ~shapely.contains_xy(zone, held.places[:, 0], held.places[:, 1])
    longest = began = 0.0
    before = -np.inf
    for time, out in zip(held.times, outside, strict=True):
        if not out or time - before > 1.5:
            began = time
        longest, before = max(longest, time - began), time
    return longest


def measure(scenario: Path, seed: int, limit: float, work: Path) -> dict[str, object]:
    """Make one drive, and return its row."""
    drive = f"{scenario.parent.name}/{scenario.name} {seed}"
    net = next(scenario.parent / name for name in net_names(scenario))
    zone = comb(WalkNetwork.read(net).boundary, seed)
    command = [sys.executable, "-m", "giveway", "run", scenario, "--no-ego", f"--zone={zone}"]
    command += ["--seed", seed, "--time-limit", limit, "--sumo-outputs", "fcd", "--no-pictures"]
    shutil.rmtree(work, ignore_errors=True)
    done = subprocess.run([*map(str, command), "--out", work], capture_output=True, text=True)
    if done.returncode:
        return {"drive": drive, "said": " ".join(done.stderr.split())[-300:]}
    manifest = json.loads((work / "manifest.json").read_text())
    told = told_by_sumo(work / "sumo" / "fcd.xml")
    rows = told_by_us(work / "trajectories.csv")  # of vehicles, too
    held = {name: rows[name] for name in rows.keys() & told.keys()}
    step = float(np.median(np.concatenate([np.diff(w.times) for w in told.values()] or [[1.0]])))
    found = [
        (length, time, name)
        for name, walk in held.items()
        for time, length in jumps(walk, told[name], step)
    ]
    outer = polygon(zone).buffer(MARGIN)
    outside = [longest_outside(walk, outer) for walk in held.values()]
    largest = max(found, default=(0.0, 0.0, ""))
    return {
        "drive": drive,
        **{key: manifest["pedestrians"][key] for key in COUNTS},
        "over_1m": sum(length > 1.0 for length, *_ in found),
        "over_2m": sum(length > 2.0 for length, *_ in found),
        "largest": f"{largest[0]:.2f}",
        "late": sum(time > HELD for time in outside),
        "stuck": sum(time > STUCK for time in outside),
        "said": f"{largest[2]} at {largest[1]:.2f} s" if found else "",
    }


def polygon(zone: str) -> shapely.Polygon:
    """Return the polygon of a zone's text."""
    return shapely.Polygon([tuple(map(float, point.split(","))) for point in zone.split()])


def net_names(scenario: Path) -> list[str]:
    """Return the names of the network in a configuration of SUMO."""
    return [e.get("value", "") for e in ET.parse(scenario).iter() if e.tag in {"net-file", "net"}]


def main() -> None:
    """Make the drives that are missing, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenarios", type=Path, nargs="*", metavar="SCENARIO")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--seeds", default="1-10", help="first and last one, like 1-10")
    parser.add_argument("--limit", type=float, default=200.0, help="length of a drive [s]")
    chosen = parser.parse_args()
    chosen.out.mkdir(parents=True, exist_ok=True)
    file = chosen.out / "hand_backs.csv"
    rows = list(csv.DictReader(file.open())) if file.exists() else []
    first, _, last = chosen.seeds.partition("-")
    for seed in range(int(first), int(last or first) + 1):
        for scenario in chosen.scenarios:
            drive = f"{scenario.parent.name}/{scenario.name} {seed}"
            if any(row["drive"] == drive for row in rows):
                continue
            row = measure(scenario.resolve(), seed, chosen.limit, chosen.out / "work")
            rows.append({key: str(row.get(key, "")) for key in FIELDS})
            with file.open("w", newline="") as stream:
                writer = csv.DictWriter(stream, FIELDS)
                writer.writeheader()
                writer.writerows(rows)
            print(*rows[-1].values(), sep="; ", flush=True)
    total = {
        key: sum(int(row[key] or 0) for row in rows) for key in FIELDS[1:11] if key != "largest"
    }
    for key, number in total.items():
        print(f"{key:12} {number}")
    print("largest     ", max((float(row["largest"] or 0.0) for row in rows), default=0.0), "m")


if __name__ == "__main__":
    main()
