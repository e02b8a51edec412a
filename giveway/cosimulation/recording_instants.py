"""The selection of road users to record: those near an ego always, others sometimes."""

import numpy as np
from numpy.typing import NDArray

from giveway.config.tables.basics import RecordConfig
from giveway.crowd.roster import Roster
from giveway.geometry.kernel import Array
from giveway.journal.recorder import Recorder
from giveway.sumo.background import BackgroundVehicles


def looks_ahead(period: float | None, time_step: float) -> int:
    """The number of control steps between two recorded predictions, or 0 if none is recorded.

    Args:
        period: Time between recorded predictions [s], or None if none is recorded.
        time_step: Control step [s].
    """
    return 0 if period is None else max(1, round(period / time_step))


class Instants:
    """Records the road users near the egos at every instant, and all others from time to time.

    Args:
        recorder: Recorder that gathers the rows.
        record: Configuration of what is recorded.
        time_step: Control step [s].

    Attributes:
        looks: Number of control steps between two recorded predictions, or 0 if none is recorded.
    """

    looks: int

    def __init__(self, recorder: Recorder, record: RecordConfig, time_step: float) -> None:
        self._recorder, self._time_step = recorder, time_step
        self._near = record.near
        self._far_steps, self._thin = record.steps(time_step), record.far_period is not None
        self._far_background = -self._far_steps
        self.looks = looks_ahead(record.predictions, time_step)
        self._named = self._changes = 0

    def crowd(self, k: int, roster: Roster, places: Array, *, everybody: bool) -> None:
        """Record the pedestrians near an ego, and from time to time all of them.

        Args:
            k: Number of the control step.
            roster: The crowd and its members.
            places: Front bumpers (e, 2) [m] of the egos.
            everybody: True to record everybody now, unless [record] says how often.
        """
        if len(roster.ids) > self._named:
            self._recorder.name_pedestrians(roster.ids[self._named :], roster.traits)
            self._named = len(roster.ids)
        for name, reacts in roster.written.changes[self._changes :]:
            self._recorder.reacting(roster.index(name), reacts)
        self._changes = len(roster.written.changes)
        crowd = roster.crowd
        within = (
            np.inf if (everybody and not self._thin) or k % self._far_steps == 0 else self._near
        )
        self._recorder.crowd(roster.person_ids, crowd.position, crowd.velocity, places, within)

    def background(
        self, k: int, time: float, background: BackgroundVehicles, places: Array
    ) -> None:
        """Record the background vehicles near an ego, and from time to time all of them.

        Args:
            k: Number of the control step.
            time: Time [s] of the instant on SUMO's clock.
            background: Background vehicles.
            places: Front bumpers (e, 2) [m] of the egos.
        """
        within = self._near
        if k - self._far_background >= self._far_steps:
            self._far_background, within = k, np.inf
        self._recorder.background(time, background, places, within)

    def predictions(self, ego_id: str, predicted: Array, present: NDArray[np.intp]) -> None:
        """Record the positions at which an ego expects people.

        Args:
            ego_id: Id of the ego in SUMO.
            predicted: Positions (h, n, 2) [m] at the next h instants.
            present: Number (n,) of each person in the roster.
        """
        # if the period is longer than the horizon, the last predicted instant is kept
        every = min(self.looks, len(predicted))
        kept = predicted[every - 1 :: every]
        looks = np.arange(every, len(predicted) + 1, every, dtype=np.float64)
        self._recorder.predictions(ego_id, present, self._time_step * looks, kept)
