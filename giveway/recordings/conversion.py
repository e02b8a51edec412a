"""The conversion of a file's rows into tracks: units, axes, velocities, headings and bodies."""

from itertools import pairwise
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.geometry.path import directions
from giveway.recordings.dataset import Dataset
from giveway.recordings.recording import GAP, RESTART, Defect, Tracks

LENGTHS: Final = {"m": 1.0, "cm": 0.01, "mm": 0.001}
_SPEED: Final = {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001, "km/h": 1.0 / 3.6}
_AWAY = 2.0  # Time [s] without a row after which an id belongs to somebody else
_LEAP = {"people": 12.0, "vehicles": 70.0}  # Speeds [m/s] that nobody has across a gap
_TURNING = 0.3  # Speed [m/s] below which the direction of the velocity is no heading


def tracks_of(
    rows: pd.DataFrame,
    role: str,
    dataset: Dataset,
    first: int,
    stride: int,
    rate: float,
    defects: list[Defect],
) -> Tracks:
    """Return the tracks of people or vehicles in metres, radians and a right-handed frame.

    Args:
        rows: Rows under giveway's names, in the order of ids and frames.
        role: Word people or vehicles.
        dataset: Description of the data set.
        first: Number in the files of the first instant.
        stride: Frames from instant to instant.
        rate: Frame rate [1/s] of the files' numbers.
        defects: List to which gaps and ids that start again are added.
    """
    length, speed_unit = LENGTHS[dataset.units.length], _SPEED[dataset.units.speed]
    up = -1.0 if dataset.y_axis == "down" else 1.0
    count = len(rows)

    def column(name: str, unit: float = 1.0) -> Array | None:
        return rows[name].to_numpy(dtype=np.float64) * unit if name in rows else None

    frame = ((rows["frame"].to_numpy(dtype=np.float64) - first) / stride).round().astype(np.int64)
    position = np.empty((count, 2))
    position[:, 0] = rows["x"].to_numpy(dtype=np.float64) * length
    position[:, 1] = rows["y"].to_numpy(dtype=np.float64) * length * up
    time_step = stride / rate
    ids, track = _split(rows, frame, position, time_step, _LEAP[role], defects)
    heading = column("heading")
    if heading is not None:
        heading = np.radians(heading) if dataset.units.angle == "deg" else heading
        heading = up * (np.pi / 2 - heading if dataset.heading_zero == "north" else heading)
    speed, vx, vy = column("speed", speed_unit), column("vx", speed_unit), column("vy", speed_unit)
    if vx is not None and vy is not None:
        velocity = np.stack([vx, up * vy], axis=1)
    elif heading is not None and speed is not None:
        velocity = np.stack([speed * np.cos(heading), speed * np.sin(heading)], axis=1)
    else:
        velocity = _differences(track, frame.astype(np.float64) * time_step, position)
    if speed is None:
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
    if heading is None:
        heading = _directions(track, velocity)
    firsts = np.searchsorted(track, np.arange(len(ids)))
    body = np.tile(
        [dataset.vehicle.front, dataset.vehicle.rear, dataset.vehicle.width], (len(ids), 1)
    )
    long, wide = column("length", length), column("width", length)
    if long is not None:
        own = long[firsts]
        body[:, :2] = np.where((own > 0.0)[:, None], own[:, None] / 2.0, body[:, :2])
    if wide is not None:
        body[:, 2] = np.where(wide[firsts] > 0.0, wide[firsts], body[:, 2])
    kinds = rows["kind"].to_numpy()[firsts].tolist() if "kind" in rows else [""] * len(ids)
    return Tracks(ids, tuple(kinds), track, frame, position, velocity, heading, speed, body)


def _split(
    rows: pd.DataFrame,
    frame: NDArray[np.int64],
    position: Array,
    time_step: float,
    leap: float,
    defects: list[Defect],
) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """Return the ids, and the track of each row; an id that starts again is another track."""
    ids = rows["id"].to_numpy()
    new = np.ones(len(ids), dtype=bool)
    new[1:] = ids[1:] != ids[:-1]
    apart = np.diff(frame, prepend=frame[:1])
    away = np.hypot(*np.diff(position, axis=0, prepend=position[:1]).T)
    gap = ~new & (apart > 1)
    again = gap & ((apart * time_step > _AWAY) | (away > leap * apart * time_step))
    gap &= ~again
    for kind, mask in ((GAP, gap), (RESTART, again)):
        if mask.any():
            row = int(mask.argmax())
            seconds = apart[row] * time_step
            example = f"{ids[row]} is not seen for {seconds:.1f} s"
            defects.append(Defect(kind, int(mask.sum()), example))
    track = np.cumsum(new | again) - 1
    starts = np.flatnonzero(new | again)
    names: list[str] = []
    for row in starts.tolist():
        name = str(ids[row])
        names.append(name if new[row] else f"{names[-1].partition('#')[0]}#{_part(names[-1])}")
    return tuple(names), track


def _part(name: str) -> int:
    """Return the number of the part of a track that follows the one of this name."""
    return int(name.partition("#")[2] or 1) + 1


def _differences(track: NDArray[np.int64], time: Array, position: Array) -> Array:
    """Return velocities (R, 2) [m/s] by central differences within each track."""
    velocity = np.zeros_like(position)
    bounds = np.flatnonzero(np.diff(track, prepend=-1, append=-1))
    for first, end in pairwise(bounds.tolist()):
        if end - first > 1:
            velocity[first:end] = np.gradient(position[first:end], time[first:end], axis=0)
    return velocity


def _directions(track: NDArray[np.int64], velocity: Array) -> Array:
    """Return the direction (R,) [rad] of the velocity; who stands keeps the last one."""
    heading = directions(velocity)
    moving = np.hypot(velocity[:, 0], velocity[:, 1]) > _TURNING
    series = pd.Series(np.where(moving, heading, np.nan)).groupby(track)
    held = series.ffill().groupby(track).bfill().to_numpy(dtype=np.float64)
    return np.where(np.isnan(held), heading, held)
