"""Selects the people and background vehicles to record: all near an ego, some far."""

import numpy as np
from numpy.typing import NDArray

from giveway.config.tables.basics import RecordConfig
from giveway.crowd.roster import Roster
from giveway.geometry.kernel import Array
from giveway.journal.recorder import Recorder
from giveway.sumo.background import BackgroundVehicles


def looks_ahead(period: float | None, time_step: float) -> int:
    """The steps of look-ahead between two predictions that are kept; 0: none is kept.

    Args:
        period: Time between recorded instants [s], or None if none is kept.
        time_step: Control step [s].
    """
    return 0 if period is None else max(1, round(period / time_step))


class Instants:
    """Keeps whom a run comes by: near the egos at every instant, all from time to time.

    Args:
        recorder: gathers the rows.
        record: what is kept.
        time_step: [s] of the co-simulation.

    Attributes:
        looks: steps of look-ahead between two predictions that are kept; 0: none is.
    """

    looks: int

    def __init__(self, recorder: Recorder, record: RecordConfig, time_step: float) -> None:
        self._recorder, self._time_step = recorder, time_step
        self._near = record.near
        self._far_steps = max(1, round(record.far_period / time_step))
        self._far_background = -self._far_steps
        self.looks = looks_ahead(record.predictions, time_step)
        self._named = 0

    def crowd(self, k: int, roster: Roster, places: Array, *, everybody: bool) -> None:
        """Record the pedestrians near an ego, and from time to time all of them.

        Args:
            k: The instant.
            roster: who is there.
            places: (e, 2) [m] the egos' front bumpers.
            everybody: Record all now.
        """
        if len(roster.ids) > self._named:
            self._recorder.name_pedestrians(roster.ids[self._named :], roster.traits)
            self._named = len(roster.ids)
        crowd = roster.crowd
        within = np.inf if everybody or k % self._far_steps == 0 else self._near
        self._recorder.crowd(roster.person_ids, crowd.position, crowd.velocity, places, within)

    def background(
        self, k: int, time: float, background: BackgroundVehicles, places: Array
    ) -> None:
        """Record the background vehicles near an ego, and from time to time all of them.

        Args:
            k: The instant.
            time: Time [s] of the instant on SUMO's clock.
            background: Background vehicles.
            places: Stations of the egos, as for :meth:`crowd`.
        """
        within = self._near
        if k - self._far_background >= self._far_steps:
            self._far_background, within = k, np.inf
        self._recorder.background(time, background, places, within)

    def predictions(self, ego_id: str, predicted: Array, present: NDArray[np.intp]) -> None:
        """Record where an ego expects people to be.

        Args:
            ego_id: SUMO's.
            predicted: (h, n, 2) [m] at the next h instants.
            present: (n,) whom, by their numbers in the roster.
        """
        # for a period beyond the horizon, the horizon's end is kept
        every = min(self.looks, len(predicted))
        kept = predicted[every - 1 :: every]
        looks = np.arange(every, len(predicted) + 1, every, dtype=np.float64)
        self._recorder.predictions(ego_id, present, self._time_step * looks, kept)
