"""Traffic conflicts: how many people, and for how long, were close to a collision course."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from giveway.metrics.conflicts import time_to_collision

if TYPE_CHECKING:
    from giveway.geometry.bodies import VehicleShape
    from giveway.records.tracks import CrowdTrack, EgoTrack

CRITICAL_TTC = 1.5
"""[s] Below it an encounter is a conflict: the threshold of SSAM (Gettman & Head 2003, FHWA), in
the range that observers of Hayward's (1972) near misses found."""


@dataclass(frozen=True)
class Critical:
    """The conflicts of a drive.

    Attributes:
        persons: how many pedestrians had one.
        share: of the control instants at which somebody had one.
    """

    persons: int
    share: float


def conflicts(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float, stop_speed: float
) -> Critical:
    """Count whose time to collision is below ``CRITICAL_TTC`` while the ego moves.

    Who walks up to a standing car is on a collision course too, but in no danger.

    Args:
        ego: the ego's track, T instants.
        crowd: the crowd's track.
        shape: the ego's rectangle.
        body_radius: radius of a pedestrian [m].
        stop_speed: the ego moves above it [m/s].

    Raises:
        ValueError: a record points outside the ego's track.
    """
    ttc = time_to_collision(ego, crowd, shape, body_radius)
    critical = (ttc < CRITICAL_TTC) & (ego.speed[crowd.step] > stop_speed)
    instants = np.unique(crowd.step[critical]).size
    return Critical(
        persons=int(np.unique(crowd.pedestrian[critical]).size),
        share=instants / ego.time.size if ego.time.size else 0.0,
    )
