"""Station against time: who is in the corridor, and how two controllers get through.

    python benchmarks/bounds/plot_gaps.py [--seed 13] [--out docs/figures/gaps.png]

Every dot is a person in the corridor; the line is the ego's front bumper, the band its body. The
free regions of this plane are the gaps that the planner chooses from.
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt

import giveway
from giveway.figures.style import ORANGE, SKY_BLUE, VERMILION

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HALF_WIDTH = 1.25  # [m] of the corridor in shared_space


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=13)
    parser.add_argument("--out", default="docs/figures/gaps.png")
    arguments = parser.parse_args()
    figure, axes = plt.subplots(1, 2, figsize=(10.0, 4.0), sharex=True, sharey=True)
    for axis, controller in zip(axes, ("pid-tuned", "mpc"), strict=True):
        draw(axis, controller, arguments.seed)
    axes[0].set_ylabel("station on the ego's way [m]")
    axes[0].legend(loc="lower right", frameon=False)
    figure.tight_layout()
    figure.savefig(arguments.out, dpi=120)
    print(arguments.out)


def draw(axis: Axes, controller: str, seed: int) -> None:
    result = giveway.run({"scenario": "shared_space", "controller": controller, "seed": seed})
    ego = result.egos[0]
    track, crowd, length = ego.track, ego.crowd, ego.shape.length
    time = track.time - track.time[0]
    inside = np.abs(crowd.y) <= HALF_WIDTH
    axis.plot(time[crowd.step[inside]], crowd.x[inside], ".", ms=2, color=VERMILION, label="person")
    axis.fill_between(time, track.front_x - length, track.front_x, color=SKY_BLUE, alpha=0.5)
    axis.plot(time, track.front_x, color="black", lw=1.2, label="ego's front")
    acts = track.controller == "safety"
    axis.plot(time[acts], track.front_x[acts], "o", ms=4, color=ORANGE, label="safety layer acts")
    summary = result.summary
    axis.set_title(
        f"{controller}: {summary['completion_time']:.1f} s, RMS jerk {summary['rms_jerk']:.1f} m/s³"
    )
    axis.set_xlabel("time [s]")
    axis.set_ylim(10.0, 45.0)


if __name__ == "__main__":
    main()
