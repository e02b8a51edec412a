"""Where a run stands, and how it or one ego's drive ended."""

from __future__ import annotations

import enum
from collections.abc import Callable
from dataclasses import dataclass


class Ending(enum.StrEnum):
    """Why a run, or one ego's drive, ended."""

    COMPLETED = "completed"  # the ego has driven its distance
    TIME_LIMIT = "time limit"  # it has not within the time limit
    SCENARIO_END = "scenario end"  # the scenario's own end came first
    INTERRUPTED = "interrupted"  # the user wanted it to end
    FAILED = "failed"  # an error ended it
    CRASHED = "crashed"  # native code ended or hung its process


@dataclass(frozen=True)
class Progress:
    """Where a run stands, for whoever watches."""

    time: float  # [s] since the run's first instant; 0 while SUMO runs up to it by itself
    clock: float  # [s] SUMO's
    position: float  # [m] driven by the first ego on the road; nan without one
    goal: float  # [m] it is to drive; nan without one
    speed: float  # [m/s] of it; nan without one
    acting: str  # which controller acts; empty without an ego
    pedestrians: int  # in the crowd


Watcher = Callable[[Progress], None]
