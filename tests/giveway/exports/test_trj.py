"""SSAM reads people and vehicles with their sizes, where they were."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.exports.sampling import PEDESTRIAN, sampled
from giveway.exports.trj import write_trj

if TYPE_CHECKING:
    from pathlib import Path

RECORD = struct.Struct("<iiB8f")  # after the byte of its kind


def read(content: bytes) -> tuple[tuple, dict[float, list[tuple]]]:
    """Return the dimensions and the vehicles by time, as the format's description reads."""
    assert content[:2] == b"\x00L"
    assert struct.unpack_from("<f", content, 2)[0] == pytest.approx(1.04)
    kind, units, scale, *box = struct.unpack_from("<BBf4i", content, 6)
    assert (kind, units, scale) == (1, 1, 1.0)
    at, found, time = 6 + 22, {}, None
    while at < len(content):
        kind, at = content[at], at + 1
        if kind == 2:
            (time,) = struct.unpack_from("<f", content, at)
            found[round(time, 3)], at = [], at + 4
        else:
            assert kind == 3
            found[round(time, 3)].append(RECORD.unpack_from(content, at))
            at += RECORD.size
    return tuple(box), found


def test_everybody_is_where_they_were(run, tmp_path: Path) -> None:
    samples = sampled(run)
    file = tmp_path / "run.trj"
    told = write_trj(run, samples, file)
    box, found = read(file.read_bytes())
    assert len(found) == samples.count
    people = {n for n, track in enumerate(samples.tracks, start=1) if track.type == PEDESTRIAN}
    assert f"{len(people)} people (link 2)" in told
    seen = set()
    for index, rows in enumerate(found.values()):
        for number, link, lane, fx, fy, rx, ry, length, width, speed, _ in rows:
            track = samples.tracks[number - 1]
            k = index - track.first
            assert (link, lane) == (2 if number in people else 1, 1)
            assert np.hypot(fx - rx, fy - ry) == pytest.approx(length, abs=2e-3)
            x, y = ((fx + rx) / 2, (fy + ry) / 2) if number in people else (fx, fy)
            assert (x, y) == pytest.approx((track.x[k], track.y[k]), abs=2e-3)
            assert speed == pytest.approx(track.speed[k], abs=1e-4)
            assert (length, width) == pytest.approx((0.54, 0.54)) or number not in people
            assert box[0] <= fx <= box[2]
            assert box[1] <= fy <= box[3]
            seen.add(number)
    assert seen == set(range(1, len(samples.tracks) + 1))


def test_accelerations_are_differences_of_speeds(run, tmp_path: Path) -> None:
    samples = sampled(run)
    file = tmp_path / "run.trj"
    write_trj(run, samples, file)
    _, found = read(file.read_bytes())
    rows = [row for rows in found.values() for row in rows if row[0] == 1]
    speeds, accelerations = np.array([(row[9], row[10]) for row in rows]).T
    assert accelerations[1:] == pytest.approx(np.diff(speeds) / samples.step, abs=1e-3)
