"""The rows of a run, gathered step by step; our own state, not SUMO's mirror of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.jit import kernel
from giveway.tracks import BackgroundTrack, CrowdTrack, EgoTrack, Timings

if TYPE_CHECKING:
    from giveway.ego_path import Pose
    from giveway.traffic import BackgroundVehicles

Array = NDArray[np.float64]


class EgoRow(NamedTuple):
    """The ego at one control instant, in the order of :class:`EgoTrack`'s arrays."""

    time: float
    position: float
    pose: Pose
    speed: float
    acceleration: float
    force: float
    gap: float
    reference_speed: float
    acting: str
    reason: str
    status: str
    iterations: int


class Rows:
    """A table of float64 that grows by doubling."""

    def __init__(self, columns: int) -> None:
        self._buffer = np.empty((1024, columns))
        self._count = 0

    def block(self, rows: int) -> Array:
        """A view of the next ``rows`` rows, for the caller to fill."""
        start, self._count = self._count, self._count + rows
        while self._count > len(self._buffer):
            self._buffer = np.concatenate([self._buffer, np.empty_like(self._buffer)])
        return self._buffer[start : self._count]

    @property
    def filled(self) -> Array:
        """The rows filled so far (a view)."""
        return self._buffer[: self._count]


class Recorder:
    """Collects what the loop knows at each control instant.

    Args:
        pedestrian_ids: every pedestrian of the run; blocks refer to them by index.
    """

    def __init__(self, pedestrian_ids: tuple[str, ...]) -> None:
        self._ids = pedestrian_ids
        self._ego: list[EgoRow] = []
        self._crowd = Rows(6)  # step, pedestrian, x, y, vx, vy
        self._timings = Rows(len(Timings.NAMES))
        self._background: list[tuple[float, BackgroundVehicles]] = []

    @property
    def steps(self) -> int:
        """Control instants recorded so far."""
        return len(self._ego)

    def ego(self, row: EgoRow) -> None:
        """Record the ego at the next control instant."""
        self._ego.append(row)

    def crowd(self, present: NDArray[np.int64], position: Array, velocity: Array) -> None:
        """Record the pedestrians ``present`` at the instant of the latest ego row."""
        step = len(self._ego) - 1
        fill_block(step, present, position, velocity, self._crowd.block(len(present)))

    def background(self, time: float, vehicles: BackgroundVehicles) -> None:
        """Record SUMO's own vehicles at ``time`` [s]."""
        if vehicles.ids:
            self._background.append((time, vehicles))

    def timing(self, *seconds: float) -> None:
        """Record the computing times of one control step, in the order of ``Timings.NAMES``."""
        self._timings.block(1)[0] = seconds

    def ego_track(self) -> EgoTrack:
        """The ego's rows as arrays."""
        rows = self._ego
        numbers = np.array(
            [(r.time, r.position, *r.pose, *r[3:8]) for r in rows], dtype=np.float64
        ).reshape(-1, 10)
        time, position, x, y, heading, speed, acceleration, force, gap, reference_speed = (
            np.ascontiguousarray(column) for column in numbers.T
        )
        return EgoTrack(
            time=time,
            position=position,
            front_x=x,
            front_y=y,
            heading=heading,
            speed=speed,
            acceleration=acceleration,
            force=force,
            gap=gap,
            reference_speed=reference_speed,
            acting=np.array([r.acting for r in rows], dtype=np.str_),
            reason=np.array([r.reason for r in rows], dtype=np.str_),
            solver_status=np.array([r.status for r in rows], dtype=np.str_),
            solver_iterations=np.array([r.iterations for r in rows], dtype=np.int64),
        )

    def crowd_track(self) -> CrowdTrack:
        """The crowd's rows as arrays."""
        step, pedestrian, x, y, vx, vy = (
            np.ascontiguousarray(column) for column in self._crowd.filled.T
        )
        return CrowdTrack(
            step=step.astype(np.int64),
            pedestrian=pedestrian.astype(np.int64),
            x=x,
            y=y,
            vx=vx,
            vy=vy,
            ids=self._ids,
        )

    def background_track(self) -> BackgroundTrack:
        """The background vehicles' rows as arrays."""
        instants = self._background
        if not instants:
            nothing, nobody = np.empty(0), np.empty(0, dtype=np.str_)
            return BackgroundTrack(nothing, nobody, nobody, *(nothing for _ in range(6)))
        return BackgroundTrack(
            np.concatenate([np.full(len(v.ids), time) for time, v in instants]),
            np.concatenate([np.array(v.ids, dtype=np.str_) for _, v in instants]),
            np.concatenate([np.array(v.types, dtype=np.str_) for _, v in instants]),
            np.concatenate([v.x for _, v in instants]),
            np.concatenate([v.y for _, v in instants]),
            np.concatenate([v.heading for _, v in instants]),
            np.concatenate([v.speed for _, v in instants]),
            np.concatenate([v.length for _, v in instants]),
            np.concatenate([v.width for _, v in instants]),
        )

    def timings(self) -> Timings:
        """The computing times as an array."""
        return Timings(self._timings.filled.copy())


@kernel
def fill_block(
    step: int, present: NDArray[np.int64], position: Array, velocity: Array, block: Array
) -> None:
    """Fill the crowd's rows of one step."""
    for j in range(len(present)):
        block[j, 0] = step
        block[j, 1] = present[j]
        block[j, 2] = position[j, 0]
        block[j, 3] = position[j, 1]
        block[j, 4] = velocity[j, 0]
        block[j, 5] = velocity[j, 1]
