"""Positions packed for the page: one track per uninterrupted presence, millimetres in base64.

As JSON lists, the numbers would be four times as large.
"""

from __future__ import annotations

import base64
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import DTypeLike, NDArray

from giveway.geometry.kernel import Array
from giveway.replays.run_folder import RunFolder

MILLIMETRES = 1000.0  # millimetres per metre
MOST_SAMPLES = 700_000  # Largest number of samples of all tracks: 17 MB of the page
MOST_PREDICTED = 250_000  # Largest number of predicted positions: 3 MB
_LONGEST_GAP = 10.0  # Longest gap [s] over which positions are interpolated
# Possible windows [steps] for one sample
_WINDOWS = (2, 3, 4, 5, 8, 10, 15, 20, 30, 40, 60, 100, 200, 500, 1000)


def packed(values: Any, dtype: DTypeLike) -> str:
    """Return an array as base64 of its little-endian bytes."""
    array = np.ascontiguousarray(values, dtype=np.dtype(dtype).newbyteorder("<"))
    return base64.b64encode(array.tobytes()).decode("ascii")


@dataclass(frozen=True)
class Frame:
    """The frame of the page's coordinates: integers in it stay small.

    x, y: Origin of the page's coordinates in the network [m].
        x, y: Its origin in the network [m].
        time: All instants (T,) [s]; a sample has the index of its instant.
    """

    x: float
    y: float
    time: Array

    @classmethod
    def of(cls, run: RunFolder) -> Frame:
        """Return the frame of a run, with its origin near the middle of all positions."""
        places = run.trajectories if len(run.trajectories) else run.ego
        middle = [round((places[axis].min() + places[axis].max()) / 2.0) for axis in ("x", "y")]
        return cls(float(middle[0]), float(middle[1]), run.time)

    def across(self, x: Any) -> str:
        """Return x coordinates [m], packed as millimetres."""
        return packed(np.round((np.asarray(x, dtype=np.float64) - self.x) * MILLIMETRES), np.int32)

    def up(self, y: Any) -> str:
        """Return y coordinates [m], packed as millimetres."""
        return packed(np.round((np.asarray(y, dtype=np.float64) - self.y) * MILLIMETRES), np.int32)

    def index(self, time: Any) -> NDArray[np.int64]:
        """Return the index of each instant."""
        return np.searchsorted(self.time, np.asarray(time, dtype=np.float64) - 1e-9)


def pack_tracks(
    rows: pd.DataFrame, frame: Frame, *, hold: float, gap: float, thin: float
) -> dict[str, Any]:
    """Return the rows of pedestrians, or of vehicles, as tracks.

    Args:
        rows: Rows of ``trajectories.csv``.
        frame: Coordinate frame of the page.
        hold: Time [s] for which an object stays in sight after its last row.
        gap: Time [s] without a row after which an object was away.
        thin: Time [s] of which one sample is kept; 0 keeps all.

    Returns:
        ``names``, each once; for each track ``who`` (index of the name), ``start`` (index of its
        first sample) and ``until`` [s]; for each sample ``frame``, ``x``, ``y`` [mm], ``vx``,
        ``vy`` [cm/s], ``angle`` [1/65536 turns].
    """
    codes, names = pd.factorize(rows["id"], sort=False)
    order = np.lexsort((rows["time"].to_numpy(), codes))
    who, time = codes[order], rows["time"].to_numpy(dtype=np.float64)[order]
    apart = np.diff(time, prepend=time[:1])
    first = np.diff(who, prepend=-1) != 0
    first |= apart > gap
    last = np.append(first[1:], True)[: len(first)]
    until = _until(time, apart, first, last, hold, gap, float(frame.time[-1]))
    kept = _sparse(time, first, last, thin)
    picked = order[kept]
    columns = {name: rows[name].to_numpy()[picked] for name in ("x", "y", "vx", "vy", "angle")}
    start = np.append(np.flatnonzero(first[kept]), len(picked))
    speeds = {axis: np.clip(columns[axis] * 100.0, -32767, 32767) for axis in ("vx", "vy")}
    return {
        "names": [str(name) for name in names],
        "who": packed(who[first], np.uint32),
        "start": packed(start, np.uint32),
        "until": packed(until, np.float64),
        "frame": packed(frame.index(time[kept]), np.uint32),
        "x": frame.across(columns["x"]),
        "y": frame.up(columns["y"]),
        "vx": packed(np.round(speeds["vx"]), np.int16),
        "vy": packed(np.round(speeds["vy"]), np.int16),
        "angle": packed(np.mod(np.round(columns["angle"] / 360.0 * 65536.0), 65536), np.uint16),
    }


def _until(
    time: Array,
    apart: Array,
    first: NDArray[np.bool_],
    last: NDArray[np.bool_],
    hold: float,
    gap: float,
    end: float,
) -> Array:
    """Return the time [s] until which each track is in sight.

    Distant pedestrians are recorded only from time to time, so that the end of their presence is
    not known. A pedestrian who was recorded shortly before the run's end is shown until then.
    """
    ends = time[last]
    seldom = (apart[last] > 1.5 * hold) | first[last]
    return np.where(seldom & (end - ends <= gap), end, ends) + hold


def _sparse(
    time: Array, first: NDArray[np.bool_], last: NDArray[np.bool_], thin: float
) -> NDArray[np.bool_]:
    """Select the samples to keep: both ends of each track, and one in every ``thin`` seconds."""
    if not thin:
        return np.ones(len(time), dtype=np.bool_)
    window = np.floor(time / thin + 1e-9)
    kept: NDArray[np.bool_] = first | last | (np.diff(window, prepend=window[:1]) != 0)
    return kept


def thinning(rows: pd.DataFrame, step: float, most: int = MOST_SAMPLES) -> float:
    """Return the time [s] between samples that leaves about ``most`` of them, or 0 to keep all."""
    if len(rows) <= most:
        return 0.0
    codes, _ = pd.factorize(rows["id"], sort=False)
    time = rows["time"].to_numpy(dtype=np.float64)
    order = np.lexsort((time, codes))
    who, time = codes[order], time[order]
    first = np.diff(who, prepend=-1) != 0
    for steps in _WINDOWS:
        if _sparse(time, first, first, steps * step).sum() <= most:
            return steps * step
    return _WINDOWS[-1] * step


def longest_gap(run: RunFolder) -> float:
    """Return the longest gap [s] between rows that does not mean that the object was away."""
    period = min(run.config.record.longest_period, _LONGEST_GAP)
    return 1.5 * max(period, run.step, run.sumo_step)


def pack_predictions(table: pd.DataFrame, frame: Frame) -> dict[str, Any]:
    """Return the predictions of one ego: an entry per instant, with its predicted positions."""
    instants, counts = np.unique(frame.index(table["time"]), return_counts=True)
    every = max(1, -(-len(table) // MOST_PREDICTED))
    if every > 1:
        table = table[np.isin(frame.index(table["time"]), instants[::every])]
        instants, counts = instants[::every], counts[::every]
    looks = np.unique(table["look_ahead"].to_numpy(dtype=np.float64))
    return {
        "looks": [round(float(look), 6) for look in looks],
        "frame": packed(instants, np.uint32),
        "start": packed(np.concatenate([[0], np.cumsum(counts)]), np.uint32),
        "look": packed(np.searchsorted(looks, table["look_ahead"].to_numpy()), np.uint8),
        "x": frame.across(table["x"]),
        "y": frame.up(table["y"]),
        "every": every,
    }
