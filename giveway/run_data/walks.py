"""The progress of people on their ways at each control instant, as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class WalkTrack:
    """The people that giveway moved on their ways, as flat records in time order.

    Attributes:
        step: (R,) Index of the control instant.
        pedestrian: (R,) Index into ``ids``.
        x, y: (R,) [m] Position of the body's centre.
        vx, vy: (R,) [m/s] Velocity.
        remaining: (R,) [m] Rest of the route.
        walked: (R,) [m] Distance walked so far.
        arrival_step: (A,) Control instants at which somebody reached the last way-point.
        arrival_pedestrian: (A,) Index into ``ids`` of who arrived.
        desired_speed: (n,) [m/s] Desired speed.
        near: (n,) Whether the person came close to an ego's way; others have no records.
        ids: Ids of all n people.
        time_step: [s] between two control instants.
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
