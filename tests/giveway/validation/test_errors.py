"""ADE, FDE and contacts, by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.validation import CITR, Protocol, read_clips, validate
from giveway.validation.intervals import ClipBootstrap
from giveway.validation.predictors import straight_to
from giveway.validation.protocol import windows
from pedestrian_model import SIM

if TYPE_CHECKING:
    import pandas as pd

DT = 1 / 29.97


def numbers(errors: pd.DataFrame, predictor: str, metric: str, subset: str = "all") -> list:
    rows = errors[(errors["predictor"] == predictor) & (errors["metric"] == metric)]
    return rows.loc[rows["subset"] == subset, "mean"].tolist()


def test_constant_velocity_is_exact_on_straight_tracks(
    tmp_path, write_clip, straight_walks
) -> None:
    x, v = straight_walks(180, [[0, 0], [3, 50]], [[1.2, 0.3], [-1.0, 0.0]])
    write_clip(tmp_path, "walk_01", x, v)
    errors = validate(read_clips(tmp_path, CITR), SIM).errors
    for predictor in ("CV", "goalCV"):
        for metric in ("ADE", "FDE"):
            assert numbers(errors, predictor, metric) == pytest.approx([0, 0, 0], abs=1e-9)


def test_a_velocity_that_is_wrong_by_so_much_gives_so_much_error(
    tmp_path, write_clip, straight_walks
) -> None:
    """0.1 m/s too fast: after h frames 0.1 h dt off, and on average 0.1 (h + 1)/2 dt."""
    x, v = straight_walks(180, [[0, 0]], [[1.0, 0.0]])
    write_clip(tmp_path, "walk_01", x, v + [0.1, 0.0])
    errors = validate(read_clips(tmp_path, CITR), SIM).errors
    h = np.array([22, 60, 120])
    assert numbers(errors, "CV", "FDE") == pytest.approx(0.1 * h * DT)
    assert numbers(errors, "CV", "ADE") == pytest.approx(0.1 * (h + 1) / 2 * DT)


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


def test_near_is_who_comes_near_within_the_horizon(tmp_path, write_clip, straight_walks) -> None:
    """The walker passes a standing cart 1 m beside it; the other stays 20 m away."""
    x, v = straight_walks(200, [[-4.0, 1.6], [-4.0, 20.0]], [[1.0, 0.0], [1.0, 0.0]])
    write_clip(tmp_path, "drive_01", x, v, np.tile([0.0, 0.0, 0.0, 0.0], (200, 1)))
    found = validate(read_clips(tmp_path, CITR), SIM)
    assert not found.found.near[1::2].any()
    assert found.found.near[::2].any()
    near = found.errors.query("subset == 'near' and metric == 'FDE' and predictor == 'CV'")
    assert near["count"].min() > 0
    assert near["mean"].tolist() == pytest.approx([0, 0, 0], abs=1e-9)


def test_a_cart_hits_constant_velocity_walkers_not_the_model(
    tmp_path, write_clip, straight_walks
) -> None:
    """The data step aside and back; constant velocity, and the model without f_v, do not."""
    frames = 240
    x, v = straight_walks(frames, [[10.0, 0.3]], [[-0.8, 0.0]])
    x[:, 0, 1] += 1.6 * np.exp(-(((np.arange(frames) - 190) / 30) ** 2))
    cart = np.zeros((frames, 4))
    cart[:, 0], cart[:, 3] = -8.0 + 2.0 * DT * np.arange(frames), 2.0
    write_clip(tmp_path, "drive_01", x, v, cart)
    contacts = validate(read_clips(tmp_path, CITR), SIM).contacts.set_index("predictor")
    assert contacts["pedestrians"].tolist() == [1] * 5
    touching = contacts["touching"].to_dict()
    assert touching["CV"] == 1
    assert touching["VCI"] == touching["data"] == 0
    assert touching["VCI without f_v"] == 1
    assert contacts.loc["CV", "closest"] == pytest.approx(-SIM.body_radius)


def test_clips_without_a_vehicle_have_no_contacts_and_none_near(
    tmp_path, write_clip, straight_walks
) -> None:
    x, v = straight_walks(180, [[0, 0]], [[1, 0]])
    write_clip(tmp_path, "walk_01", x, v)
    found = validate(read_clips(tmp_path, CITR), SIM)
    assert found.contacts.empty
    assert found.errors.query("subset == 'near'")["count"].sum() == 0


def test_the_interval_is_that_of_drawing_clips(straight_walks) -> None:
    """Three clips with means 1, 2 and 6 of 10, 10 and 20 people: no resample is beyond 1 or 6."""
    draws = ClipBootstrap.of(3)
    count = np.array([10.0, 10.0, 20.0])
    low, high = draws.interval(np.array([1.0, 2.0, 6.0]) * count, count)
    assert (low, high) == (1.0, 6.0)
    assert draws.interval(2.5 * count, count) == pytest.approx((2.5, 2.5))
    alone = draws.interval(np.array([5.0, 0.0, 0.0]), np.array([5.0, 0.0, 0.0]))
    assert np.isnan(alone).all(), "one clip tells nothing of other clips"


@given(
    position=st.tuples(*[st.floats(-50, 50)] * 2),
    goal=st.tuples(*[st.floats(-50, 50)] * 2),
    velocity=st.tuples(*[st.floats(-3, 3)] * 2),
)
def test_goal_cv_never_overshoots_and_keeps_its_speed(position, goal, velocity) -> None:
    x, p, v = (np.array([each]) for each in (position, goal, velocity))
    track = np.concatenate([x[None], straight_to(x, v, p, DT, 60)])[:, 0]
    left = np.hypot(*(track - p).T)
    assert (np.diff(left) <= 1e-9).all()
    assert (np.hypot(*np.diff(track, axis=0).T) <= np.hypot(*velocity) * DT + 1e-9).all()
