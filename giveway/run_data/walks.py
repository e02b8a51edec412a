"""The progress of people on their routes at each control instant, as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class WalkTrack:
    """The progress of the people that giveway moves, as flat records in time order.

    Attributes:
        step: Index (R,) of the control instant.
        pedestrian: Index (R,) into ``ids``.
        x, y: Position (R,) [m] of the body's centre.
        vx, vy: Velocity (R,) [m/s].
        remaining: Rest of the route (R,) [m].
        walked: Distance (R,) [m] walked so far.
        arrival_step: Control instants (A,) at which a person reached the last way-point.
        arrival_pedestrian: Index (A,) into ``ids`` of the person who arrived.
        desired_speed: Desired speed (n,) [m/s].
        near: True (n,) if the person came close to an ego's path; others have no records.
        ids: Ids of all n people.
        time_step: Time [s] between two control instants.
        last: Last control instant that was logged.
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
        """Return the records and arrivals up to the control instant ``step``."""
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
