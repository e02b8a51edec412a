"""Drives that know less of the people than they do in the benchmark, or among other people.

Run: python benchmarks/bounds/robustness.py --out FOLDER [--controller mpc] [--runs 24] [--jobs 1]

Three scenes of ``giveway benchmark``, with the same people in each row for a seed (MIXED, or the
model that the row names). The sensor ``Misses`` is a plug-in: each person is unseen for half a
second now and then. The seeds begin at 801; no controller was tuned on them. The drives are a study
in FOLDER, which can be ended and resumed.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from giveway.ego.perception import Ids, OwnState, Percept, SensorSetup, Truth
from giveway.studies.definition import make_definition
from giveway.studies.study import run_study
from giveway.studies.study_options import StudyOptions

SCENES: dict[str, dict[str, Any]] = {
    "one-sided, 30": {"scenario": "shared_space", "crowd": {"pedestrians": 30}},
    "two-sided, 60": {"scenario": "shared_space", "crowd": {"pedestrians": 60, "two_sided": True}},
    "encounter, medium": {"scenario": "encounter", "crowd": {"pedestrians": 24}},
}
WORLDS: dict[str, dict[str, Any]] = {
    "as in the benchmark": {},
    "positions, noise of 0.3 m": {"perception": {"position_noise": 0.3}},
    "each person unseen for 0.5 s, 1 in 10": {"perception": {"sensor": "robustness:Misses"}},
    "goals unknown": {"perception": {"goals": "heading"}},
    "desired speeds unknown": {"perception": {"desired_speeds": "typical"}},
    "all four": {
        "perception": {
            "position_noise": 0.3,
            "sensor": "robustness:Misses",
            "goals": "heading",
            "desired_speeds": "typical",
        }
    },
    "no safety layer": {"safety": {"enabled": False}},
    "people of SIM": {"crowd": {"preset": "SIM"}},
    "people of DUT": {"crowd": {"preset": "DUT"}},
    "people of orca": {"crowd": {"model": "orca"}},
    "people of social-force": {"crowd": {"model": "social-force"}},
    "people of gap-acceptance": {"crowd": {"model": "gap-acceptance"}},
}
HEADER = (
    "| what differs | drives | people near | close [%] | close per drive | time [s] | "
    "hard brakings | front, side contacts | not arrived |"
)


@dataclass(frozen=True)
class Options:
    """The options of the sensor."""

    share: float = 0.1  # share of the half seconds in which a person is unseen
    lasts: float = 0.5  # time [s] for which a person is unseen


class Misses:
    """A sensor that does not see a person for some time, now and then; all else is exact.

    Args:
        setup: What giveway tells a sensor.
        options: How often, and for how long.
    """

    Options = Options

    def __init__(self, setup: SensorSetup, options: Options) -> None:
        self._options = options
        self._random = setup.random()
        self._draws: dict[tuple[int, int], bool] = {}

    def observe(self, truth: Truth, person_ids: Ids, ego: OwnState) -> Percept:  # noqa: ARG002
        """Return the people who are seen."""
        window = int(truth.time / self._options.lasts)
        seen = np.array([not self._missed(int(n), window) for n in person_ids], bool)
        return Percept(truth.people.select(seen), person_ids[seen])

    def _missed(self, number: int, window: int) -> bool:
        key = number, window
        if key not in self._draws:
            self._draws[key] = self._random.random() < self._options.share
        return self._draws[key]


def main() -> None:
    """Make the drives, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--controller", default="mpc")
    parser.add_argument("--runs", type=int, default=24, help="seeds of each scene")
    parser.add_argument("--jobs", type=int, default=1)
    chosen = parser.parse_args()
    definition = make_definition(
        {
            "name": "robustness",
            "replications": chosen.runs,
            "first_seed": 801,
            "table": "levels",
            "run": {"controller": chosen.controller},
            "factors": {"scene": SCENES, "world": WORLDS},
            "comparison": {"factor": "world"},
        },
        "robustness.py",
    )
    options = StudyOptions(jobs=chosen.jobs, resume=(chosen.out / "manifest.json").exists())
    study = run_study(definition, "robustness.py", chosen.out, options)
    print(HEADER, "|---" * 9 + "|", sep="\n")
    for world in WORLDS:
        drives = study.runs[study.runs["world"] == world]
        known = drives[drives["close_passes"].notna()]
        close, near = known["close_passes"].sum(), known["people_near"].sum()
        time = known["completion_time"].fillna(known["simulated_time"]).mean()
        print(
            f"| {world} | {len(known)} of {len(drives)} | {near:.0f} | {100 * close / near:.1f} | "
            f"{close / len(known):.2f} | {time:.1f} | {known['hard_brakes'].sum():.0f} | "
            f"{known['frontal_contacts'].sum():.0f}, {known['side_contacts'].sum():.0f} | "
            f"{(~known['completed'].astype(bool)).sum()} |"
        )


if __name__ == "__main__":
    main()
