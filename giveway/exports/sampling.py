"""The trajectories of a run at equal times, as other formats expect them.

People and vehicles far from every ego are recorded only once per second, and SUMO's own vehicles at
SUMO's steps. In between they are interpolated linearly. An object that was away returns under
another name.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.errors import ConfigError, ResultsError
from giveway.geometry.kernel import Array
from giveway.replays.run_folder import RunFolder

PEDESTRIAN = "pedestrian"
_AWAY = 1.5  # Factor on the longest usual time between two rows; then a new track begins


@dataclass(frozen=True)
class Track:
    """One object during a presence without a break.

    Attributes:
        id: Id in SUMO, followed by ``#2``, ``#3`` ... from its second presence on.
        object: Id in SUMO.
        type: Type as in ``trajectories.csv``.
        first: Index of its first instant.
        x, y: Coordinates (n,) [m].
        angle: Navigational angle (n,) [deg].
        speed: Speed (n,) [m/s].
    """

    id: str
    object: str
    type: str
    first: int
    x: Array
    y: Array
    angle: Array
    speed: Array

    def __len__(self) -> int:
        return len(self.x)


@dataclass(frozen=True)
class Sampled:
    """The objects of a run at the times ``begin`` + k ``step``.

    Attributes:
        begin: First instant [s] on SUMO's clock.
        step: Time between two instants [s].
        count: Number of instants.
        tracks: Tracks in the order of their first rows.
    """

    begin: float
    step: float
    count: int
    tracks: tuple[Track, ...]

    @property
    def present(self) -> list[list[int]]:
        """Numbers of the tracks that are there at each instant."""
        found: list[list[int]] = [[] for _ in range(self.count)]
        for number, track in enumerate(self.tracks):
            for index in range(track.first, track.first + len(track)):
                found[index].append(number)
        return found

    def people(self) -> list[Track]:
        """The tracks of pedestrians."""
        return [track for track in self.tracks if track.type == PEDESTRIAN]

    def time(self, index: int) -> float:
        """Return the time [s] of an instant."""
        return round(self.begin + index * self.step, 6)


def sampled(run: RunFolder, step: float | None = None) -> Sampled:
    """Return the trajectories of a run at equal times.

    Args:
        run: Results folder.
        step: Time [s] between two instants in whole milliseconds, or None for the control step.

    Raises:
        ConfigError: the step makes no sense.
        ResultsError: the run has no trajectories.
    """
    step = run.step if step is None else step
    if not 0.001 <= step <= 10.0 or abs(1000.0 * step - round(1000.0 * step)) > 1e-6:
        raise ConfigError(f"--step {step:g}: expected 0.001 to 10 [s], whole milliseconds")
    rows = run.trajectories
    if not len(rows):
        raise ResultsError(f"{run.path}: the trajectories have no rows; there is nothing to export")
    begin = float(rows["time"].min())
    count = math.floor((float(rows["time"].max()) - begin) / step + 1e-6) + 1
    away = _AWAY * max(run.config.record.longest_period, run.sumo_step, run.step)
    tracks: list[Track] = []
    for name, of in rows.groupby("id", sort=False):
        of = of.sort_values("time", kind="stable")
        breaks = np.flatnonzero(np.diff(of["time"].to_numpy(np.float64)) > away) + 1
        for number, part in enumerate(np.split(np.arange(len(of)), breaks), start=1):
            shown = str(name) if number == 1 else f"{name}#{number}"
            track = _track(shown, str(name), of.iloc[part], begin, step)
            if track is not None:
                tracks.append(track)
    return Sampled(begin, step, count, tuple(tracks))


def _track(shown: str, name: str, rows: pd.DataFrame, begin: float, step: float) -> Track | None:
    time = (rows["time"].to_numpy(np.float64) - begin) / step
    first, last = math.ceil(time[0] - 1e-6), math.floor(time[-1] + 1e-6)
    if last < first:
        return None
    at = np.arange(first, last + 1, dtype=np.float64)
    x, y, speed = (
        np.interp(at, time, rows[name].to_numpy(np.float64)) for name in ("x", "y", "speed")
    )
    turned = np.unwrap(rows["angle"].to_numpy(np.float64), period=360.0)
    angle = np.mod(np.interp(at, time, turned), 360.0)
    return Track(shown, name, str(rows["type"].iloc[0]), first, x, y, angle, speed)


def numbered(tracks: Sequence[Track]) -> tuple[dict[str, NDArray[np.int64]], list[str]]:
    """Return columns in the order of frames, ``frame``, ``id``, ``x``, ``y``, and names by id.

    Ids count from 1, because some readers take 0 for no object.
    """
    lengths = np.array([len(track) for track in tracks], dtype=np.int64)
    number = np.repeat(np.arange(1, len(tracks) + 1), lengths)
    frame = np.concatenate([track.first + np.arange(len(track)) for track in tracks])
    order = np.lexsort((number, frame))
    columns = {"frame": frame[order], "id": number[order]}
    for name in ("x", "y", "angle"):
        columns[name] = np.concatenate([getattr(track, name) for track in tracks])[order]
    return columns, [track.id for track in tracks]
