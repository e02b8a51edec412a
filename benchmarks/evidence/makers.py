"""The makers of measured blocks: functions that turn what was run into Markdown, and columns."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tables import FRONTAL, SIDE, Column, Tables

Maker = Callable[[Path], list[str]]
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


def less(*columns: Column) -> tuple[Column, ...]:
    """The columns of the differences to the baseline."""
    return tuple(
        column._replace(show="less", title=f"{column.title}, less the baseline")
        for column in columns
    )


def means(*columns: Column) -> Maker:
    """Maker of a study's table with these columns."""
    return lambda folder: Tables(folder).means(columns)


def printed(file: Path) -> list[str]:
    """Return what a command printed, as Markdown."""
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


def drives_told(folder: Path) -> list[str]:
    """The cookbook's sentence about drives that succeed and drives that do not."""
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
MODEL_COLUMNS = (TIME, WAIT, JERK, BELOW_TTC, DELAY, FRONTAL, SIDE)
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
