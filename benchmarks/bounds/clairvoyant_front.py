"""Time against people who are left a second: python benchmarks/bounds/clairvoyant_front.py.

In the scenes in which `mpc` is to save two fifths of `pid-tuned`'s delay, everybody drives through
each crowd. In what was recorded the front of completion time against people whose
post-encroachment time is below 1 s is searched. What the columns mean, and what the front does not
say: docs/bounds.md.
"""

from __future__ import annotations

import argparse
import multiprocessing
import tomllib
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd
from clairvoyant import DURATION, NOBODY, rules_of, time_step_of
from clairvoyant_encroachment import (
    SECOND,
    Bodies,
    Search,
    Vertex,
    certain_gap,
    encroachments,
    stretches_of,
)
from clairvoyant_front_tables import (
    BASELINE,
    DRIVEN,
    ENOUGH,
    FRONT,
    IN_EACH,
    MARGIN,
    NO_WORSE,
    Group,
    groups_of,
    show,
)
from clairvoyant_lattice import Lattice, Limits, unhindered
from clairvoyant_search import CONTACT, People, flags_of, people_along
from matplotlib.figure import Figure

import giveway
from giveway.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LIGHT_GREY,
    SKY_BLUE,
    VERMILION,
    quiet_grid,
    save_figure,
    styled,
)
from giveway.metrics import encroachment

if TYPE_CHECKING:
    from clairvoyant_encroachment import Stretches
    from matplotlib.axes import Axes

    from giveway.results.run_result import RunResult
    from giveway.run_data.tracks import CrowdTrack

SCENES = ("one-sided, 30", "two-sided, 30", "two-sided, 60", "stream, 30", "encounter, medium")
DRIVERS: dict[str, dict[str, Any]] = {
    BASELINE: {"controller": "pid-tuned"},
    "careful": {"controller": "mpc", "controller_options": {"style": "careful"}},
    "mpc": {"controller": "mpc"},
    "assertive": {"controller": "mpc", "controller_options": {"style": "assertive"}},
}
RECORDINGS = (NOBODY, BASELINE, "mpc")
COLOURS = {NOBODY: GREEN, BASELINE: VERMILION, "mpc": BLUE}
MARKS = {BASELINE: ("o", VERMILION), "careful": ("v", SKY_BLUE), "mpc": ("o", BLUE),
         "assertive": ("^", BLACK)}  # fmt: skip
RECORD = {"near": 1e6, "far_period": 0.05}


class Task(NamedTuple):
    """One crowd."""

    scene: str
    seed: int


class Row(NamedTuple):
    """One drive, or one motion that was found."""

    scene: str
    seed: int
    recording: str  # who drives in it
    motion: str  # the driver; or of which case
    free: float  # [s] with nobody about
    time: float  # [s] to the goal
    share: float  # of all people, with a post-encroachment time below a second
    met: float  # [s] times people within a second of the ego
    contact: float  # [s] of contact ahead that no motion avoids


class Recorded(NamedTuple):
    """A crowd's recording, seen from the ego's start."""

    people: People  # every control step
    exact: Stretches  # of a second


def scenes() -> dict[str, dict[str, Any]]:
    """The configurations of the scenes, as `giveway study controllers` has them."""
    text = (files("giveway.studies") / "bundled" / "controllers.toml").read_text("utf-8")
    study = tomllib.loads(text)
    found = {name: study["run"] | study["factors"]["scene"][name] for name in SCENES}
    for config in found.values():
        config.pop("twin")
    return found


class Crowd:
    """One crowd: driven through by everybody, and its recordings."""

    def __init__(self, task: Task) -> None:
        common = {**scenes()[task.scene], "seed": task.seed, "record": RECORD}
        self.task = task
        self.runs = {name: giveway.run({**common, **driver}) for name, driver in DRIVERS.items()}
        run = self.run = self.runs[BASELINE]
        track, self.time_step = run.ego_track, time_step_of(run)
        if np.ptp(track.heading) > 1e-6:
            raise SystemExit("clairvoyant_front: the ego's way bends; expected a straight one")
        self.start = float(track.front_x[0]), float(track.front_y[0]), float(track.heading[0])
        self.speed = float(track.speed[0])
        self.lattice = Lattice.of(Limits(), run.egos[0].goal)
        self.bodies = Bodies(run.shape, run.body_radius)
        alone = giveway.run({**common, "ego": {"none": True}, "time_limit": DURATION})
        self.crowds = {name: each.egos[0].crowd for name, each in self.runs.items()}
        self.crowds[NOBODY] = alone.crowd_track
        if any(crowd.ids != alone.crowd_track.ids for crowd in self.crowds.values()):
            raise SystemExit("clairvoyant_front: the recordings are of different people")

    @property
    def free(self) -> float:
        """The time [s] with nobody about."""
        lattice = self.lattice
        v = min(round(self.speed / lattice.speed), lattice.speeds)
        return float(unhindered(lattice)[v, -lattice.lowest, 0])

    def recorded(self, crowd: CrowdTrack) -> Recorded:
        """A recording, and the stretches of exactly a second."""
        h = self.time_step
        people = people_along(crowd, h, self.start, DURATION, h)
        return Recorded(people, stretches_of(people, self.lattice, self.bodies, h, SECOND))

    def driven(self, name: str, run: RunResult) -> Row:
        """How somebody drove."""
        exact = self.recorded(self.crowds[name]).exact
        every = round(self.lattice.step / self.time_step)
        at = np.round(run.ego_track.position[::every] / self.lattice.station).astype(np.int64)
        summary = run.summary
        return self._row(
            (name, DRIVEN), summary["completion_time"], summary["share_below_pet"], at, exact
        )

    def found(self, recording: str) -> list[Row]:
        """The motions of the front of a recording, and the one that makes nobody worse off."""
        recorded = self.recorded(self.crowds[recording])
        every = round(self.lattice.step / self.time_step)
        people = People(recorded.people.station[::every], recorded.people.offset[::every])
        flags = flags_of(people, self.lattice, rules_of(self.run))
        gap = certain_gap(self.lattice, self.time_step)
        stretches = stretches_of(recorded.people, self.lattice, self.bodies, self.time_step, gap)
        ego = self.run.egos[0]
        times = encroachment(ego.track, ego.crowd, self.bodies.shape, self.bodies.body_radius).time
        near = times < SECOND
        counted = np.ones_like(near), ~near
        everybody, others = (
            Search(flags, stretches, self.lattice, self.speed, who) for who in counted
        )
        cases = [(FRONT, vertex) for vertex in everybody.front()]
        cases.append((NO_WORSE, others.most_spared()))
        return [self._motion((recording, case), each, flags, recorded) for case, each in cases]

    def _motion(
        self, name: tuple[str, str], vertex: Vertex, flags: np.ndarray, recorded: Recorded
    ) -> Row:
        course, ego = vertex.course, self.run.ego_track
        times = encroachments(course, self.lattice, recorded.people, self.bodies, ego)
        at = course.stations[:-1][: len(flags)]
        touched = np.count_nonzero(flags[np.arange(at.size), at] & CONTACT)
        share, contact = float(np.mean(times < SECOND)), self.lattice.step * touched
        return self._row(name, course.time, share, at, recorded.exact, contact)

    def _row(
        self,
        name: tuple[str, str],
        time: float,
        share: float,
        at: np.ndarray,
        exact: Stretches,
        contact: float = 0.0,
    ) -> Row:
        met = self.lattice.step * float(np.count_nonzero(exact.at(at)))
        return Row(*self.task, *name, self.free, float(time), float(share), met, contact)


def examine(task: Task) -> list[Row]:
    """Drive and search one crowd."""
    crowd = Crowd(task)
    rows = [crowd.driven(name, run) for name, run in crowd.runs.items()]
    for recording in RECORDINGS:
        rows += crowd.found(recording)
    return rows


def examine_all(tasks: list[Task], jobs: int | None, kept: Path | None) -> pd.DataFrame:
    """All crowds; those whose rows are ``kept`` are not examined again, the others' are added."""
    there = kept is not None and kept.exists()
    rows = pd.read_csv(kept) if there else pd.DataFrame(columns=Row._fields)
    done = set(zip(rows.scene, rows.seed, strict=True))
    left = [task for task in tasks if (task.scene, task.seed) not in done]
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        for found in pool.imap(examine, left, 1):
            new = pd.DataFrame(found, columns=Row._fields)
            rows = pd.concat([rows, new], ignore_index=True) if len(rows) else new
            if kept is not None:
                rows.to_csv(kept, index=False)
    wanted = {(task.scene, task.seed) for task in tasks}
    return rows[[key in wanted for key in zip(rows.scene, rows.seed, strict=True)]]


@styled
def picture(rows: pd.DataFrame) -> Figure:
    """Delay saved against people with less than a second, scene by scene and pooled."""
    groups = groups_of(rows)
    columns = min(3, len(groups))
    figure = Figure(figsize=(3.3 * columns, 3.0 * -(-len(groups) // columns) + 0.7))
    figure.set_layout_engine("constrained")
    panels = figure.subplots(-(-len(groups) // columns), columns, squeeze=False, sharey=True)
    for axes, group in zip(panels.flat, groups, strict=True):
        _draw(axes, group)
    for axes in panels[:, 0]:
        axes.set_ylabel("delay saved [% of pid-tuned's]")
    for axes in panels[-1]:
        axes.set_xlabel("people left less than a second [%]")
    figure.legend(
        *panels[0, 0].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=4,
        columnspacing=1.5,
    )
    return figure


def _draw(axes: Axes, group: Group) -> None:
    delay, share = group.delay.mean(), group.share.mean()
    enough = ENOUGH if len(group.parts) > 1 else IN_EACH
    box = [0.0, 100.0 * (share + MARGIN)], 100.0 * enough, 100.0
    axes.fill_between(*box, color=LIGHT_GREY, linewidth=0.0, label="where mpc is to be")
    for recording, colour in COLOURS.items():
        time, met = group.front(recording).T
        before = "when nobody drives" if recording == NOBODY else f"before {recording}"
        label = f"who knows what people do {before}"
        axes.plot(100.0 * met, 100.0 * (1.0 - time / delay), color=colour, label=label)
    for name, (mark, colour) in MARKS.items():
        means = group.means(name, DRIVEN).mean()
        saved = 1.0 - (means.time - means.free) / delay
        axes.plot(100.0 * means.share, 100.0 * saved, mark, color=colour, label=name)
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.set(title=group.name, xlim=(0.0, None), ylim=(-80.0, 100.0))
    quiet_grid(axes)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--first", type=int, default=551, help="the first seed")
    parser.add_argument("--scene", action="append", choices=SCENES, help="only this; repeatable")
    parser.add_argument("--jobs", type=int, default=None)
    parser.add_argument("--rows", type=Path, help="a CSV file to keep what was found, and go on")
    parser.add_argument("--figure", type=Path, help="where to draw the picture")
    options = parser.parse_args()
    seeds = range(options.first, options.first + options.seeds)
    tasks = [Task(scene, seed) for seed in seeds for scene in options.scene or SCENES]
    rows = examine_all(tasks, options.jobs, options.rows)
    show(rows)
    if options.figure is not None:
        save_figure(picture(rows), options.figure)


if __name__ == "__main__":
    main()
