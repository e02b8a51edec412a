"""Coverage of subset simulation in a closed loop: brute force once, then many estimates.

    python benchmarks/risk/closed_loop.py --out FOLDER --reference 200000 --repeats 50

Everything can be ended and resumed. Each estimate is a folder of ``giveway risk``.
"""

import argparse
from pathlib import Path
from typing import Any

from giveway.risk.definition import make_risk
from giveway.risk.estimators import Estimate
from giveway.risk.session import run_risk
from giveway.studies.study_options import StudyOptions

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
    wanted = parser.parse_args()
    reference = _estimate(
        wanted.out / "reference", "monte-carlo", wanted.reference, 0, wanted.workers
    )
    print(f"reference: {_told(reference)}")
    covered = 0
    for seed in range(1, wanted.repeats + 1):
        one = _estimate(
            wanted.out / f"subset-{seed}", "subset", wanted.budget, seed, wanted.workers
        )
        covered += one.low <= reference.probability <= one.high
        print(f"{seed}: {_told(one)}; {covered} of {seed} cover", flush=True)


def _estimate(out: Path, method: str, runs: int, seed: int, workers: int | None) -> Estimate:
    values = {"name": out.name, "method": method, "runs": runs, "seed": seed, "run": SETTING}
    options = StudyOptions(jobs=workers, resume=True)
    return run_risk(make_risk(values, out.name), out.name, out, options).estimate


def _told(one: Estimate) -> str:
    doubt = f" (doubts: {'; '.join(one.doubts)})" if one.doubts else ""
    return f"{one.probability:.3g} [{one.low:.3g}, {one.high:.3g}] by {one.runs:,} runs{doubt}"


if __name__ == "__main__":
    main()
