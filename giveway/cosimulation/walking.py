"""The crowd's step: people walk under the vehicles, and those who have arrived leave."""

import numpy as np

from giveway.config import RunConfig
from giveway.crowd.disturbance import disturbance_of
from giveway.crowd.roster import Roster
from giveway.recording.walk_log import WalkLog
from pedestrian_model import CrowdModel, Surroundings, Vehicles, arrived

ARRIVAL_RADIUS = 0.5  # [m] this close to the destination a pedestrian has arrived


class Walking:
    """Steps a crowd.

    Args:
        config: the run's.
        model: of the crowd.
        roster: the crowd, and who is in it.
        log: notes how people get on; None: nobody asks for it.
    """

    def __init__(
        self, config: RunConfig, model: CrowdModel, roster: Roster, log: WalkLog | None = None
    ) -> None:
        self._model = model
        self._roster = roster
        self._log = log
        self._disturbance = disturbance_of(config, model)

    def note(self, step: int) -> None:
        """Note where everybody is at the control instant ``step``."""
        if self._log is not None:
            roster = self._roster
            self._log.note(step, roster.ids, roster.present, roster.crowd)

    def advance(self, step: int, vehicles: Vehicles, surroundings: Surroundings) -> list[str]:
        """Step the crowd from the control instant ``step``; the names of those who have arrived.

        Args:
            step: the instant.
            vehicles: that people feel.
            surroundings: the walls and lights that they heed.
        """
        roster = self._roster
        if not len(roster.present):
            return []
        crowd = roster.crowd
        if self._disturbance is None:
            self._model.advance(crowd, vehicles, surroundings)
        else:
            self._disturbance.advance(
                crowd, vehicles, surroundings, roster.present, len(roster.ids)
            )
        there = arrived(roster.crowd, ARRIVAL_RADIUS)
        if not np.count_nonzero(there):
            return []
        if self._log is not None:
            self._log.arrive(step + 1, roster.present[there])
        return roster.release(there)
