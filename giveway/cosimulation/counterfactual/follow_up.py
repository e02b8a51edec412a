"""The follow-up of a run: people and traffic, also after the last ego has arrived."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from giveway.cosimulation.assembly import Parts
from giveway.cosimulation.counterfactual.crowd_alone import CrowdAlone
from giveway.cosimulation.counterfactual.replayed_loop import ReplayedLoop, Standing
from giveway.cosimulation.mirror import Mirror
from giveway.cosimulation.traffic.traffic_log import TrafficNotes
from giveway.crowd.generation.sources import Sources
from giveway.crowd.roster import Trait, Walking
from giveway.ego.ego import Ego
from giveway.geometry.kernel import Array
from giveway.journal.walk_log import WalkLog
from giveway.processes.heartbeat import Heartbeat
from giveway.processes.interrupts import DeferredInterrupt
from pedestrian_model import Crowd

LONGEST = 60.0
"""Longest time [s] for which people are followed after the last ego's arrival."""


class Beginning(NamedTuple):
    """The people that giveway adds, at the beginning of a run."""

    crowd: Crowd
    names: tuple[str, ...]  # Ids of the people
    traits: Mapping[str, Trait]  # Traits that differ from person to person
    sources: Sources | None = None  # Sources of people who come in later, or None
    substeps: int = 1  # control steps per SUMO step


class Followed:
    """The notes that a run makes for its counterfactual run.

    Args:
        parts: Parts of the run, at its initial state.

    Attributes:
        beginning: People that giveway adds, at first and later.
        secluded: True if only they and the egos are ever there.
        walks: Log of the people's walks.
        traffic: Log of the background vehicles.
        arrival: Control step at which the run itself ended.
        time_loss: Time [s] that the background vehicles had lost by then.
        last: Control step at which the follow-up ends at the latest.
    """

    def __init__(self, parts: Parts) -> None:
        self._parts = parts
        roster = parts.roster
        self.beginning = Beginning(
            roster.crowd.copy(),
            tuple(roster.ids),
            dict(roster.traits),
            None if parts.arrivals is None else parts.arrivals.sources,
            parts.substeps,
        )
        self.secluded = parts.secluded
        self.walks = WalkLog(parts.time_step)
        self.traffic = TrafficNotes(parts.sumo)
        self.arrival = self.last = 0
        self.time_loss = 0.0
        self._fronts: Array = np.empty((0, 2))
        self._parked: list[str] = []

    def leave(self, egos: list[Ego], dismissed: bool) -> None:
        """Note the egos that have arrived; an ego that is not dismissed is still in SUMO."""
        self._fronts = np.array([ego.pose[:2] for ego in egos])
        self._parked = [] if dismissed else [egos[-1].id]

    def follow(
        self,
        completed: bool,
        walking: Walking,
        mirror: Mirror,
        step: int,
        start: float,
        heartbeat: Heartbeat,
        interrupt: DeferredInterrupt,
    ) -> bool:
        """Go on from the control step ``step`` until the people who came close have arrived.

        A run whose egos have not all arrived is not continued, and its counterfactual run ends with
        it.

        Args:
            completed: True if every ego has arrived.
            walking: Step of the crowd.
            mirror: Exchange of the run with SUMO.
            step: Last control step of the run.
            start: Time [s] on SUMO's clock at step 0.
            heartbeat: Function that tells another process that this one is alive.
            interrupt: Flag that is read between two steps.

        Returns:
            True if it came to its end without an interrupt.

        Raises:
            GivewayError: a part failed.
        """
        parts = self._parts
        self.walks.stop_looking()
        self.arrival = self.last = step
        self.time_loss = self.traffic.time_loss
        if not completed:
            return True
        self.last = step + math.ceil(LONGEST / parts.time_step)
        if self.secluded:
            sources = self.beginning.sources
            alone = CrowdAlone(parts.roster, walking, self.walks, step, sources, parts.substeps)
            alone.go_on(self.last, self.walks.near, heartbeat)
            return True
        for name in self._parked:
            parts.sumo.vehicles.dismiss(name)
        since = Standing(mirror, step, start, self._fronts)
        loop = ReplayedLoop(parts, walking, self.walks, self.traffic, heartbeat, since=since)
        return loop.run(self.last, interrupt)
