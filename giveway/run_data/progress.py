"""The progress of a run, and how it or one ego's drive ended."""

import enum
from collections.abc import Callable
from dataclasses import dataclass


class Ending(enum.StrEnum):
    """The reason why a run, or one ego's drive, ended."""

    COMPLETED = "completed"  # the ego has driven its distance
    TIME_LIMIT = "time limit"  # the ego has not driven its distance within the time limit
    SCENARIO_END = "scenario end"  # the scenario's own end came first
    INTERRUPTED = "interrupted"  # the user wanted it to end
    FAILED = "failed"  # an error ended it
    CRASHED = "crashed"  # native code ended or hung its process


@dataclass(frozen=True)
class Progress:
    """The progress of a run, for its watchers."""

    time: float  # [s] since the run's first instant; 0 while SUMO alone runs up to it
    clock: float  # [s] SUMO's clock
    position: float  # [m] position of the first ego on the road; nan without an ego
    goal: float  # [m] distance that this ego is to drive; nan without an ego
    speed: float  # [m/s] speed of this ego; nan without an ego
    acting: str  # controller that acts; empty without an ego
    pedestrians: int  # number of people in the crowd
    doing: str = ""  # activity of the run, told once, while it does not drive


Watcher = Callable[[Progress], None]
