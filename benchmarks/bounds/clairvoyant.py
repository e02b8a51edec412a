"""How far the controllers are from one that knows the future.

Run: python benchmarks/bounds/clairvoyant.py

Every crowd is driven through by each controller, and once nobody drives. In what was recorded, the
fastest motion is searched that avoids contact and pays a price for each second below d_safe. What
the columns mean, and what the bound does not say: docs/bounds.md.
"""

from __future__ import annotations

import argparse
import multiprocessing
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from clairvoyant_search import (
    Lattice,
    Limits,
    Motion,
    People,
    Rules,
    fastest,
    flags_of,
    people_along,
)
from matplotlib.figure import Figure

import giveway
from giveway.config.tables.regulation import CORRIDOR_MARGIN
from giveway.figures.style import BLUE, GREEN, GREY, ORANGE, VERMILION, quiet_grid, save_figure
from giveway.figures.style import styled as in_house_style
from giveway.studies.statistics.bootstrap import mean_interval, seed_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from giveway.results.run_result import RunResult

CONTROLLERS = ("pid-tuned", "mpc", "mpc-paper")
NOBODY = "nobody drives"
RECORDINGS = (NOBODY, "pid-tuned", "mpc")
PRICES = {  # [s] per second below d_safe
    "contact avoided": 1e-3,  # of equally fast motions the one that is less long below
    "d_safe kept": 1e3,  # wherever it can be, whatever that takes
}
DURATION = 60.0  # [s] people are followed, recorded or going straight on
COLOURS = {"pid-tuned": VERMILION, "mpc": BLUE, "mpc-paper": ORANGE, NOBODY: GREEN}


class Task(NamedTuple):
    """One crowd."""

    seed: int
    pedestrians: int
    step: float  # [s] of the lattice


class Found(NamedTuple):
    """What one crowd gave: [s] completion and below d_safe."""

    driven: dict[str, tuple[float, float]]  # by controller
    bound: dict[tuple[str, str], Motion]  # by recording and name of the price


def search(people: People, lattice: Lattice, rules: Rules, speed: float) -> list[Motion]:
    """The best motion at each price."""
    flags = flags_of(people, lattice, rules)
    k = np.arange(round(lattice.shortest / lattice.step))
    if np.isclose(speed, lattice.top) and not flags[k, 2 * lattice.speeds * k].any():
        return [Motion(lattice.shortest, 0.0, 0.0)] * len(PRICES)  # at full speed all the way
    quick = fastest(flags, lattice, speed, PRICES["contact avoided"])
    if quick.time_below == 0.0:
        return [quick, quick]
    return [quick, fastest(flags, lattice, speed, PRICES["d_safe kept"])]


def examine(task: Task) -> Found:
    """Drive and search one crowd."""
    common = {"seed": task.seed, "crowd": {"pedestrians": task.pedestrians}}
    record = {"near": 1e6, "far_period": 0.05}
    runs = {
        name: giveway.run({**common, "controller": name, "record": record}) for name in CONTROLLERS
    }
    alone = {**common, "ego": {"none": True}, "record": record, "time_limit": 30.0}
    driven = {name: _driven(run) for name, run in runs.items()}
    ego, rules = runs["mpc"].egos[0], rules_of(runs["mpc"])
    track, h = ego.track, time_step_of(runs["mpc"])
    if np.ptp(track.heading) > 1e-6:
        raise SystemExit("clairvoyant: the ego's way bends; expected a straight one")
    start = float(track.front_x[0]), float(track.front_y[0]), float(track.heading[0])
    lattice = Lattice.of(Limits(step=task.step), ego.goal)
    crowds = {name: runs[name].egos[0].crowd for name in RECORDINGS if name != NOBODY}
    crowds[NOBODY] = giveway.run(alone).crowd_track
    bound = {}
    for name in RECORDINGS:
        people = people_along(crowds[name], h, start, DURATION, task.step)
        motions = search(people, lattice, rules, float(track.speed[0]))
        bound |= {(name, price): motion for price, motion in zip(PRICES, motions, strict=True)}
    return Found(driven, bound)


def _driven(run: RunResult) -> tuple[float, float]:
    summary, below = run.summary, run.ego_track.gap < run.config.regulation.safe_distance
    return float(summary["completion_time"]), time_step_of(run) * float(np.sum(below))


def time_step_of(run: RunResult) -> float:
    """The control step [s] of a run."""
    return round(float(run.time[1] - run.time[0]), 9)


def rules_of(run: RunResult) -> Rules:
    """Whom the ego of a run must not touch, and who counts as being in front of it."""
    regulation, shape = run.config.regulation, run.shape
    return Rules(
        safe_distance=regulation.safe_distance,
        half_corridor=shape.width / 2 + CORRIDOR_MARGIN,
        half_width=shape.width / 2,
        body_radius=run.body_radius,
    )


def mean_of(values: list[float], name: str) -> str:
    """Mean and BCa interval, as in studies."""
    sample = np.array(values)
    seed = seed_of(["clairvoyant", name])
    between = mean_interval(sample, confidence=0.95, resamples=2000, seed=seed)
    return f"{sample.mean():.1f} [{between.low:.1f}, {between.high:.1f}]"


def show(found: list[Found]) -> None:
    """Print the tables as Markdown."""
    print("| driven by | completion [s] | somebody nearer than d_safe [s] |\n" + "|---" * 3 + "|")
    for name in CONTROLLERS:
        times, below = zip(*(each.driven[name] for each in found), strict=True)
        print(f"| `{name}` | {mean_of(list(times), name)} | {mean_of(list(below), f'{name} b')} |")
    titles = ["who knows the future, recorded before", *(f"{price} [s]" for price in PRICES)]
    titles += [f"of what `pid-tuned` can gain, `{name}`" for name in CONTROLLERS[1:]]
    print(f"\n| {' | '.join(titles)} |")
    print("|---" * len(titles) + "|")
    mean = {name: np.mean([each.driven[name][0] for each in found]) for name in CONTROLLERS}
    base = mean["pid-tuned"]
    for recording in RECORDINGS:
        texts, times = [recording], {}
        for price in PRICES:
            motions = [each.bound[recording, price] for each in found]
            times[price] = [motion.completion_time for motion in motions]
            contacts = sum(motion.contact_time > 0.0 for motion in motions)
            note = f" ({contacts} with contact)" if contacts else ""
            texts.append(mean_of(times[price], f"{recording} {price}") + note)
        gain = base - np.mean(times["contact avoided"])
        texts += [f"{(base - mean[name]) / gain:.0%}" for name in CONTROLLERS[1:]]
        print(f"| {' | '.join(texts)} |")


@in_house_style
def picture(found: list[Found]) -> Figure:
    """Left: how many are still on the way. Right: time against time below d_safe."""
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    for name in CONTROLLERS:
        drives = np.array([each.driven[name] for each in found])
        _still_driving(left, drives[:, 0], name, COLOURS[name], "-")
        time, below = drives.mean(axis=0)
        right.plot(below, time, "o", color=COLOURS[name], label=name)
    for recording in RECORDINGS:
        motions = [[each.bound[recording, price] for price in PRICES] for each in found]
        means = np.array(motions)[:, :, :2].mean(axis=0)
        label = (
            f"clairvoyant, {recording}" if recording == NOBODY else f"clairvoyant, {recording}'s"
        )
        colour = COLOURS[recording]
        right.plot(means[:, 1], means[:, 0], "--", marker=".", color=colour, label=label)
        if recording == NOBODY:
            continue
        times = np.array([row[0].completion_time for row in motions])
        _still_driving(left, times, label, colour, "--")
    left.set_xlabel("time since the start [s]")
    left.set_ylabel("crowds not yet passed [%]")
    left.set_title("Contact avoided, at any distance")
    right.set_xlabel("mean time below d_safe [s]")
    right.set_ylabel("mean completion time [s]")
    right.set_title("Time against distance")
    for axes in (left, right):
        quiet_grid(axes)
        axes.legend()
    left.axvline(10.0, color=GREY, linewidth=0.8)
    return figure


def _still_driving(axes: Axes, times: np.ndarray, label: str, colour: str, line: str) -> None:
    ordered = np.sort(times)
    left = 100.0 * (1.0 - np.arange(1, ordered.size + 1) / ordered.size)
    axes.step(ordered, left, line, where="post", color=colour, label=label)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--pedestrians", type=int, default=30)
    parser.add_argument("--step", type=float, default=0.1, help="of the search's lattice [s]")
    parser.add_argument("--jobs", type=int, default=None)
    parser.add_argument("--figure", type=Path, help="where to draw the picture")
    options = parser.parse_args()
    if options.step > 0.1:
        parser.error("--step: at most 0.1 s, or the front jumps over people between two looks")
    seeds = range(1, options.seeds + 1)
    tasks = [Task(seed, options.pedestrians, options.step) for seed in seeds]
    with multiprocessing.get_context("spawn").Pool(options.jobs) as pool:
        found = pool.map(examine, tasks, 1)
    show(found)
    if options.figure is not None:
        save_figure(picture(found), options.figure)


if __name__ == "__main__":
    main()
