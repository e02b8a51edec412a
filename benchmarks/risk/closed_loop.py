"""Coverage of subset simulation in a closed loop: brute force once, then many estimates.

    python benchmarks/risk/closed_loop.py --out FOLDER --reference 200000 --repeats 50
    python benchmarks/risk/closed_loop.py --out FOLDER --keep FILE.csv    # makes nothing

Everything can be ended and resumed. Each estimate is a folder of ``giveway risk``. The kept table
has a row for each of them, the reference first.
"""

import argparse
import csv
from pathlib import Path
from typing import Any

from giveway.risk.definition import make_risk
from giveway.risk.estimators import Estimate
from giveway.risk.session import run_risk
from giveway.studies.study_options import StudyOptions

KEPT = ("method", "runs", "events", "probability", "low", "high", "doubts")
REFERENCE = "reference"
# A person may step before a car that is too fast for its controller: a contact in about 1e-3 runs
SETTING: dict[str, Any] = {
    "time_limit": 2.5,
    "controller": "pid-paper",
    "ego": {"initial_speed": 6.0},
    "crowd": {"pedestrians": 3, "spawn_area": [4, -6, 16, -1.5], "walk": [0, 10]},
}


def main() -> None:
    """Make what is missing, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--reference", type=int, default=200_000)
    parser.add_argument("--repeats", type=int, default=50)
    parser.add_argument("--budget", type=int, default=6_000)
    parser.add_argument("--workers", type=int, default=None)
    parser.add_argument("--keep", type=Path, help="CSV file for what is there already")
    wanted = parser.parse_args()
    if wanted.keep is not None:
        keep(wanted.out, wanted.keep)
        return
    reference = _estimate(
        wanted.out / REFERENCE, "monte-carlo", wanted.reference, 0, wanted.workers
    )
    print(f"reference: {_told(reference)}")
    covered = 0
    for seed in range(1, wanted.repeats + 1):
        one = _estimate(
            wanted.out / f"subset-{seed}", "subset", wanted.budget, seed, wanted.workers
        )
        covered += one.low <= reference.probability <= one.high
        print(f"{seed}: {_told(one)}; {covered} of {seed} cover", flush=True)


def keep(out: Path, file: Path) -> None:
    """Write a row for each finished estimate in a folder, the reference first."""
    found = sorted(out.glob("*/risk.csv"), key=lambda path: (len(path.parent.name), path))
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, ("name", *KEPT), "", "ignore", lineterminator="\n")
        writer.writeheader()
        for path in sorted(found, key=lambda path: path.parent.name != REFERENCE):
            with path.open(newline="", encoding="utf-8") as table:
                writer.writerow({"name": path.parent.name, **next(csv.DictReader(table))})


def _estimate(out: Path, method: str, runs: int, seed: int, workers: int | None) -> Estimate:
    values = {"name": out.name, "method": method, "runs": runs, "seed": seed, "run": SETTING}
    options = StudyOptions(jobs=workers, resume=True)
    return run_risk(make_risk(values, out.name), out.name, out, options).estimate


def _told(one: Estimate) -> str:
    doubt = f" (doubts: {'; '.join(one.doubts)})" if one.doubts else ""
    return f"{one.probability:.3g} [{one.low:.3g}, {one.high:.3g}] by {one.runs:,} runs{doubt}"


if __name__ == "__main__":
    main()
