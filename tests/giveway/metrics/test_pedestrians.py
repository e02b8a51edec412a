"""The table of pedestrians: one row each."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from giveway.geometry.bodies import VehicleShape
from giveway.metrics import (
    PEDESTRIAN_FIELDS,
    pedestrian_metrics,
)
from giveway.run_data.tracks import CrowdTrack

CAR = VehicleShape(length=5.0, width=2.0)


R = 0.27


DT = 0.05


TIME = DT * np.arange(401)


def test_one_row_per_pedestrian(driving, crowd, walking):
    # At 4 m/s the bumper touches the circle at x = 20 after (20 - R) / 4 s and leaves it 5 m and
    # two radii later; beside the strip another one stands, 3 m from the ego's side.
    track = crowd((0, [(20.0, 0.0, 0.0, 0.0)] * 401), walking(TIME[:41], (10.0, 4.0), (1.2, 0.0)))
    table = pedestrian_metrics(driving(TIME, 4.0), track, CAR, R)
    assert list(table.columns) == [column.name for column in PEDESTRIAN_FIELDS]
    standing, walker = table.to_dict("records")

    assert standing["id"] == "ped0"
    assert (standing["first_seen"], standing["last_seen"]) == (0.0, pytest.approx(20.0))
    assert (standing["path_length"], standing["mean_speed"]) == (0.0, 0.0)
    assert standing["minimum_clearance"] == pytest.approx(-1.0 - R)
    assert standing["time_of_minimum_clearance"] == pytest.approx(5.25)  # both sides nearest then
    assert standing["minimum_ttc"] == 0.0
    assert standing["time_of_minimum_ttc"] == pytest.approx(4.95)
    assert standing["overlap_time"] == pytest.approx((5.0 + 2 * R) / 4.0, abs=DT)
    assert standing["post_encroachment_time"] == 0.0
    # The last instant before touching is t = 4.9 s, 0.4 m from the place of the circle's centre.
    assert standing["maximum_drac"] == pytest.approx(4.0**2 / (2 * (0.4 - R)))

    assert walker["id"] == "ped1"
    assert (walker["first_seen"], walker["last_seen"]) == (0.0, pytest.approx(2.0))
    assert walker["path_length"] == pytest.approx(2.4)
    assert walker["mean_speed"] == pytest.approx(1.2)
    closest = np.hypot(10.0 + 1.2 * 2.0 - 8.0, 3.0) - R
    assert walker["minimum_clearance"] == pytest.approx(closest)
    assert walker["time_of_minimum_clearance"] == pytest.approx(2.0)
    assert (walker["overlap_time"], walker["maximum_drac"]) == (0.0, 0.0)
    for never in ("minimum_ttc", "time_of_minimum_ttc", "post_encroachment_time"):
        assert np.isnan(walker[never])


def test_who_was_never_seen_has_an_empty_row(driving, crowd):
    track = crowd((5, []), (5, [(20.0, 3.0, 0.0, 0.0)]))
    never, once = pedestrian_metrics(driving(TIME, 4.0), track, CAR, R).to_dict("records")
    assert never.pop("id") == "ped0"
    assert never.pop("kind") == never.pop("group") == ""
    assert never.pop("contact") == ""
    assert never.pop("passed_first") == ""
    assert all(np.isnan(value) for value in never.values())
    assert once["first_seen"] == once["last_seen"] == pytest.approx(0.25)
    assert (once["path_length"], once["overlap_time"]) == (0.0, 0.0)
    assert np.isnan(once["mean_speed"])


def test_the_order_of_records_within_an_instant_does_not_matter(driving, crowd, walking):
    track = crowd(*(walking(TIME[:80], (12.0 + i, -3.0), (0.0, 1.3)) for i in range(4)))
    shuffle = np.lexsort((np.random.default_rng(1).random(track.x.size), track.step))
    columns = (track.step, track.pedestrian, track.x, track.y, track.vx, track.vy)
    shuffled = CrowdTrack(*(column[shuffle] for column in columns), ids=track.ids)
    ego = driving(TIME, 4.0)
    pd.testing.assert_frame_equal(
        pedestrian_metrics(ego, track, CAR, R), pedestrian_metrics(ego, shuffled, CAR, R)
    )


def test_columns_cut_from_a_wider_array_give_the_same(driving, crowd, walking):
    track = crowd(walking(TIME[:80], (12.0, -3.0), (0.0, 1.3)))
    wide = np.column_stack((track.x, track.y, track.vx, track.vy))
    cut = CrowdTrack(track.step.astype(np.int32), track.pedestrian, *wide.T, ids=track.ids)
    ego = driving(TIME, 4.0)
    pd.testing.assert_frame_equal(
        pedestrian_metrics(ego, track, CAR, R), pedestrian_metrics(ego, cut, CAR, R)
    )
