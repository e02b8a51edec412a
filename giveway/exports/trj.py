"""The export for SSAM, the surrogate safety assessment model of the FHWA.

The file is binary: a record of the format, one of the dimensions, and one per instant, followed by
one per vehicle (Siemens, SSAM File Format v1.04, 2008). SSAM has no people. They are vehicles as
long and wide as a body, so that their conflicts with vehicles are found.
"""

import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from giveway.exports.sampling import PEDESTRIAN, Sampled, Track
from giveway.replays.run_folder import RunFolder

_VERSION = 1.04
_METRIC, _SCALE = 1, 1.0
_BODY = (0.54, 0.54)  # length and width [m] of people: twice the body radius of VCI
_CAR = (4.3, 1.8)  # length and width [m] of a vehicle of unknown size
_LINKS = {PEDESTRIAN: 2}  # numbers of links; vehicles are on link 1
_VEHICLE = np.dtype(
    [
        ("kind", "u1"),
        ("vehicle", "<i4"),
        ("link", "<i4"),
        ("lane", "u1"),
        *((name, "<f4") for name in ("front_x", "front_y", "rear_x", "rear_y")),
        *((name, "<f4") for name in ("length", "width", "speed", "acceleration")),
    ]
)


def write_trj(run: RunFolder, sampled: Sampled, file: Path) -> str:
    """Write a trajectory file for SSAM.

    Returns:
        The written file, in words.
    """
    bodies = [
        run.scene.body(track.object, _BODY if track.type == PEDESTRIAN else _CAR)
        for track in sampled.tracks
    ]
    rows = [
        _rows(number, track, body, sampled.step)
        for number, (track, body) in enumerate(zip(sampled.tracks, bodies, strict=True), start=1)
    ]
    x, y = (np.concatenate([row[name] for row in rows]) for name in ("front_x", "front_y"))
    low = np.floor((x.min(), y.min())).astype(int).tolist()
    high = np.ceil((x.max(), y.max())).astype(int).tolist()
    with file.open("wb") as out:
        out.write(struct.pack("<Bcf", 0, b"L", _VERSION))
        out.write(struct.pack("<BBf4i", 1, _METRIC, _SCALE, *low, *high))
        for index, numbers in enumerate(sampled.present):
            out.write(struct.pack("<Bf", 2, sampled.time(index)))
            for number in numbers:
                out.write(rows[number][index - sampled.tracks[number].first].tobytes())
    people = len(sampled.people())
    vehicles = f"{len(rows) - people} vehicles (link 1)"
    return f"{vehicles} and {people} people (link 2) every {sampled.step:g} s"


def _rows(number: int, track: Track, body: tuple[float, float], step: float) -> NDArray[np.void]:
    """Return the records (n,) of a track."""
    rows = np.zeros(len(track), dtype=_VEHICLE)
    length, width = body
    angle = np.radians(track.angle)
    ahead = length / 2.0 if track.type == PEDESTRIAN else 0.0  # a person's place is the centre
    rows["kind"], rows["vehicle"], rows["lane"] = 3, number, 1
    rows["link"] = _LINKS.get(track.type, 1)
    rows["front_x"], rows["front_y"] = (
        track.x + ahead * np.sin(angle),
        track.y + ahead * np.cos(angle),
    )
    rows["rear_x"], rows["rear_y"] = (
        track.x + (ahead - length) * np.sin(angle),
        track.y + (ahead - length) * np.cos(angle),
    )
    rows["length"], rows["width"], rows["speed"] = length, width, track.speed
    rows["acceleration"] = np.diff(track.speed, prepend=track.speed[:1]) / step
    return rows
