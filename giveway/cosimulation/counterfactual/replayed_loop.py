"""The loop over people and SUMO under egos whose motion is known.

It has two uses: the time after the last ego's arrival, and the counterfactual run, in which egos
drive as they did while people do not feel them. No controller and no vehicle FMU takes part.
"""

from typing import NamedTuple

import numpy as np

from giveway.cosimulation.assembly import Driven, Parts
from giveway.cosimulation.mirror import Mirror
from giveway.cosimulation.traffic.interactions import Meetings
from giveway.cosimulation.traffic.traffic_log import TrafficNotes
from giveway.crowd.roster import Walking
from giveway.ego.ego import Ego
from giveway.ego.recorded_ego import RecordedVehicle
from giveway.geometry.kernel import Array
from giveway.journal.walk_log import WalkLog
from giveway.processes.heartbeat import Heartbeat, Phase
from giveway.processes.interrupts import DeferredInterrupt

_SAME_INSTANT = 1e-6  # Difference [s] up to which two instants are one


class Standing(NamedTuple):
    """The state at which a run is continued."""

    mirror: Mirror
    step: int  # control step
    start: float  # Time [s] on SUMO's clock at step 0
    fronts: Array  # (e, 2) [m] centres of the zone while no ego is on the road


class ReplayedLoop:
    """Steps people and SUMO until everybody who counts has arrived.

    Args:
        parts: Parts of the run.
        walking: Step of the crowd.
        walks: Log of the people's walks; it knows who counts.
        traffic: Log of the background vehicles.
        heartbeat: Function that tells another process that this one is alive.
        since: State of the run that is to be continued, or None to start at its beginning.
        driven: Recorded egos that are the centres of the zone, or None if the egos of the loop are.
    """

    def __init__(
        self,
        parts: Parts,
        walking: Walking,
        walks: WalkLog,
        traffic: TrafficNotes,
        heartbeat: Heartbeat,
        *,
        since: Standing | None = None,
        driven: Driven | None = None,
    ) -> None:
        self._parts = parts
        self._walking = walking
        self._walks = walks
        self._notes = traffic
        self._heartbeat = heartbeat
        if since is None:
            mirror = Mirror(parts.sumo, parts.time_step, parts.substeps, parts.horizon)
            since = Standing(mirror, 0, parts.sumo.time, np.empty((0, 2)))
        self._mirror, self._k, self._start, self._fronts = since
        # the last step at which SUMO was read
        self._read = self._k - 1 if self._k == 0 else self._k
        self._driven = driven
        self._egos: list[Ego] = []
        self._meetings = Meetings(parts.sumo, parts.yielding, parts.gaps)

    def run(self, last: int, interrupt: DeferredInterrupt, *, to_the_end: bool = False) -> bool:
        """Step up to the control step ``last``, or until nobody who counts is on the way.

        Args:
            last: Last control step.
            interrupt: Flag that is read between two steps.
            to_the_end: True to step up to ``last`` although nobody is on the way.

        Returns:
            True if it came to its end without an interrupt.

        Raises:
            GivewayError: a part failed.
        """
        parts = self._parts
        end = (parts.sumo.end - self._start) / parts.time_step - 1e-6
        while True:
            self._heartbeat.step(self._k, self._start + self._k * parts.time_step)
            if self._k % parts.substeps == 0 and self._k > self._read:
                self._read_sumo()
            self._mirror.place(self._egos)
            self._walking.note(self._k)
            self._see_arrivals()
            goes_on = to_the_end or self._egos or parts.departures.waiting
            if not (goes_on or self._walks.awaits(parts.roster.person_ids)):
                return True
            if self._k >= min(last, end):
                return True
            if interrupt.requested:
                return False
            self._advance()

    def _read_sumo(self) -> None:
        parts, crowd = self._parts, self._parts.roster
        for ego in parts.departures.due():
            self._egos.append(ego)
            _recall(ego)
        if parts.arrivals is not None:
            parts.arrivals.update(self._k)
        if parts.exchange is not None:
            parts.exchange.update(self._places())
        if parts.priority is not None:
            parts.priority.update(crowd.crowd)
        self._mirror.read(self._egos, crowd.crowd.position)
        background = self._mirror.background
        self._meetings.let_cross(background, ())
        self._meetings.update(background, crowd, self._egos)
        self._notes.note(background)

    def _places(self) -> Array:
        """The centres (e, 2) [m] of the zone."""
        if self._driven is not None:
            return _on_the_road(self._driven, self._start + self._k * self._parts.time_step)
        if self._egos:
            return np.array([ego.pose[:2] for ego in self._egos])
        return self._fronts

    def _see_arrivals(self) -> None:
        gone = [ego for ego in self._egos if ego.arrived]
        for ego in gone:
            self._mirror.drop(self._egos.index(ego))
            self._egos.remove(ego)
            self._parts.sumo.vehicles.dismiss(ego.id)
        if gone and not (self._egos or self._parts.departures.waiting):
            self._fronts = np.array([ego.pose[:2] for ego in gone])

    def _advance(self) -> None:
        parts, mirror = self._parts, self._mirror
        for ego in self._egos:
            ego.advance()
            _recall(ego)
        self._heartbeat.beat(Phase.CROWD)
        names = self._walking.advance(self._k, mirror.others, parts.surroundings)
        if names:
            ours = names if parts.exchange is None else parts.exchange.arrive(names)
            parts.sumo.remove_persons(ours)
            parts.roster.count("arrived", len(ours))
        self._k += 1
        self._heartbeat.beat(Phase.SUMO)
        if self._k % parts.substeps:
            mirror.carry_on()
        else:
            mirror.push(self._k, self._egos, parts.roster)
            if parts.departures.waiting:
                parts.departures.note()


def _recall(ego: Ego) -> None:
    """Restore the ego's stop of the recorded run, which no rule computes again."""
    if isinstance(ego.vehicle, RecordedVehicle):
        ego.rules.stop = ego.front + ego.vehicle.stop_gap


def _on_the_road(driven: Driven, time: float) -> Array:
    """The front bumpers (e, 2) [m] of the egos that were on the road at ``time`` [s]."""
    places = []
    for track in driven.tracks.values():
        row = int(np.searchsorted(track.time, time - _SAME_INSTANT))
        if row < len(track.time) and track.time[row] <= time + _SAME_INSTANT:
            places.append((track.front_x[row], track.front_y[row]))
    return np.array(places).reshape(-1, 2)
