"""Coverage of subset simulation in a closed loop: brute force once, then many estimates.

    python benchmarks/risk/closed_loop.py --out FOLDER --reference 200000 --repeats 50
    python benchmarks/risk/closed_loop.py --out FOLDER --keep FILE.csv    # makes nothing

Everything can be ended and resumed. Each estimate is a folder of ``giveway risk``; the reference
has one for every 10,000 runs. The kept table has a row for each estimate, after that of all runs of
the reference together.
"""

import argparse
import csv
from pathlib import Path
from typing import Any

from giveway.risk.definition import make_risk
from giveway.risk.estimators import Estimate, clopper_pearson
from giveway.risk.session import run_risk
from giveway.studies.study_options import StudyOptions

KEPT = ("method", "runs", "events", "probability", "low", "high", "doubts")
REFERENCE = "reference"
PART = 10_000  # Runs of the reference in one folder
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
    parts = range(1, wanted.reference // PART + 1)
    for seed in parts:
        _estimate(wanted.out / f"{REFERENCE}-{seed}", "monte-carlo", PART, seed, wanted.workers)
    reference = _reference(_rows(wanted.out))
    print(f"reference: {reference}")
    covered = 0
    for seed in range(1, wanted.repeats + 1):
        one = _estimate(
            wanted.out / f"subset-{seed}", "subset", wanted.budget, seed, wanted.workers
        )
        covered += one.low <= reference["probability"] <= one.high
        print(f"{seed}: {_told(one)}; {covered} of {seed} cover", flush=True)


def keep(out: Path, file: Path) -> None:
    """Write a row for the reference and each finished estimate in a folder."""
    rows = _rows(out)
    estimates = [row for row in rows if not row["name"].startswith(REFERENCE)]
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, ("name", *KEPT), "", "ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows([_reference(rows), *estimates])


def _rows(out: Path) -> list[dict[str, Any]]:
    """Return the row of each finished folder, in the order of their numbers."""
    rows = []
    for path in sorted(out.glob("*/risk.csv"), key=lambda path: (len(path.parent.name), path)):
        with path.open(newline="", encoding="utf-8") as table:
            rows.append({"name": path.parent.name, **next(csv.DictReader(table))})
    return rows


def _reference(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the row of the reference: the runs of all its parts together."""
    parts = [row for row in rows if row["name"].startswith(REFERENCE)]
    runs, events = (sum(int(part[name]) for part in parts) for name in ("runs", "events"))
    low, high = clopper_pearson(events, runs)
    return {
        "name": REFERENCE,
        "method": "monte-carlo",
        "runs": runs,
        "events": events,
        "probability": events / runs,
        "low": low,
        "high": high,
    }


def _estimate(out: Path, method: str, runs: int, seed: int, workers: int | None) -> Estimate:
    values = {"name": out.name, "method": method, "runs": runs, "seed": seed, "run": SETTING}
    options = StudyOptions(jobs=workers, resume=True)
    return run_risk(make_risk(values, out.name), out.name, out, options).estimate


def _told(one: Estimate) -> str:
    doubt = f" (doubts: {'; '.join(one.doubts)})" if one.doubts else ""
    return f"{one.probability:.3g} [{one.low:.3g}, {one.high:.3g}] by {one.runs:,} runs{doubt}"


if __name__ == "__main__":
    main()
