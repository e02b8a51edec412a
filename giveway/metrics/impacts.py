"""The speeds of contacts, and how close the moving ego came to people ahead of it."""

from dataclasses import dataclass
from math import inf, nan
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.contact import to_frame
from giveway.geometry.kernel import kernel
from giveway.metrics.conflicts import (
    Records,
    as_floats,
    centre_poses,
    contact_body,
    proximity,
    records_of,
)
from giveway.metrics.contacts import FRONTAL, MOVING, SIDE, impacts
from giveway.run_data.columns import Quantity

CHILD = "child"  # Kind of a person
IMPACTS = "impacts"  # Key of [metrics] that adds these columns


class ImpactMetric:
    """A metric of giveway's own that only some runs have."""

    @dataclass(frozen=True)
    class Columns:
        """The columns that these runs have besides."""

        frontal_impact_speed: Annotated[
            float,
            Quantity(
                "m/s", "largest speed of the ego at a frontal contact; empty: none", better="lower"
            ),
        ]
        side_impact_speed: Annotated[
            float,
            Quantity("m/s", "largest relative speed at a contact at a side; empty: none"),
        ]
        adult_impact_speed: Annotated[
            float,
            Quantity("m/s", "the same, of people who are no children; empty: none", better="lower"),
        ]
        child_impact_speed: Annotated[
            float, Quantity("m/s", "the same, of children; empty: none", better="lower")
        ]
        clearance_ahead: Annotated[
            float,
            Quantity(
                "m", "smallest distance to a person straight ahead of the moving ego; empty: none"
            ),
        ]

    def measure(self, drive: Any) -> Columns:
        """Return the numbers of one ego's drive.

        Args:
            drive: :class:`~giveway.results.ego_result.EgoResult` of the ego.
        """
        adult, child, side, ahead = nan, nan, nan, inf
        body = drive.shape, drive.body_radius
        for people in drive.crowd.by_people():
            near = proximity(drive.track, people, *body)
            kinds, speeds = impacts(drive.track, people, *body, near.clearance)
            is_child = np.array([kind == CHILD for kind in people.kinds] or [False] * len(speeds))
            adult = float(np.fmax(adult, _largest(speeds[(kinds == FRONTAL) & ~is_child])))
            child = float(np.fmax(child, _largest(speeds[(kinds == FRONTAL) & is_child])))
            side = float(np.fmax(side, _largest(speeds[kinds == SIDE])))
            ahead = _clearance_ahead(
                centre_poses(drive.track, drive.shape),
                as_floats(drive.track.speed),
                records_of(people, slice(None)),
                contact_body(*body),
                ahead,
            )
        frontal = float(np.fmax(adult, child))
        return self.Columns(frontal, side, adult, child, ahead if ahead < inf else nan)


def _largest(speeds: NDArray[np.float64]) -> float:
    return float(speeds.max()) if speeds.size else nan


@kernel
def _clearance_ahead(
    poses: NDArray[np.float64],
    speed: NDArray[np.float64],
    records: Records,
    body: tuple[float, float, float],
    smallest: float,
) -> float:
    """Return the smallest distance [m] from the bumper to a circle in the rectangle's track."""
    step, x, y, _, _ = records
    half_length, half_width, radius = body
    for r in range(step.size):
        k = step[r]
        if speed[k] <= MOVING:
            continue
        p_x, p_y = to_frame(x[r] - poses[k, 0], y[r] - poses[k, 1], poses[k, 2], poses[k, 3])
        if abs(p_y) < half_width + radius and p_x > half_length:
            smallest = min(smallest, max(p_x - half_length - radius, 0.0))
    return smallest
