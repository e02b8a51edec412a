"""A crowd that walks with one velocity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from giveway.run_data.tracks import CrowdTrack


def steady_crowd(starts: np.ndarray, velocity: Sequence[float], time: np.ndarray) -> CrowdTrack:
    """Tracks of people who all walk with one velocity."""
    people, instants = len(starts), len(time)
    places = starts[None] + time[:, None, None] * np.asarray(velocity)
    flat = np.full(people * instants, 1.0)
    return CrowdTrack(
        step=np.repeat(np.arange(instants), people),
        pedestrian=np.tile(np.arange(people), instants),
        x=places[..., 0].ravel(),
        y=places[..., 1].ravel(),
        vx=flat * velocity[0],
        vy=flat * velocity[1],
        ids=tuple(f"ped{i}" for i in range(people)),
    )


STEP = 0.05  # [s]
