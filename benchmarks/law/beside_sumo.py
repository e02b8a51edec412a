"""Compares people and cars of a run with plain SUMO's on the same input, from SUMO's own outputs.

Run: python benchmarks/law/beside_sumo.py SCENARIO [--seeds 1-10] [--set crowd.zone=everywhere]
         [--set ego.none=true] [--set crowd.model=social-force]

The columns are the mean standing time [s] of people and of cars, the mean travel time [s] and the
number of those who arrived, each beside plain SUMO's. Who moves less than 0.2 m in a second stands.
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
import tomllib
import xml.etree.ElementTree as ET
from collections import defaultdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import sumo

import giveway
from sumo_scenarios import find

STANDING = 0.2  # speed [m/s] below which somebody or something stands
LEAST = 1.0, 1.5  # a mean may differ by this time [s] or by this factor, whichever is larger


class Figures(NamedTuple):
    """The figures of people or cars in one run."""

    number: int
    standing: float  # mean standing time [s]
    arrived: int
    travel: float  # mean travel time [s] of those who arrived


def figures(folder: Path) -> dict[str, Figures]:
    """The figures of people and cars from the files ``fcd.xml`` and ``tripinfo.xml``."""
    places: dict[str, dict[str, list[tuple[float, float]]]] = defaultdict(lambda: defaultdict(list))
    times: list[float] = []
    for _, element in ET.iterparse(folder / "fcd.xml"):
        if element.tag == "timestep":
            times.append(float(element.get("time", 0.0)))
            for one in element:
                place = float(one.get("x", 0.0)), float(one.get("y", 0.0))
                places[one.tag][one.get("id", "")].append(place)
            element.clear()
    step = float(np.median(np.diff(times)))
    trips = ET.parse(folder / "tripinfo.xml").getroot()
    found = {}
    for tag, trip in (("person", "personinfo"), ("vehicle", "tripinfo")):
        travels = [float(one.get("duration", 0.0)) for one in trips.iter(trip)]
        stands = [standing(np.array(track), step) for track in places[tag].values()]
        mean = float(np.mean(travels)) if travels else 0.0
        found[tag] = Figures(len(stands), float(np.mean(stands or [0.0])), len(travels), mean)
    return found


def standing(track: np.ndarray, step: float) -> float:
    """The time [s] for which somebody stands, from places (n, 2) [m] at each ``step`` [s]."""
    lag = max(1, round(1.0 / step))
    moved = np.hypot(*(track[lag:] - track[:-lag]).T)
    return float(step * np.count_nonzero(moved < STANDING * lag * step))


def plain(config_file: Path, seed: int, folder: Path) -> dict[str, Figures]:
    """The figures of plain SUMO."""
    folder.mkdir()
    command = [Path(sumo.SUMO_HOME) / "bin" / "sumo", "-c", config_file, "--seed", seed]
    command += ["--random", "false", "--fcd-output", folder / "fcd.xml", "--no-warnings"]
    command += ["--tripinfo-output", folder / "tripinfo.xml", "--no-step-log"]
    subprocess.run(list(map(str, command)), check=True, capture_output=True)
    return figures(folder)


def ours(scenario: str, seed: int, folder: Path, settings: dict[str, Any]) -> dict[str, Figures]:
    """The figures of a run by giveway."""
    sumo_ = {"outputs": ["fcd", "tripinfo"], "baseline": False, "seed": seed}
    config = {"scenario": scenario, "sumo": sumo_, "seed": seed} | settings
    giveway.run(config, results=folder, pictures=False)
    return figures(folder / "sumo")


def compare(scenario: str, seed: int, settings: dict[str, Any]) -> list[dict[str, Figures]]:
    """The figures of plain SUMO and of giveway."""
    with tempfile.TemporaryDirectory() as folder:
        alone = plain(find(scenario).config_file, seed, Path(folder) / "plain")
        return [alone, ours(scenario, seed, Path(folder) / "ours", settings)]


def is_near(mean: float, alone: float) -> bool:
    """Whether a mean time [s] is as plain SUMO's, within the bar."""
    time, factor = LEAST
    return abs(mean - alone) <= time or alone / factor <= mean <= alone * factor


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario")
    parser.add_argument("--seeds", default="1-10")
    parser.add_argument("--set", action="append", default=[], help="option, as crowd.zone=none")
    chosen = parser.parse_args()
    settings: dict[str, Any] = {}
    for text in chosen.set:
        key, _, value = text.partition("=")
        table, _, name = key.rpartition(".")
        try:
            parsed = tomllib.loads(f"value = {value}")["value"]
        except tomllib.TOMLDecodeError:
            parsed = value
        (settings.setdefault(table, {}) if table else settings)[name] = parsed
    first, _, last = chosen.seeds.partition("-")
    pairs = []
    print("seed  who      number  standing      arrived      travel")
    for seed in range(int(first), int(last or first) + 1):
        pairs.append(compare(chosen.scenario, seed, settings))
        show(str(seed), pairs[-1:])
    show("all", pairs)


def show(seed: str, pairs: list[list[dict[str, Figures]]]) -> None:
    """Print the means over some pairs of runs; an exclamation mark misses the bar."""
    for tag in ("person", "vehicle"):
        alone, own = (np.mean([pair[k][tag] for pair in pairs], axis=0) for k in (0, 1))
        mark = " " if is_near(own[1], alone[1]) else "!"
        few = " " if abs(own[2] - alone[2]) <= 0.1 * alone[2] else "!"
        print(
            f"{seed:4}  {tag:8} {own[0]:6.0f}  {own[1]:5.1f} /{alone[1]:5.1f}{mark} "
            f"{own[2]:5.0f} /{alone[2]:5.0f}{few} {own[3]:6.1f} /{alone[3]:6.1f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
