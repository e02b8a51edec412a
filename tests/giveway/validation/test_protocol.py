"""The protocol: windows, and who counts in them."""

from __future__ import annotations

import numpy as np

from giveway.validation import CITR, Protocol, read_clips, validate
from giveway.validation.protocol import windows
from pedestrian_model import SIM


def test_windows_begin_every_15_frames_after_the_first_15(
    tmp_path, write_clip, straight_walks
) -> None:
    x, v = straight_walks(100, [[0, 0]], [[1, 0]])
    write_clip(tmp_path, "walk_01", x, v)
    clips = read_clips(tmp_path, CITR)
    cut = windows(clips, Protocol())
    assert [w.frame for w in cut] == [15, 30, 45, 60, 75]
    seen = [int((~np.isnan(w.observed[:, 0, 0])).sum()) for w in cut]
    assert seen == [84, 69, 54, 39, 24], "the last is seen for 22 frames, not for 60"
    counts = validate(clips, SIM).errors.query("subset == 'all' and metric == 'ADE'")
    assert counts.groupby("horizon")["count"].first().tolist() == [5, 2, 0]


def test_who_is_lost_on_the_way_does_not_count_from_there_on(
    tmp_path, write_clip, straight_walks
) -> None:
    x, v = straight_walks(60, [[0, 0], [0, 4]], [[1, 0], [1, 0]])
    x[30:33, 1] = np.nan  # lost for three frames
    write_clip(tmp_path, "walk_01", x, v)
    cut = windows(read_clips(tmp_path, CITR), Protocol())
    first = cut[0].observed
    assert np.isnan(first[14:, 1]).all()
    assert not np.isnan(first[:14, 1]).any()
