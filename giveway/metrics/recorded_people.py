"""The numbers of a drive among people who walk as they were recorded."""

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from giveway.metrics.contacts import RECORDED
from giveway.run_data.columns import Quantity
from giveway.run_data.tracks import NEVER


class RecordedPeopleMetric:
    """A metric of runs by the model ``recorded``."""

    @dataclass(frozen=True)
    class Columns:
        """The columns that these runs have besides."""

        handed_over: Annotated[
            int, Quantity(None, "recorded pedestrians whom another model moved from an instant on")
        ]
        recorded_contacts: Annotated[
            int,
            Quantity(
                None, "pedestrians that overlapped it while they walked as recorded; counted apart"
            ),
        ]

    def measure(self, drive: Any) -> Columns:
        """Return the numbers of one ego's drive.

        Args:
            drive: :class:`~giveway.results.ego_result.EgoResult` of the ego.
        """
        reacts_from = drive.crowd.reacts_from
        handed_over = 0
        if reacts_from is not None:
            # a person who always reacts has 0, less the instant at which the ego departed
            recorded = reacts_from > -drive.first
            handed_over = int((recorded & (reacts_from < NEVER - drive.first)).sum())
        contacts = int(np.count_nonzero(drive.pedestrians["contact"] == RECORDED))
        return self.Columns(handed_over, contacts)
