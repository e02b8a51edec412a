"""Tracks of a replay: thinned, and cut where somebody was away."""

from __future__ import annotations

import itertools

import numpy as np
import pandas as pd
import pytest

from giveway.replays.packed_tracks import Frame, pack_tracks, thinning


def walk(times: list[float], who: str) -> pd.DataFrame:
    """Somebody who walks along x at 1 m/s."""
    rows = {"time": times, "id": who, "x": times, "y": 0.0, "vx": 1.0, "vy": 0.0, "angle": 90.0}
    return pd.DataFrame(rows)


def numbers(text: str, dtype: str) -> list[float]:
    import base64

    return np.frombuffer(base64.b64decode(text), dtype).tolist()


def test_a_return_makes_two_tracks_and_far_people_stay_on() -> None:
    near = walk([0.0, 0.05, 0.1], "near")
    back = walk([0.0, 1.0, 8.0, 9.0], "back")
    rows = pd.concat([near, back]).sort_values("time", kind="stable", ignore_index=True)
    frame = Frame(0.0, 0.0, np.array([0.0, 0.05, 0.1, 1.0, 8.0, 9.0, 9.5]))
    tracks = pack_tracks(rows, frame, hold=0.05, gap=1.5, thin=0.0)
    assert sorted(tracks["names"]) == ["back", "near"]
    assert len(numbers(tracks["who"], "<u4")) == 3
    until = sorted(numbers(tracks["until"], "<f8"))
    assert until == pytest.approx([0.15, 1.05, 9.55])


def test_thinning_keeps_the_ends_of_tracks_and_far_people_whole() -> None:
    times = [round(0.05 * k, 6) for k in range(201)]
    rows = pd.concat([walk(times, "near"), walk([0.0, 1.0, 2.0, 3.0], "far")], ignore_index=True)
    assert thinning(rows, 0.05, most=1000) == 0.0
    thin = thinning(rows, 0.05, most=60)
    frame = Frame(0.0, 0.0, np.array(times))
    tracks = pack_tracks(rows, frame, hold=0.05, gap=1.5, thin=thin)
    start = [int(s) for s in numbers(tracks["start"], "<u4")]
    x = numbers(tracks["x"], "<i4")
    assert len(x) <= 60
    ends = sorted((x[a], x[b - 1], b - a) for a, b in itertools.pairwise(start))
    assert ends[0] == (0, 3000, 4)
    assert ends[1][:2] == (0, 10000)
