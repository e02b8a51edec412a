"""What the egos of a run cost the people, from the run and its twin."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.metrics import (
    Delays,
    DelaySummary,
    delays,
    encroachment,
    gave_way,
    summarise_delays,
)
from giveway.records.tracks import CrowdTrack, EgoTrack
from giveway.records.walks import WalkTrack


@dataclass(frozen=True)
class Effect:
    """A run's people beside those of its twin.

    Attributes:
        run: how people got on, until after the last ego's arrival.
        twin: the same where they did not feel the egos.
        traffic_differs: whether lights or background vehicles did anything else in the twin.
        traffic_delay: [s] of the background vehicles; nan: not known.
        among_themselves: the twin is the crowd on open ground, without SUMO.
        seconds: of wall clock that following the run and going through the twin took.
    """

    run: WalkTrack
    twin: WalkTrack
    traffic_differs: bool
    traffic_delay: float
    among_themselves: bool
    seconds: float

    @cached_property
    def delays(self) -> Delays:
        """What the egos together cost each person, in the order of the run's ids."""
        return delays(self.run, self.twin)

    def gave_way(
        self, ego: EgoTrack, first: int, shape: VehicleShape, body_radius: float
    ) -> NDArray[np.str_]:
        """(n,) who gave way to an ego: "yes", "no" or "".

        Args:
            ego: its rows.
            first: the control instant at which it departed.
            shape: its body.
            body_radius: of a pedestrian [m].
        """
        of_run = _first(self.run, ego, first, shape, body_radius)
        of_twin = _first(self.twin, ego, first, shape, body_radius)
        places = {name: i for i, name in enumerate(self.twin.ids)}
        there = np.array([places.get(name, -1) for name in self.run.ids], dtype=np.int64)
        twin = np.where(there >= 0, of_twin[there], "") if len(of_twin) else np.full(len(there), "")
        return gave_way(of_run, twin, self.run.near)

    def summary(self, yielded: NDArray[np.str_]) -> DelaySummary:
        """The delays in one row.

        Args:
            yielded: as :meth:`gave_way` gives it.
        """
        return summarise_delays(
            self.delays.delay, yielded, differs=self.traffic_differs, traffic=self.traffic_delay
        )


def _first(
    walks: WalkTrack, ego: EgoTrack, first: int, shape: VehicleShape, body_radius: float
) -> NDArray[np.str_]:
    """(n,) who was first, people's walks after the ego's arrival counted."""
    rows = walks.step >= first
    track = CrowdTrack(
        walks.step[rows] - first,
        walks.pedestrian[rows],
        walks.x[rows],
        walks.y[rows],
        walks.vx[rows],
        walks.vy[rows],
        walks.ids,
    )
    more = np.arange(1, max(0, walks.last - first - len(ego.time) + 1) + 1)
    clock = np.concatenate([ego.time, ego.time[-1] + walks.time_step * more])
    return encroachment(ego, track, shape, body_radius, clock).first
