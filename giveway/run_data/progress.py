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
    """The progress of a run, for those who watch it."""

    time: float  # [s] since the run's first instant; 0 while SUMO alone runs up to it
    clock: float  # [s] SUMO's
    position: float  # [m] driven by the first ego on the road; nan without one
    goal: float  # [m] that this ego is to drive; nan without one
    speed: float  # [m/s] of this ego; nan without one
    acting: str  # which controller acts; empty without an ego
    pedestrians: int  # in the crowd
    doing: str = ""  # what it does, told once, where it does not drive


Watcher = Callable[[Progress], None]
