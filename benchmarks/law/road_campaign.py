"""Does an ego drive as a good driver does, on any roads? Drives beside plain SUMO's tell.

    python benchmarks/law/road_campaign.py SCENARIO... --drives 10 --out FOLDER [--jobs 2]
    python benchmarks/law/road_campaign.py --drawn 1-12 --drives 4 --out FOLDER
    python benchmarks/law/road_campaign.py --roads 1-3 --out FOLDER

A scenario is a .sumocfg, or a folder with one or with folders that have one. ``--drawn`` adds
networks that netgenerate draws from seeds (``drawn_networks.py``), ``--roads`` small networks on
which roads meet in dense traffic (``roads.py``). SUMO runs a scenario once with its own cars; the
seed draws from those that depart in the first ``--window`` seconds. Each is taken over as the ego
in a drive of its own, as fast as its lanes allow, with everything else as giveway has it by
default. ``--route EDGE,EDGE`` inserts egos instead, at times that the seed draws.

One line of ``FOLDER/drives.jsonl`` per drive; a drive that is done is not done again. Therefore a
campaign can be ended at any time, and another state of the repository needs another folder. Each
drive is a process of its own: one that dies has a row with the cause. The end prints all drives,
each violation, and the pooled numbers with 95 % intervals beside the bars of a good driver.
``--table`` prints that without driving, and ``--beside FOLDER`` the values of the same drives in
another state of the repository, with the ratio of the times of pairs. Drawn
networks need netgenerate: pip install 'giveway[new]'.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from campaign_table import tables
from drawn_networks import WINDOW, draw_network
from drive_row import row_of
from roads import WAYS, build

import giveway
from giveway.processes.causes import cause_of_end
from giveway.scenario_files import StartOptions, prepare_start, read_scenario
from giveway.sumo.library import import_libsumo
from giveway.sumo.types import ROAD_CLASSES

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

LIMIT = 900.0  # Longest drive [s]
PATIENCE = 900.0  # Wall-clock limit [s] of a drive's process
CARS = frozenset(ROAD_CLASSES) - {"bus", "coach", "tram", "bicycle", "emergency"}
INSERTED = (30.0, 150.0)  # Times [s] between which an ego is inserted
CONFIGURATIONS = ("*.sumocfg", "*.sumo.cfg")


@dataclass(frozen=True)
class Drive:
    """One drive of the campaign.

    Attributes:
        scenario: Name of the scenario in the tables.
        config: Path of its .sumocfg.
        ego: Car that is taken over, or edges of an inserted ego, comma-separated.
        seed: Seed of SUMO and of the people.
        controller: Controller of the ego.
        lane: Index of the departure lane of an inserted ego.
    """

    scenario: str
    config: str
    ego: str
    seed: int
    controller: str
    lane: int | None = None

    @property
    def name(self) -> str:
        """The name by which its row is kept."""
        lane = "" if self.lane is None else f" lane {self.lane}"
        return f"{self.scenario}, {self.ego}{lane}, seed {self.seed}, {self.controller}"

    @property
    def settings(self) -> dict[str, Any]:
        """The configuration of the run."""
        depart = random.Random(self.seed).uniform(*INSERTED)
        inserted = {"route": self.ego.split(","), "depart_time": depart, "lane": self.lane}
        return {
            "scenario": self.config,
            "controller": self.controller,
            "ego": inserted if "," in self.ego else {"take_over": [self.ego]},
            "regulation": {"reference_speed": "lane"},
            "sumo": {"seed": self.seed},
            "seed": self.seed,
            "time_limit": LIMIT,
        }


def drive(one: Drive) -> dict[str, Any]:
    """Make a drive in this process, and return its row."""
    try:
        return row_of(giveway.run(one.settings))
    except Exception as error:  # no drive ends the campaign
        told = "" if isinstance(error, giveway.GivewayError) else f"{type(error).__name__}: "
        return {"failed": f"{told}{error}"}


def in_a_process(task: str, argument: object, patience: float = PATIENCE) -> Any:
    """Return the answer of one of :data:`TASKS` in a process of its own, or how that failed."""
    words = [sys.executable, __file__, "--task", task, json.dumps(argument)]
    try:
        done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=patience)
    except subprocess.TimeoutExpired:
        return {"failed": f"no end within {patience:g} s"}
    if done.returncode or not done.stdout.strip():
        words = done.stderr.strip().splitlines()[-1:]
        return {"failed": f"{cause_of_end(done.returncode)} {''.join(words)}"}
    return json.loads(done.stdout.splitlines()[-1])


def cars(config: str, window: float, seed: int) -> list[str]:
    """Return the cars that depart within ``window`` [s] of the scenario's beginning, in order."""
    sumo, found = import_libsumo(), list[str]()
    with tempfile.TemporaryDirectory(prefix="giveway-") as scratch:
        quiet = StartOptions(seed=seed, extra=("--no-warnings", "true"))
        start = prepare_start(read_scenario(Path(config)), quiet, Path(scratch))
        sumo.start(list(start.command))
        begin = sumo.simulation.getTime()
        while sumo.simulation.getTime() < begin + window:
            sumo.simulationStep()
            for name in sumo.simulation.getDepartedIDList():
                if sumo.vehicle.getVehicleClass(name) in CARS:
                    found.append(name)
            if sumo.simulation.getMinExpectedNumber() == 0:
                break
        sumo.close()
    return found


TASKS = {
    "drive": lambda fields: drive(Drive(**fields)),
    "cars": lambda arguments: cars(*arguments),
}


def configurations(place: Path) -> list[tuple[str, Path]]:
    """Return the scenarios at a place: name and .sumocfg.

    Args:
        place: A .sumocfg, a folder that has one (the first by name), or a folder of such folders.
    """
    if place.is_file():
        return [(place.stem.removesuffix(".sumo"), place)]
    for pattern in CONFIGURATIONS:
        found = sorted(place.glob(pattern))
        if found:
            return [(place.name, found[0])]
    return [
        pair
        for below in sorted(place.iterdir())
        if below.is_dir()
        for pair in configurations(below)
    ]


def draw(found: Sequence[str], drives: int, seed: int) -> list[tuple[str, int]]:
    """Return cars and SUMO's seeds of so many drives."""
    draws, drawn = random.Random(seed), list[tuple[str, int]]()
    while len(drawn) < drives:
        some = draws.sample(found, min(drives - len(drawn), len(found)))
        drawn += [(ego, seed) for ego in some]
        seed += 1
    return drawn


def planned(options: argparse.Namespace) -> list[Drive]:
    """Return all drives of the campaign; what cannot be planned is said."""
    places = [each for place in options.scenarios for each in configurations(place.absolute())]
    found = [(*place, options.seed, options.window) for place in places]
    for seed in options.drawn:
        config, words = draw_network(options.out / "networks" / str(seed), seed)
        found.append((f"drawn {seed} ({words})", config, seed, WINDOW))
    drives = []
    for name, config, seed, window in found:
        egos = options.route or in_a_process("cars", [str(config), window, seed])
        if not egos or "failed" in egos:
            why = egos["failed"] if egos else f"no car departs within {window:g} s"
            print(f"{name}: left out: {why}", file=sys.stderr)
            continue
        drives += [
            Drive(name, str(config), ego, number, options.controller)
            for ego, number in draw(egos, options.drives, seed)
        ]
    return drives + roads(options)


def roads(options: argparse.Namespace) -> list[Drive]:
    """Return the drives where roads meet: each way with each seed."""
    ways = [way for way in WAYS if options.place in (None, way.place)]
    places = dict.fromkeys(way.place for way in ways if options.roads)
    for place in places:
        if not (options.out / "roads" / place).is_dir():
            build(place, options.out / "roads" / place)
    return [
        Drive(
            way.place,
            str(options.out / "roads" / way.place / "road.sumocfg"),
            ",".join(way.route),
            seed,
            options.controller,
            way.lane,
        )
        for seed in options.roads
        for way in ways
    ]


def drive_all(drives: Iterable[Drive], results: Path, jobs: int) -> None:
    """Make the drives, each in a process of its own; each row is kept as soon as it is there."""
    with ThreadPoolExecutor(jobs) as pool, results.open("a", encoding="utf-8") as file:
        waiting = {pool.submit(in_a_process, "drive", asdict(one)): one for one in drives}
        for done in as_completed(waiting):
            one = waiting[done]
            row = {"drive": one.name, "scenario": one.scenario, **done.result()}
            file.write(json.dumps(row) + "\n")
            file.flush()


def read(results: Path) -> dict[str, dict[str, Any]]:
    """Return the rows that are kept, by the names of their drives."""
    if not results.exists():
        return {}
    lines = results.read_text(encoding="utf-8").splitlines()
    return {row["drive"]: row for row in map(json.loads, lines)}


def numbers(text: str) -> list[int]:
    """Return the numbers of "1-12" or "1,4,7"."""
    found = list[int]()
    for part in text.split(","):
        first, _, last = part.partition("-")
        found += range(int(first), int(last or first) + 1)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenarios", type=Path, nargs="*", help=".sumocfg files or folders")
    parser.add_argument(
        "--drawn", type=numbers, default=[], help="seeds of drawn networks, as 1-12"
    )
    parser.add_argument(
        "--roads", type=numbers, default=[], help="seeds of drives where roads meet"
    )
    parser.add_argument("--place", choices=sorted({way.place for way in WAYS}), help="one of them")
    parser.add_argument("--drives", type=int, default=10, help="in each scenario")
    parser.add_argument("--seed", type=int, default=1, help="draws the cars, and is SUMO's")
    parser.add_argument("--window", type=float, default=600.0, help="[s] in which they depart")
    parser.add_argument("--route", action="append", default=[], help="edges of an inserted ego")
    parser.add_argument("--controller", default="mpc")
    parser.add_argument("--out", type=Path, required=True, help="folder of the results")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--table", action="store_true", help="drive nothing, print all rows")
    parser.add_argument("--beside", type=Path, help="results of another state, to compare with")
    parser.add_argument("--brief", action="store_true", help="print only the pooled numbers")
    options = parser.parse_args()
    options.out = options.out.absolute()
    options.out.mkdir(parents=True, exist_ok=True)
    results = options.out / "drives.jsonl"
    known = read(results)
    if not options.table:
        drives = planned(options)
        if not drives:
            parser.error("nothing to drive: name scenarios, --drawn or --roads")
        drive_all([one for one in drives if one.name not in known], results, options.jobs)
        made = read(results)
        known = {one.name: made[one.name] for one in drives}
    before = read(options.beside / "drives.jsonl") if options.beside else {}
    earlier = [before[name] for name in known if name in before]
    print(tables(list(known.values()), earlier, brief=options.brief))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--task"]:
        answer = TASKS[sys.argv[2]](json.loads(sys.argv[3]))
        print(f"\n{json.dumps(answer)}")
    else:
        main()
