"""Does something happen in the scenario encounter? python benchmarks/bounds/encounters.py.

In each crowd it says whether people slow ``pid-tuned``, and by how much a driver who knows the
future of the crowd in which nobody drives is faster: docs/encounters.md, docs/bounds.md. With
``--figure FILE`` it draws one seed's crowds instead.
"""

from __future__ import annotations

import argparse
import multiprocessing
from pathlib import Path
from typing import NamedTuple

import matplotlib as mpl
import numpy as np
from clairvoyant import DURATION, rules_of, time_step_of
from clairvoyant_search import Lattice, Limits, fastest, flags_of, people_along

import giveway
from giveway.figures.style import BLUE, GREY, VERMILION, save_figure, styled

mpl.use("Agg")
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

DENSITIES = {"sparse": 12, "medium": 24, "dense": 48}
_QUICK = 1e-3  # [s] price of a second below d_safe: contact alone is avoided


class Task(NamedTuple):
    """One crowd."""

    seed: int
    pedestrians: int


class Found(NamedTuple):
    """What one crowd gave."""

    slowed: bool
    time: float  # [s] of pid-tuned
    bound: float  # [s] of the clairvoyant driver


def examine(task: Task) -> Found:
    """Drive through one crowd, and search how fast that can be done."""
    common = {
        "scenario": "encounter",
        "seed": task.seed,
        "crowd": {"pedestrians": task.pedestrians},
        "record": {"near": 1e6, "far_period": 0.05},
    }
    driven = giveway.run({**common, "controller": "pid-tuned"})
    alone = giveway.run({**common, "ego": {"none": True}, "time_limit": DURATION})
    ego, track = driven.egos[0], driven.ego_track
    start = float(track.front_x[0]), float(track.front_y[0]), float(track.heading[0])
    lattice = Lattice.of(Limits(), ego.goal)
    people = people_along(alone.crowd_track, time_step_of(driven), start, DURATION, lattice.step)
    flags = flags_of(people, lattice, rules_of(driven))
    best = fastest(flags, lattice, float(track.speed[0]), _QUICK)
    summary = driven.summary
    return Found(summary["slowed"], summary["completion_time"], best.completion_time)


@styled
def picture(seed: int) -> Figure:
    """The crowds of a seed at departure, where they walk in two seconds, and the ego."""
    figure = Figure(figsize=(10.0, 3.9), layout="compressed")
    panels = figure.subplots(1, len(DENSITIES), sharex=True, sharey=True)
    for axes, (name, people) in zip(panels, DENSITIES.items(), strict=True):
        config = {
            "scenario": "encounter",
            "seed": seed,
            "crowd": {"pedestrians": people},
            "controller": "pid-tuned",
            "time_limit": 2.1,
            "record": {"near": 1e6, "far_period": 0.05},
        }
        run = giveway.run(config)
        crowd, track = run.crowd_track, run.ego_track
        first = crowd.step == 0
        early = crowd.step <= round(2.0 / time_step_of(run))
        axes.axhline(0.0, color=GREY, linewidth=0.8)
        axes.plot(crowd.x[early], crowd.y[early], ",", color=GREY)
        axes.plot(crowd.x[first], crowd.y[first], "o", color=BLUE, markersize=3.0)
        shape = run.shape
        corner = track.front_x[0] - shape.length, track.front_y[0] - shape.width / 2.0
        axes.add_patch(Rectangle(corner, shape.length, shape.width, color=VERMILION))
        axes.set(title=f"{name}: {people} people", xlabel="x [m]", aspect="equal")
        axes.set(xlim=(-6.0, 68.0), ylim=(-38.0, 38.0))
    panels[0].set_ylabel("y [m]")
    return figure


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=None)
    parser.add_argument("--figure", type=Path, help="where to draw the crowds of --first")
    options = parser.parse_args()
    if options.figure is not None:
        save_figure(picture(options.first), options.figure)
        return
    seeds = range(options.first, options.first + options.seeds)
    print("| density | people | slowed | `pid-tuned` [s] | clairvoyant [s] | gain, median [s] "
          "| gain of at least 1 s |\n" + "|---" * 7 + "|")  # fmt: skip
    with multiprocessing.get_context("spawn").Pool(options.jobs) as pool:
        for name, people in DENSITIES.items():
            found = pool.map(examine, [Task(seed, people) for seed in seeds], 1)
            slowed, time, bound = (np.array(column, float) for column in zip(*found, strict=True))
            gain = time - bound
            print(
                f"| {name} | {people} | {slowed.mean():.0%} | {time.mean():.2f} | "
                f"{bound.mean():.2f} | {np.median(gain):.2f} | {np.mean(gain >= 1.0):.0%} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
