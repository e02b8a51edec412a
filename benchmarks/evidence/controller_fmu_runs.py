"""Our exported controller, driven as a controller FMU, against the controller that it is.

Run: python benchmarks/evidence/controller_fmu_runs.py --runs 20

Each seed of shared_space is driven twice: by ``--controller mpc-paper``, and by its export as a
controller FMU with the same safety layer, priority and perception (none of the three), people and
prediction (SIM).
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np

import giveway
from fmus import ControllerParameters, export_controller

LIKE_THE_PAPER = {
    "safety.enabled": False,
    "rules": {"crossings": False, "right_of_way": False, "merging": False},
    "perception.tracker": False,
    "crowd.preset": "SIM",
    "perception.preset": "SIM",
}
MOTION = ("time", "position", "front_x", "front_y", "heading", "speed", "acceleration")
DIGITS = 6  # of ego.csv


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--fmi", choices=("2.0", "3.0"), default="2.0")
    options = parser.parse_args()
    decisions, by_pid, exact, same_digits, apart = 0, 0, 0, 0, 0.0
    with tempfile.TemporaryDirectory() as folder:
        fmu = export_controller(
            Path(folder, "mpc.fmu"), ControllerParameters(), fmi_version=options.fmi
        )
        for seed in range(1, options.runs + 1):
            run = {"scenario": "shared_space", "seed": seed}
            ours = giveway.run({**run, "controller": "mpc-paper"}).egos[0].track
            theirs = giveway.run({**run, "controller": str(fmu), **LIKE_THE_PAPER}).egos[0].track
            pairs = [(getattr(ours, name), getattr(theirs, name)) for name in MOTION]
            decisions += len(ours.time)
            by_pid += int(np.sum(ours.controller == "pid"))
            exact += all(np.array_equal(a, b) for a, b in pairs)
            same_digits += all(
                len(a) == len(b) and np.array_equal(np.round(a, DIGITS), np.round(b, DIGITS))
                for a, b in pairs
            )
            steps = min(len(ours.time), len(theirs.time))
            apart = max(apart, np.abs(ours.force[:steps] - theirs.force[:steps]).max())
    print(f"{options.runs} runs, {decisions} decisions, {by_pid} of them the PID's")
    print(f"motion bit by bit the same in {exact} runs, to {DIGITS} digits in {same_digits}")
    print(f"forces differ by at most {apart:.2g} N")


if __name__ == "__main__":
    main()
