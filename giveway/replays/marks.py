"""Crossings and lights for the page: painted stripes, and the states of each stop line."""

from typing import Any

import numpy as np

from giveway.figures.road import bands
from giveway.replays.packed_tracks import Frame, packed
from giveway.replays.run_folder import RunFolder
from giveway.run_data.road_marks import SignalHead, shown

_DARK = "-"  # Letter of a light that is off or unknown


def pack_marks(run: RunFolder, frame: Frame) -> dict[str, Any]:
    """Return the paint of the crossings and the stop lines of the lights.

    Returns:
        ``ground`` and ``stripes``: four corners each, as ``x`` and ``y`` [mm]. ``heads``: ``x`` and
        ``y`` [mm] of the two ends of each, and ``times`` [s] from which on it shows its
        ``letters``, each one of G, y, r and - (unknown or off).
    """
    zebras, heads = run.scene.marks.zebras, run.scene.marks.heads
    ground = [corners for zebra in zebras for corners in bands(zebra, whole=True)]
    stripes = [corners for zebra in zebras for corners in bands(zebra)]
    told = [_changes(run, head) for head in heads]
    return {
        "ground": _corners(ground, frame),
        "stripes": _corners(stripes, frame),
        "heads": {
            **_corners([np.array(head.ends) for head in heads], frame),
            "times": [packed(times, np.float64) for times, _ in told],
            "letters": [letters for _, letters in told],
        },
    }


def _corners(shapes: list[Any], frame: Frame) -> dict[str, str]:
    points = np.concatenate(shapes) if shapes else np.empty((0, 2))
    return {"x": frame.across(points[:, 0]), "y": frame.up(points[:, 1])}


def _changes(run: RunFolder, head: SignalHead) -> tuple[list[float], str]:
    """Return the times [s] at which a stop line's signal changes, and the letters then."""
    times: list[float] = []
    letters = ""
    rows = run.signals
    if rows.empty:
        return times, letters
    mine = rows[rows["system"] == head.system]
    for time, state in zip(mine["time"], mine["state"], strict=True):
        letter = shown("".join(state[i] for i in head.links if 0 <= i < len(state))) or _DARK
        if letters[-1:] != letter:
            times.append(float(time))
            letters += letter
    return times, letters
