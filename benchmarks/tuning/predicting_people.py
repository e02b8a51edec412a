"""Compares what the planner predicts people with: the same drives with each predictor, in pairs.

Run: python benchmarks/tuning/predicting_people.py --write drives.json [--people MIXED SIM orca]
         [--goals known heading] [--seeds 901 913] [--predictors 'VCI, MIXED' drift]
         [--weights '' careful 'precaution 40']
     python benchmarks/tuning/predicting_people.py --show drives.json [--against 'VCI, MIXED']

Drives that the file has already are not repeated. A person is passed closely whose smallest
clearance is below 0.5 m while the ego drives faster than 2 m/s; the share is that of the people
who come within 4 m. A drive that has not arrived after 120 s counts with 120 s. The prediction
error is that 2 s ahead, of the people who are predicted. Intervals: 2,000 bootstrap samples of the
seeds, which all predictors of a cell share. "all" resamples a seed's drives in all scenes together.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pedestrian_model import PLAIN_MODELS

SCENES: dict[str, dict[str, Any]] = {
    "one-sided, 30": {"crowd": {"pedestrians": 30}},
    "two-sided, 60": {"crowd": {"pedestrians": 60, "two_sided": True}},
    "encounter, 24": {"scenario": "encounter", "crowd": {"pedestrians": 24}},
    "stream, 30": {
        "crowd": {
            "pedestrians": 30,
            "spawn_area": [23.3, -72.0, 33.2, -6.0],
            "walk": [0.0, 100.0],
        }
    },
}
PREDICTORS: dict[str, dict[str, str]] = {
    **{f"VCI, {preset}": {"preset": preset} for preset in ("MIXED", "SIM", "TABLE2")},
    "constant velocity": {"model": "constant-velocity"},
    "drift": {"model": "drift"},
}
WEIGHTS: dict[str, dict[str, Any]] = {
    "": {},
    "careful": {"style": "careful"},
    "assertive": {"style": "assertive"},
    "precaution 40": {"precaution_weight": 40.0},
}
"""Options of the planner: its default, the other styles, and a heavy weight of precaution."""
# Columns of the table: number of a drive, its mean, sum or largest over the drives, decimals
SHOWN: dict[str, tuple[str, Callable[[list[float]], float], int]] = {
    "time [s]": ("time", np.mean, 1),
    "people's delay [s]": ("delay", np.mean, 1),
    "RMS jerk [m/s³]": ("jerk", np.mean, 2),
    "hardest braking [m/s²]": ("braking", np.max, 1),
    "touched": ("touched", np.sum, 0),
    "frontal": ("frontal", np.sum, 0),
    "error at 2 s [m]": ("error", np.nanmean, 2),
}
COMPARED = {"close": 1e2, "time": 1.0, "delay": 1.0, "jerk": 1.0}
"""Numbers that are compared in pairs, with the factor of their unit in the table."""
_LIMIT = 120.0  # Time [s] after which a drive ends
_NEAR, _CLOSE, _FAST = 4.0, 0.5, 2.0  # Clearances [m], speed [m/s] of a close pass
_AHEAD = 2.0  # Look-ahead [s] of the prediction error
_RESAMPLES = 2000
Drive = dict[str, float]
Place = tuple[str, str]  # Scene and seed
Array = NDArray[np.float64]


def error_ahead(predictions: pd.DataFrame, trajectories: pd.DataFrame) -> float:
    """Return the mean distance [m] between predicted and later positions, or nan without any."""
    ahead = predictions[np.isclose(predictions.look_ahead, _AHEAD)]
    asked = pd.DataFrame(
        {"instant": np.rint((ahead.time + _AHEAD) * 1e3).astype(int), "id": ahead.id}
    ).assign(px=ahead.x, py=ahead.y)
    walked = trajectories.assign(instant=np.rint(trajectories.time * 1e3).astype(int))
    both = asked.merge(walked[["instant", "id", "x", "y"]], on=["instant", "id"])
    return float(np.hypot(both.px - both.x, both.py - both.y).mean()) if len(both) else np.nan


def drive(configuration: dict[str, Any]) -> Drive:
    """Return the numbers of one drive and its twin."""
    import giveway

    run = giveway.run(
        {
            "scenario": "shared_space",
            "controller": "mpc",
            "twin": True,
            "time_limit": _LIMIT,
            "record": {"predictions": _AHEAD},
            **configuration,
        }
    )
    people, ego, summary = run.pedestrians, run.ego, run.summary
    near = people[people.minimum_clearance < _NEAR]
    speed = np.interp(near.time_of_minimum_clearance, ego.time, ego.speed)
    return {
        "close": int(((near.minimum_clearance < _CLOSE) & (speed > _FAST)).sum()),
        "near": len(near),
        "time": float(summary["completion_time"]) if summary["completed"] else _LIMIT,
        "delay": float(summary["people_delay"]),
        "jerk": float(summary["rms_jerk"]),
        "braking": float(summary["peak_deceleration"]),
        "touched": int((people.overlap_time > 0).sum()),
        "frontal": int(summary["frontal_contacts"]),
        "error": error_ahead(run.predictions, run.trajectories),
    }


def parts(drives: dict[Place, Drive], name: str) -> Array:
    """Return numerators and denominators (2, n) of the mean of a number, summed for each seed.

    Args:
        drives: Drives by scene and seed.
        name: Name of the number; close passes are divided by the people who come near.
    """
    seeds = sorted({seed for _, seed in drives})
    found = np.zeros((2, len(seeds)))
    for (_, seed), numbers in drives.items():
        below = numbers["near"] if name == "close" else 1.0
        found[:, seeds.index(seed)] += numbers[name], below
    return found


def difference(one: Array, other: Array) -> tuple[float, float, float]:
    """Return the difference of two means, other less one, and its 95 % interval.

    Args:
        one: Numerators and denominators (2, n) of the seeds; see :func:`parts`.
        other: The same of other drives with the same seeds.
    """
    rows = np.random.default_rng(0).integers(one.shape[1], size=(_RESAMPLES, one.shape[1]))

    def mean(these: Array) -> Array:
        above, below = these.sum(axis=-1)
        return np.asarray(above / np.maximum(below, 1.0))

    low, high = np.percentile(mean(other[:, rows]) - mean(one[:, rows]), [2.5, 97.5])
    return float(mean(other) - mean(one)), float(low), float(high)


def row(drives: dict[Place, Drive], base: dict[Place, Drive]) -> list[str]:
    """Return the table's numbers of a predictor's drives, and their differences from others.

    Args:
        drives: Drives by scene and seed.
        base: Drives from which the differences are taken, or none.
    """
    above, below = parts(drives, "close").sum(axis=1)
    told = [str(len(drives)), f"{100 * above / max(below, 1):.1f}"]
    for key, fold, digits in SHOWN.values():
        told.append(f"{fold([numbers[key] for numbers in drives.values()]):.{digits}f}")
    pairs = drives.keys() & base.keys()
    for name, unit in COMPARED.items():
        one, other = (parts({pair: some[pair] for pair in pairs}, name) for some in (base, drives))
        less = unit * np.array(difference(one, other) if pairs else [np.nan] * 3)
        told.append("{:+.1f} [{:+.1f}, {:+.1f}]".format(*less) if drives is not base else "")
    return told


def table(drives: dict[str, Drive], against: str) -> list[str]:
    """Return the lines of the table. The scene "all" has the drives of all scenes.

    Args:
        drives: Drives by "crowd | goals | scene | predictor | seed".
        against: Predictor from which the differences are taken.
    """
    cells: dict[tuple[str, ...], dict[str, dict[Place, Drive]]] = {}
    for key, numbers in drives.items():
        crowd, goals, scene, predictor, seed = key.split(" | ")
        for place in (scene, "all"):
            cell = cells.setdefault((crowd, goals, place), {})
            cell.setdefault(predictor, {})[scene, seed] = numbers
    less = [f"{name}, less" for name in COMPARED]
    head = ["crowd", "goals", "scene", "predictor", "drives", "close passes [%]", *SHOWN, *less]
    lines = [f"| {' | '.join(head)} |", "|---" * len(head) + "|"]
    for names, cell in cells.items():
        for predictor, its in cell.items():
            told = row(its, cell.get(against, {}))
            lines.append(f"| {' | '.join((*names, predictor, *told))} |")
    return lines


def main() -> None:
    """Drive, and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--write", type=Path, help="drive, and write the numbers here")
    parser.add_argument("--show", type=Path, help="print the table of such a file")
    parser.add_argument("--against", default="VCI, MIXED", help="predictor to compare with")
    parser.add_argument("--people", nargs="+", default=["MIXED"], help="presets, or models")
    parser.add_argument("--goals", nargs="+", default=["known"], help="[perception] goals")
    parser.add_argument("--predictors", nargs="+", default=list(PREDICTORS))
    parser.add_argument("--weights", nargs="+", default=[""], choices=WEIGHTS)
    parser.add_argument("--seeds", type=int, nargs=2, default=(901, 913), help="last plus one")
    options = parser.parse_args()
    if options.write is not None:
        file: Path = options.write
        drives = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
        cells = (options.people, options.goals, SCENES, options.weights, options.predictors)
        for people, goals, scene, weights, predictor in product(*cells):
            name = f"{predictor}, {weights}" if weights else predictor
            for seed in range(*options.seeds):
                key = f"{people} | {goals} | {scene} | {name} | {seed}"
                if key in drives:
                    continue
                kind = "model" if people in PLAIN_MODELS else "preset"
                crowd = {**SCENES[scene]["crowd"], kind: people}
                perception = {"goals": goals, **PREDICTORS[predictor]}
                said = {"crowd": crowd, "perception": perception, "seed": seed}
                drives[key] = drive(
                    {**SCENES[scene], **said, "controller_options": WEIGHTS[weights]}
                )
            file.write_text(json.dumps(drives), encoding="utf-8")
    if options.show is not None:
        print("\n".join(table(json.loads(options.show.read_text("utf-8")), options.against)))


if __name__ == "__main__":
    main()
