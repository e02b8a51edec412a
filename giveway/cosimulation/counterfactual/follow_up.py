"""A run followed: how people and traffic get on, also when the last ego has arrived."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from giveway.cosimulation.assembly import Parts
from giveway.cosimulation.counterfactual.crowd_alone import CrowdAlone
from giveway.cosimulation.counterfactual.replayed_loop import ReplayedLoop, Standing
from giveway.cosimulation.mirror import Mirror
from giveway.cosimulation.traffic.traffic_log import TrafficNotes
from giveway.crowd.generation.flows import Flows
from giveway.crowd.roster import Trait, Walking
from giveway.ego.ego import Ego
from giveway.geometry.kernel import Array
from giveway.journal.walk_log import WalkLog
from giveway.processes.heartbeat import Heartbeat
from giveway.processes.interrupts import DeferredInterrupt
from pedestrian_model import Crowd

LONGEST = 60.0
"""[s] after the last ego's arrival, for which people are followed at most."""


class Beginning(NamedTuple):
    """The people that giveway adds, as a run began."""

    crowd: Crowd
    names: tuple[str, ...]  # their ids
    traits: Mapping[str, Trait]  # what sets them apart
    flows: Flows | None = None  # of those who come in during the run; None: nobody does
    substeps: int = 1  # control steps per SUMO step


class Followed:
    """The notes of a run for its counterfactual run.

    Args:
        parts: Parts of the run, at its initial state.

    Attributes:
        beginning: The people that giveway adds, at first and later.
        secluded: nobody but they and the egos is ever there.
        walks: how they get on.
        traffic: what the background vehicles do.
        arrival: The control step at which the run itself ended.
        time_loss: [s] of the background vehicles up to then.
        last: The control step at which following ends at the latest.
    """

    def __init__(self, parts: Parts) -> None:
        self._parts = parts
        roster = parts.roster
        self.beginning = Beginning(
            roster.crowd.copy(),
            tuple(roster.ids),
            dict(roster.traits),
            None if parts.arrivals is None else parts.arrivals.flows,
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
        """Note that egos have arrived; those that are not dismissed are still in SUMO."""
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
        """Go on from the control step ``step`` until those who came close have arrived.

        A run whose egos have not all arrived is not gone on with; its twin ends with it.

        Args:
            completed: whether every ego has arrived.
            walking: The crowd's step.
            mirror: The run's.
            step: The last one of the run.
            start: SUMO's clock [s] at step 0.
            heartbeat: Function that tells another process that this one is alive.
            interrupt: Flag that is read between two steps.

        Returns:
            Whether it came to its end without an interrupt.

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
            flows = self.beginning.flows
            alone = CrowdAlone(parts.roster, walking, self.walks, step, flows, parts.substeps)
            alone.go_on(self.last, self.walks.near, heartbeat)
            return True
        for name in self._parked:
            parts.sumo.vehicles.dismiss(name)
        since = Standing(mirror, step, start, self._fronts)
        loop = ReplayedLoop(parts, walking, self.walks, self.traffic, heartbeat, since=since)
        return loop.run(self.last, interrupt)
