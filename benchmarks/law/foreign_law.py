"""Does an ego keep to the law of the road in a scenario that is not ours? Some of its cars tell.

    python benchmarks/law/foreign_law.py SCENARIO.sumocfg --drives 20 --seed 1 --out F [--jobs 2]

SUMO runs the scenario once with its own cars; from those that depart in the first ``--window``
seconds the seed draws as many as there are drives; where there are fewer, all of them drive again
with the next seed. Each is taken over as the ego in a drive of its own, over its whole way or for
180 s, as fast as its lanes allow, with everything else as giveway has it by default. A scenario
without cars needs routes instead, ``--route EDGE,EDGE`` (more than once, if you like), on which an
ego is inserted at a time that the seed draws.

One line of ``FOLDER/drives.jsonl`` per drive; what is done is not done again, so the campaign can
be ended at any time, and another state of the repository needs another folder. The end prints the
ledger (docs/law.md) over all drives, then each violation with the words that the ledger has for it.
"""

from __future__ import annotations

import argparse
import json
import random
import tempfile
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import giveway
from giveway.scenario_files import StartOptions, prepare_start, read_scenario
from giveway.sumo.library import import_libsumo
from giveway.sumo.types import ROAD_CLASSES

LIMIT = 180.0  # [s] of each drive
CARS = frozenset(ROAD_CLASSES) - {"bus", "coach", "tram", "bicycle", "emergency"}
INSERTED = (30.0, 150.0)  # [s] between which an ego is inserted
COUNTS = (
    "encounters",
    "failures_to_yield",
    "red_lights_run",
    "blocked_crossings",
    "blocked_junctions",
    "stops_without_cause",
    "vehicle_contacts",
    "frontal_contacts",
    "hard_brakes",
    "hard_brakes_without_cause",
)
HEADER = "| drives | arrived | " + " | ".join(name.replace("_", " ") for name in COUNTS) + " |"


def cars(scenario: Path, window: float, seed: int) -> list[str]:
    """The cars that depart within ``window`` [s] of the scenario's beginning, in their order."""
    sumo, found = import_libsumo(), list[str]()
    with tempfile.TemporaryDirectory(prefix="giveway-") as scratch:
        quiet = StartOptions(seed=seed, extra=("--no-warnings", "true"))
        start = prepare_start(read_scenario(scenario), quiet, Path(scratch))
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


def drive(scenario: Path, ego: str, seed: int) -> dict[str, Any]:
    """Take one of the scenario's cars over, or insert one on a route; what the ledger says."""
    depart = random.Random(seed).uniform(*INSERTED)
    inserted = {"route": ego.split(","), "depart_time": depart}
    settings = {
        "scenario": str(scenario),
        "ego": inserted if "," in ego else {"take_over": [ego]},
        "sumo": {"seed": seed},
        "seed": seed,
        "time_limit": LIMIT,
    }
    try:
        result = giveway.run(settings)
    except Exception as error:  # no drive ends the campaign
        told = "" if isinstance(error, giveway.GivewayError) else f"{type(error).__name__}: "
        return {"ego": ego, "seed": seed, "failed": f"{told}{error}"}
    summary, events = result.summary, result.ledger
    violations = events[events.violation.astype(bool)] if len(events) else events
    return {
        "ego": ego,
        "seed": seed,
        "ending": str(result.ending.value),
        "completed": bool(summary["completed"]),
        **{name: int(summary.get(name) or 0) for name in COUNTS},
        "violations": [
            f"{row.time:.2f} s, {row.kind}, {row.other or row.place}: {row.words}"
            for row in violations.itertuples()
        ],
    }


def table(made: list[dict[str, Any]]) -> str:
    """The ledger of all drives, and each violation."""
    sound = [one for one in made if "failed" not in one]
    sums = " | ".join(str(sum(one[name] for one in sound)) for name in COUNTS)
    arrived = sum(one["completed"] for one in sound)
    rows = [HEADER, "|---" * (2 + len(COUNTS)) + "|", f"| {len(sound)} | {arrived} | {sums} |"]
    for one in made:
        words = [one["failed"]] if "failed" in one else list(one["violations"])
        if not one.get("completed", True):
            words.append(f"not arrived ({one['ending']})")
        rows += [f"{one['ego']}, seed {one['seed']}: {each}" for each in words]
    return "\n".join(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario", type=Path, help="the .sumocfg")
    parser.add_argument("--drives", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1, help="draws the cars, and is SUMO's")
    parser.add_argument("--window", type=float, default=600.0, help="[s] in which they depart")
    parser.add_argument("--out", type=Path, required=True, help="folder of the results")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--route", action="append", default=[], help="edges of an inserted ego")
    options = parser.parse_args()
    scenario = options.scenario.absolute()
    found = options.route or cars_of(scenario, options.window, options.seed)
    if not found:
        parser.error(
            f"{scenario}: no car departs within {options.window:g} s; see --window, --route"
        )
    drawn = draw(found, options.drives, options.seed)
    print(table(drive_all(scenario, drawn, options.out, options.jobs)))


def cars_of(scenario: Path, window: float, seed: int) -> list[str]:
    """:func:`cars`, in a process of its own: SUMO may take it down."""
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        return pool.submit(cars, scenario, window, seed).result()


def drive_all(
    scenario: Path, drawn: list[tuple[str, int]], out: Path, jobs: int
) -> list[dict[str, Any]]:
    """Make the drives that are not in the folder ``out`` yet, and read all of them."""
    out.mkdir(parents=True, exist_ok=True)
    results = out / "drives.jsonl"
    known = _read(results)
    with (
        ProcessPoolExecutor(jobs, get_context("spawn")) as pool,
        results.open("a", encoding="utf-8") as file,
    ):
        left = [one for one in drawn if one not in known]
        waiting = [pool.submit(drive, scenario, *one) for one in left]
        for done in as_completed(waiting):
            file.write(json.dumps(done.result()) + "\n")
            file.flush()
    known = _read(results)
    return [known[one] for one in drawn]


def draw(found: list[str], drives: int, seed: int) -> list[tuple[str, int]]:
    """Cars and SUMO's seeds of so many drives."""
    draws, drawn = random.Random(seed), list[tuple[str, int]]()
    while len(drawn) < drives:
        some = draws.sample(found, min(drives - len(drawn), len(found)))
        drawn += [(ego, seed) for ego in some]
        seed += 1
    return drawn


def _read(results: Path) -> dict[tuple[str, int], dict[str, Any]]:
    if not results.exists():
        return {}
    lines = results.read_text(encoding="utf-8").splitlines()
    return {(made["ego"], made["seed"]): made for made in map(json.loads, lines)}


if __name__ == "__main__":
    main()
