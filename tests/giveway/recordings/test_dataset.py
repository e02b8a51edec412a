"""Descriptions of data sets: rate, axes and bodies."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from giveway.errors import DatasetError
from giveway.validation import CITR, DUT, Protocol, dataset_of, read_clip, read_clips, validate
from giveway.validation.protocol import distance_to_bodies, vehicle_rows
from pedestrian_model import SIM


def test_the_distance_is_to_the_carts_own_body(tmp_path, write_clip, straight_walks) -> None:
    """1.0 m to the front, 1.2 m to the rear, 1.2 m wide, turned with its heading."""
    x, v = straight_walks(2, [[0, 3], [0, -3], [2, 0], [0.5, 0.5], [-1.6, 4.0]], [[0, 0]] * 5)
    heading_up = np.tile([0.0, 0.0, math.pi / 2, 1.0], (2, 1))
    clip = read_clip(write_clip(tmp_path, "drive_01", x, v, heading_up), CITR)
    distance = distance_to_bodies(clip.position, vehicle_rows(clip, Protocol()))[0]
    np.testing.assert_allclose(distance, [2.0, 1.8, 1.4, 0.0, math.hypot(1.0, 3.0)], atol=1e-12)


def test_a_description_of_ones_own_sets_rate_axis_and_body(tmp_path, write_clip, straight_walks):
    mine = tmp_path / "mine.toml"
    mine.write_text(
        'name = "MINE"\nframe_rate = 29.97\ny_axis = "up"\n'
        "[vehicle]\nfront = 3.0\nrear = 2.0\nwidth = 1.8\n"
    )
    x, v = straight_walks(80, [[-4, 1.6], [3, -2]], [[1, 0], [-1, 0.3]])
    write_clip(tmp_path, "drive_01", x, v, np.tile([0.0, 0.0, 0.0, 1.0], (80, 1)))
    (clip,) = read_clips(tmp_path, dataset_of(str(mine)))
    np.testing.assert_allclose(clip.position[:, :, 1], -x[:, :, 1], err_msg="y is not mirrored")
    found = validate([clip], SIM)
    assert found.protocol == Protocol(front=3.0, rear=2.0, width=1.8)
    assert found.cut[0].vehicles[0, 0, 4:].tolist() == [3.0, 2.0, 1.8]


def test_the_bundled_descriptions_keep_the_times_of_the_windows() -> None:
    assert Protocol.of(CITR) == Protocol()
    campus = Protocol.of(DUT)
    assert (campus.skip, campus.stride, campus.horizons) == (12, 12, (18, 48, 96))
    assert (campus.front + campus.rear, campus.width) == (4.5, 1.8)


def test_clips_of_two_data_sets_are_not_judged_together(tmp_path, write_clip, straight_walks):
    write_clip(tmp_path, "walk_01", *straight_walks(80, [[0, 0]], [[1, 0]]))
    (clip,) = read_clips(tmp_path, CITR)
    with pytest.raises(DatasetError, match="from the data sets CITR, DUT; expected"):
        validate([clip, replace(clip, dataset=DUT)], SIM)
