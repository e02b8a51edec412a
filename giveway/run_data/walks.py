"""How people got on with their ways, control instant by control instant, as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class WalkTrack:
    """The people that giveway moved on their ways, as flat records in time order.

    Attributes:
        step: (R,) the control instant.
        pedestrian: (R,) index into ``ids``.
        x, y: (R,) [m] body centre.
        vx, vy: (R,) [m/s].
        remaining: (R,) [m] what is left of its route.
        walked: (R,) [m] so far.
        arrival_step: (A,) the control instants at which somebody reached the last way-point.
        arrival_pedestrian: (A,) who that was.
        desired_speed: (n,) [m/s].
        near: (n,) whether it came close to an ego's way; the others have no records.
        ids: of all n.
        time_step: [s] between two control instants.
        last: the last control instant that was looked at.
    """

    step: NDArray[np.int64]
    pedestrian: NDArray[np.int64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    vx: NDArray[np.float64]
    vy: NDArray[np.float64]
    remaining: NDArray[np.float64]
    walked: NDArray[np.float64]
    arrival_step: NDArray[np.int64]
    arrival_pedestrian: NDArray[np.int64]
    desired_speed: NDArray[np.float64]
    near: NDArray[np.bool_]
    ids: tuple[str, ...]
    time_step: float
    last: int

    def until(self, step: int) -> WalkTrack:
        """The records and arrivals up to the control instant ``step``."""
        if self.last <= step:
            return self
        end = int(np.searchsorted(self.step, step, side="right"))
        arrivals = int(np.searchsorted(self.arrival_step, step, side="right"))
        cut = {
            name: getattr(self, name)[:end]
            for name in ("step", "pedestrian", "x", "y", "vx", "vy", "remaining", "walked")
        }
        return WalkTrack(
            **cut,
            arrival_step=self.arrival_step[:arrivals],
            arrival_pedestrian=self.arrival_pedestrian[:arrivals],
            desired_speed=self.desired_speed,
            near=self.near,
            ids=self.ids,
            time_step=self.time_step,
            last=step,
        )
