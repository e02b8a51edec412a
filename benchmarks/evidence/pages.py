"""The pages with measured blocks: what is run for each, and which block it fills.

A page that is ``kept`` is not made anew with the others: its campaign has over 1,000 drives, or
its data are not in the repository.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import comparisons
import samples
from tables import FRONTAL, SIDE, Column, Tables
from work import Command, Study

Maker = Callable[[Path], list[str]]
DRIVING = (
    "controller", "fmus", "pedestrian_model", "sumo_scenarios",
    "giveway/config", "giveway/cosimulation", "giveway/crowd", "giveway/ego", "giveway/geometry",
    "giveway/metrics", "giveway/journal", "giveway/run_data", "giveway/studies/bundled",
    "giveway/studies/statistics", "giveway/sumo", "giveway/walkways",
)  # fmt: skip
"""Rooms that decide how an ego drives and how that is measured."""


class Block(NamedTuple):
    """A block of a page: what is run for it, and how its lines are made of that."""

    name: str
    work: Study | Command
    make: Maker


class Page(NamedTuple):
    """A page, or a kept table of one.

    Attributes:
        name: Name on the command line.
        file: Path relative to the repository.
        blocks: Blocks that are filled.
        rooms: Code on which the numbers depend.
        kept: Whether it is made only when ``--kept`` names it.
    """

    name: str
    file: str
    blocks: tuple[Block, ...]
    rooms: tuple[str, ...] = DRIVING
    kept: bool = False


TIME = Column("completion_time", "time [s]", 1)
WAIT = Column("longest_wait", "longest wait [s]", 1)
JERK = Column("rms_jerk", "RMS jerk [m/s³]", 1)
BELOW_TTC = Column("people_below_ttc", "people below 1.5 s", 1)
CLOSE = Column("close_passes", "close passes", 2)
TTC = Column("share_below_ttc", "TTC < 1.5 s", 2)
DELAY = Column("mean_people_delay", "people's mean delay [s]", 2)
LAYER = Column("safety_share", "layer acts [%]", 2, scale=100.0)
BRAKING = Column("peak_deceleration", "hardest braking [m/s²]", 1)


def _with_interval(*columns: Column) -> tuple[Column, ...]:
    return tuple(column._replace(show="interval") for column in columns)


def _less(*columns: Column) -> tuple[Column, ...]:
    return tuple(
        column._replace(show="less", title=f"{column.title}, less the baseline")
        for column in columns
    )


def means(*columns: Column) -> Maker:
    """Maker of a study's table with these columns."""
    return lambda folder: Tables(folder).means(columns)


def printed(file: Path) -> list[str]:
    """What a command printed, as Markdown."""
    return _paragraphs(file.read_text(encoding="utf-8").rstrip("\n").split("\n"))


def part(number: int) -> Maker:
    """Maker of one of the parts that a command printed with a line of ``---`` between them."""
    return lambda file: _paragraphs(
        file.read_text("utf-8").split("\n---\n")[number].strip("\n").split("\n")
    )


def _paragraphs(lines: list[str]) -> list[str]:
    """The lines with an empty one where a table ends."""
    apart = []
    for line, following in zip(lines, [*lines[1:], ""], strict=True):
        apart.append(line)
        if line.startswith("|") and following and not following.startswith("|"):
            apart.append("")
    return apart


def code(command: str) -> Maker:
    """Maker of a code block with a command and what it printed."""
    return lambda file: ["```", f"$ python benchmarks/{command}", *printed(file), "```"]


def _shell(name: str, words: str, quick: str = "") -> Block:
    command = f"speed/{words}"
    return Block(name, Command(command, "one machine", quick), code(command))


def drives_told(folder: Path) -> list[str]:
    """The README's sentence about drives that succeed and drives that do not."""
    runs = Tables(folder).runs
    calm, free = runs[runs.people_below_ttc == 0], runs[runs.stops == 0]
    worst = runs.loc[runs.people_below_ttc.idxmax()]
    return [
        f"Of {len(runs)} drives (seeds {runs.seed.min()} to {runs.seed.max()}) {len(free)} pass "
        f"without a stop, and {len(calm)} without anybody less than 1.5 s from a "
        f"collision. The worst has {int(worst.people_below_ttc)} such people (`--seed "
        f"{int(worst.seed)}`)."
    ]


CONTROLLER_COLUMNS = (
    *_with_interval(TIME, WAIT, JERK), BRAKING, *_with_interval(CLOSE, BELOW_TTC), TTC, DELAY,
    LAYER, FRONTAL, SIDE,
)  # fmt: skip
ROAD_COLUMNS = tuple(column for column in CONTROLLER_COLUMNS if column is not DELAY)
BRIEF = (*_with_interval(TIME, WAIT, JERK, CLOSE, BELOW_TTC), TTC, DELAY, FRONTAL, SIDE)
LAW_COLUMNS = (
    Column("encounters", "encounters per run"),
    *(
        Column(metric, title, 0, "sum")
        for metric, title in (
            ("failures_to_yield", "failures to yield"),
            ("red_lights_run", "red lights run"),
            ("vehicle_contacts", "contacts with vehicles"),
            ("blocked_crossings", "blocked crossings"),
            ("blocked_junctions", "blocked junctions"),
            ("stops_without_cause", "stops without cause [s]"),
            ("hard_brakes", "brakings above 4 m/s²"),
            ("hard_brakes_without_cause", "of these without cause"),
        )
    ),
    TIME,
    FRONTAL,
    SIDE,
)
LIGHT_COLUMNS = _less(
    WAIT, Column("total_wait", "all waits [s]"), Column("stops", "stops", 2), TIME,
    JERK._replace(digits=2), BELOW_TTC._replace(digits=2),
)  # fmt: skip
SPEED = (
    _shell("bench_loop.py", "bench_loop.py", "--pairs 1"),
    _shell("bench_scenario.py", "bench_scenario.py", "--walkers 100 --window 1"),
    _shell("bench_crowd.py", "bench_crowd.py"),
    _shell("bench_crowd_threads.py", "bench_crowd_threads.py"),
    _shell("bench_models.py", "bench_models.py", "--people 5 --steps 3"),
    _shell("bench_qp.py", "bench_qp.py"),
    _shell("bench_fmu.py", "bench_fmu.py", "--ticks 50 --rounds 1"),
    _shell("bench_controller.py", "bench_controller.py"),
    _shell(
        "bench_study.py",
        "bench_study.py --runs 60 --crowds 60 --memory 1000",
        "--runs 2 --crowds 2 --memory 10",
    ),
    _shell("bench_start.py", "bench_start.py --cold", "--rounds 1"),
    _shell("bench_metrics.py", "bench_metrics.py", "--repetitions 1"),
    Block("machine", Command("speed/performance.py --machine", quick="--machine"), printed),
)

PAGES: dict[str, Page] = {
    page.name: page
    for page in (
        Page("readme", "README.md", (Block("encounter", samples.FIRST_DRIVES, drives_told),)),
        Page(
            "controllers",
            "docs/controllers.md",
            (
                Block("styles", samples.ATTITUDES, means(*BRIEF)),
                Block("differences", samples.CONTROLLERS, comparisons.differences),
                Block("saved", samples.CONTROLLERS, comparisons.saved),
                Block("margins", samples.CONTROLLERS, comparisons.margins),
                Block("all scenes", samples.CONTROLLERS, means(*CONTROLLER_COLUMNS)),
                Block("on roads", samples.ON_ROADS, means(*ROAD_COLUMNS)),
                Block("on roads, differences", samples.ON_ROADS, comparisons.differences),
            ),
        ),
        Page(
            "ablation",
            "docs/ablation.md",
            (
                Block(
                    "variants",
                    samples.ABLATION,
                    means(
                        TIME,
                        WAIT,
                        JERK,
                        BELOW_TTC,
                        FRONTAL,
                        LAYER,
                        *_less(TIME, WAIT, JERK, BELOW_TTC),
                    ),
                ),
            ),
        ),
        Page(
            "models",
            "docs/models.md",
            (
                Block(
                    "drivers",
                    samples.MODELS,
                    means(TIME, WAIT, JERK, BELOW_TTC, DELAY, FRONTAL, SIDE),
                ),
                Block(
                    "beliefs",
                    samples.BELIEFS,
                    means(TIME, WAIT, JERK, BELOW_TTC, DELAY, FRONTAL, SIDE),
                ),
            ),
        ),
        Page(
            "safety",
            "docs/safety.md",
            (
                Block(
                    "assumptions",
                    samples.ASSUMPTIONS,
                    means(
                        TIME,
                        *_less(TIME),
                        WAIT,
                        BELOW_TTC,
                        LAYER,
                        FRONTAL,
                        Column("beyond_assumption", "beyond", 0, "sum"),
                        Column("contacts_beyond", "of these hit", 0, "sum"),
                    ),
                ),
                Block("noise", samples.NOISE, means(TIME, JERK, BELOW_TTC, LAYER, FRONTAL)),
                Block("layer", samples.LAYER, means(TIME, WAIT, JERK, FRONTAL, SIDE, LAYER)),
            ),
        ),
        Page(
            "bounds",
            "docs/bounds.md",
            (
                Block(
                    "clairvoyant",
                    Command("bounds/clairvoyant.py --seeds 60", "seeds 1 to 60", "--seeds 2"),
                    printed,
                ),
                Block(
                    "front",
                    Command(
                        "bounds/clairvoyant_front.py --seeds 30 --rows {out}.csv",
                        "seeds 551 to 580",
                        "--seeds 2 --rows {out}.csv",
                    ),
                    printed,
                ),
            ),
            (*DRIVING, "benchmarks/bounds"),
        ),
        Page(
            "encounter",
            "docs/encounter.md",
            (
                Block(
                    "densities",
                    Command("bounds/encounters.py --seeds 40", "seeds 1 to 40", "--seeds 2"),
                    printed,
                ),
            ),
            (*DRIVING, "benchmarks/bounds"),
        ),
        Page(
            "law",
            "docs/law.md",
            (
                Block("law", samples.LAW, means(*LAW_COLUMNS)),
                Block("lights", samples.LIGHTS, means(*LIGHT_COLUMNS)),
                Block(
                    "drawn networks",
                    Command(
                        "law/drawn_law.py --networks 12 --drives 4 --out {out} --jobs {jobs}",
                        "12 networks, 4 drives each",
                        "--networks 1 --drives 1 --out {out} --jobs {jobs}",
                    ),
                    part(-1),
                ),
                Block(
                    "meeting roads",
                    Command(
                        "law/road_campaign.py --seeds 3 --out {out} --jobs {jobs}",
                        "seeds 1 to 3",
                        "--seeds 1 --place ramp --out {out} --jobs {jobs}",
                    ),
                    printed,
                ),
            ),
            (*DRIVING, "benchmarks/law"),
        ),
        Page(
            "pid",
            "docs/pid.md",
            (
                Block(
                    "gains",
                    Command("tuning/tune_pid.py", "no drives"),
                    code("tuning/tune_pid.py"),
                ),
                Block(
                    "profiles",
                    samples.PROFILES,
                    means(
                        TIME,
                        WAIT,
                        JERK,
                        Column("share_below_safe_distance", "below d_safe", 3),
                        FRONTAL,
                    ),
                ),
            ),
            (*DRIVING, "benchmarks/tuning"),
        ),
        Page(
            "gym",
            "docs/gym.md",
            (
                Block(
                    "policy",
                    Command("evidence/gym_policy.py --seeds 20", "seeds 1 to 20", "--seeds 1"),
                    printed,
                ),
            ),
            (*DRIVING, "giveway/gym", "benchmarks/evidence/gym_policy.py"),
        ),
        Page(
            "controller-fmu",
            "docs/controller_fmu.md",
            (
                Block(
                    "same motion",
                    Command(
                        "evidence/controller_fmu_runs.py --runs 20", "seeds 1 to 20", "--runs 1"
                    ),
                    printed,
                ),
            ),
            (*DRIVING, "benchmarks/evidence/controller_fmu_runs.py"),
        ),
        Page(
            "performance", "docs/performance.md", SPEED, (*DRIVING, "giveway", "benchmarks/speed")
        ),
        Page(
            "install",
            "docs/install.md",
            (
                Block("extras", Command("speed/install_cost.py", "one machine"), part(0)),
                Block("dependencies", Command("speed/install_cost.py", "one machine"), part(1)),
            ),
            ("pyproject.toml", "benchmarks/speed/install_cost.py"),
        ),
        Page(
            "benchmark",
            "docs/benchmark.md",
            (
                Block(
                    "rivals",
                    Command(
                        "evidence/rivals.py --out {out} --jobs {jobs}",
                        "seeds 701 to 800",
                        "--out {out} --runs 2",
                    ),
                    printed,
                ),
            ),
            (*DRIVING, "giveway/studies/benchmark"),
            kept=True,
        ),
        Page(
            "front",
            "README.md",
            (
                Block(
                    "front",
                    Command(
                        "evidence/rivals.py --out {out} --front",
                        "seeds 701 to 800",
                        "--out {out} --front",
                    ),
                    printed,
                ),
            ),
            (*DRIVING, "giveway/studies/benchmark"),
            kept=True,
        ),
        Page(
            "paper",
            "docs/reproduction.md",
            (Block("table 2", samples.PAPER, comparisons.situations),),
            kept=True,
        ),
        Page(
            "readings",
            "docs/reproduction.md",
            (Block("readings", samples.READINGS, comparisons.situations),),
            kept=True,
        ),
        Page(
            "sidewalks",
            "docs/law.md",
            (
                Block(
                    "sidewalks",
                    Command(
                        "law/beside_sidewalks.py --seeds 30 --out {out}",
                        "seeds 1 to 30",
                        "--seeds 1 --out {out}",
                    ),
                    printed,
                ),
            ),
            kept=True,
        ),
        Page(
            "foreign-law",
            "docs/law.md",
            (
                Block(
                    "foreign networks",
                    Command(
                        "law/foreign_law.py {data} --drives 20 --seed 1 --out {out} --jobs {jobs}",
                        "20 drives",
                        "{data} --drives 1 --window 60 --out {out}",
                    ),
                    printed,
                ),
            ),
            kept=True,
        ),
        Page(
            "recorded-people",
            "docs/safety.md",
            (
                Block(
                    "recorded people",
                    Command(
                        "bounds/worst_motion.py {data} --dataset citr",
                        "CITR",
                        "{data} --dataset citr",
                    ),
                    code("bounds/worst_motion.py FOLDER --dataset citr"),
                ),
            ),
            ("benchmarks/bounds/worst_motion.py", "giveway/validation"),
            kept=True,
        ),
    )
}
