"""How do egos and SUMO's cars get on where roads meet? Many drives in dense traffic tell.

    python benchmarks/law/road_campaign.py --seeds 10 --out FOLDER [--jobs 2]
    python benchmarks/law/road_campaign.py --place zipper --priority none --out ANOTHER_FOLDER

An ego merges (a lane that ends, a zipper, an on-ramp) and crosses five kinds of crossroads
(priority, stop signs, lights, all-way stop, right before left), from the main road and the side
road, to the left, straight on and to the right; half of the drives at 8 m/s at most, half as fast
as the lane allows. SUMO draws the traffic with the seed.

One line of ``FOLDER/drives.jsonl`` per drive; what is done is not done again, so a campaign can be
ended at any time, and another state of the repository needs another folder. The end prints a table:
drives in which the ego touched a vehicle, brakings harder than 4 m/s^2, egos that had not arrived
within two minutes. Needs netconvert: pip install 'giveway[build]'.
"""

from __future__ import annotations

import argparse
import itertools
import json
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from roads import WAYS, Way, build

import giveway
from giveway.config.tables.rules import OF_PRIORITY

if TYPE_CHECKING:
    from collections.abc import Iterable

PLACES = tuple(dict.fromkeys(way.place for way in WAYS))
CONTROLLERS = ("mpc", "pid-tuned")
SLOW = 8.0  # [m/s]
LIMIT = 120.0  # [s] of each drive
HEADER = "| place | controller | drives | with contact | hard brakings | not arrived |"


class Drive(NamedTuple):
    """One drive of the campaign."""

    way: Way
    controller: str
    seed: int

    @property
    def name(self) -> str:
        """What it is kept by."""
        return f"{self.way.place}, {self.way.name}, {self.controller}, {self.seed}"


def drive(one: Drive, config_file: Path, priority: str | None) -> dict[str, Any]:
    """Make a drive; what it came to."""
    regulation: dict[str, Any] = {"reference_speed": SLOW if one.seed % 2 else "lane"}
    rules = {} if priority is None else dict.fromkeys(sorted(OF_PRIORITY), priority == "road")
    settings = {
        "scenario": str(config_file),
        "controller": one.controller,
        "ego": {
            "route": list(one.way.route),
            "lane": one.way.lane,
            "depart_time": 20.0 + 0.7 * one.seed,
            "depart_position": 10.0 + 15.0 * (one.seed % 3),
        },
        "regulation": regulation,
        "rules": rules,
        "crowd": {"zone": "none"},
        "sumo": {"seed": one.seed},
        "time_limit": LIMIT,
    }
    try:
        summary = giveway.run(settings).summary
    except giveway.GivewayError as error:
        return {"drive": one.name, "failed": str(error)}
    kept = ("vehicle_contacts", "hard_brakes", "completed", "completion_time")
    return {"drive": one.name, **{key: summary[key] for key in kept}}


def go_on(drives: Iterable[Drive], options: argparse.Namespace, results: Path) -> None:
    """Make the drives in as many processes as there are jobs, each kept as soon as it is done."""
    places = {one.way.place for one in drives}
    for place in sorted(places):
        if not (options.out / place).is_dir():
            build(place, options.out / place)
    with (
        ProcessPoolExecutor(options.jobs) as pool,
        results.open("a", encoding="utf-8") as file,
    ):
        made = [
            pool.submit(drive, one, options.out / one.way.place / "road.sumocfg", options.priority)
            for one in drives
        ]
        for done in as_completed(made):
            file.write(json.dumps(done.result()) + "\n")
            file.flush()


def table(drives: Iterable[Drive], known: dict[str, dict[str, Any]]) -> str:
    """A row for each place and controller, and one for all."""
    rows = [HEADER, "|---|---|---|---|---|---|"]
    groups: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for one in drives:
        groups.setdefault((one.way.place, one.controller), []).append(known[one.name])
    groups["all", ""] = list(itertools.chain.from_iterable(groups.values()))
    for (place, controller), made in groups.items():
        sound = [one for one in made if "failed" not in one]
        contacts = sum(one["vehicle_contacts"] > 0 for one in sound)
        brakes = sum(one["hard_brakes"] for one in sound)
        late = sum(not one["completed"] for one in sound)
        rows.append(f"| {place} | {controller} | {len(sound)} | {contacts} | {brakes} | {late} |")
        rows += [
            f"{one['drive']}: {one['failed']}" for one in made if "failed" in one and controller
        ]
    return "\n".join(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=10, help="drives on each way")
    parser.add_argument("--out", type=Path, required=True, help="folder of networks and results")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--place", action="append", choices=PLACES, help="some of them; none: all")
    parser.add_argument("--priority", help="road or none: [rules] of priority")
    options = parser.parse_args()
    options.out = options.out.absolute()
    options.out.mkdir(parents=True, exist_ok=True)
    places = options.place or PLACES
    drives = [
        Drive(way, controller, seed)
        for seed in range(1, options.seeds + 1)
        for way in WAYS
        if way.place in places
        for controller in CONTROLLERS
    ]
    results = options.out / "drives.jsonl"
    known = _read(results)
    left = [one for one in drives if one.name not in known]
    if left:
        go_on(left, options, results)
    print(table(drives, _read(results)))


def _read(results: Path) -> dict[str, dict[str, Any]]:
    if not results.exists():
        return {}
    lines = results.read_text(encoding="utf-8").splitlines()
    return {made["drive"]: made for made in map(json.loads, lines)}


if __name__ == "__main__":
    main()
