"""The rows that users compare: one per pedestrian, one per run."""

from __future__ import annotations

import json
from dataclasses import fields
from math import nan

import numpy as np
import pandas as pd
import pytest

from controller import WorstMotion
from giveway.geometry.bodies import VehicleShape
from giveway.metrics import (
    PEDESTRIAN_FIELDS,
    SUMMARY_FIELDS,
    Anticipation,
    Critical,
    Summary,
    pedestrian_metrics,
    summarise,
    waiting_times,
)
from giveway.run_data.tracks import CrowdTrack

CAR = VehicleShape(length=5.0, width=2.0)
R = 0.27
DT = 0.05
TIME = DT * np.arange(401)
NOBODY = pd.DataFrame(columns=[column.name for column in PEDESTRIAN_FIELDS], dtype=float)


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


@pytest.mark.parametrize(
    ("case", "speed", "expected"),
    [
        ("never stands", [4, 3, 2, 1, 0.2, 1], []),
        ("stands once", [4, 0.1, 0.0, 0.19, 1, 2], [1.5]),
        ("stands twice", [0.0, 1, 0.0, 0.0, 1, 2], [0.5, 1.0]),
        ("stands to the end", [4, 3, 2, 0.0, 0.0, 0.0], [1.0]),
        ("stands all the time", [0.0] * 6, [2.5]),
    ],
)
def test_one_uninterrupted_stop_is_one_waiting_time(ego, case, speed, expected):
    track = ego(0.5 * np.arange(6), speed=np.array(speed, dtype=float))
    assert waiting_times(track) == pytest.approx(expected), case


def summary_of(track, table=NOBODY, critical=Critical(0, 0.0), **arguments):  # noqa: B008
    arguments = {"goal": 4.0, "safe_distance": 8.0, "controller": "mpc"} | arguments
    return summarise(track, table, critical, Anticipation(), **arguments)


@pytest.mark.parametrize(
    ("case", "near", "without_cause"),
    [
        ("nobody", {}, 2),
        ("somebody far ahead", {"gap": 16.0}, 2),
        ("somebody", {"gap": 15.0}, 0),
        ("a vehicle", {"vehicle_gap": 9.0}, 0),
        ("a red light", {"stop_gap": 2.0}, 0),
    ],
)
def test_a_hard_brake_has_a_cause_if_something_is_near_in_front(ego, case, near, without_cause):
    acceleration = np.zeros(60)
    acceleration[10:14] = -4.1
    acceleration[17] = -5.0  # 0.2 s later: the same brake
    acceleration[40] = -4.1
    acceleration[50] = -4.0  # not harder than 4 m/s^2
    fields = {name: np.full(60, value) for name, value in near.items()}
    track = ego(0.05 * np.arange(60), acceleration=acceleration, **fields)
    summary = summary_of(track)
    assert summary.hard_brakes == 2, case
    assert summary.hard_brakes_without_cause == without_cause, case


def test_the_summary_of_a_drive(ego):
    time = 2.0 + 0.5 * np.arange(5)
    track = ego(
        time,
        np.column_stack(([0.0, 2.0, 3.0, 3.0, 4.0], np.zeros(5))),
        speed=np.array([4.0, 2.0, 0.0, 0.1, 2.0]),
        acceleration=np.array([0.0, -4.0, -4.0, 0.0, 4.0]),
        gap=np.array([np.inf, 9.0, 6.0, 8.0, np.inf]),
        controller=np.array(["mpc", "mpc", "pid", "safety", "mpc"]),
    )
    summary = summary_of(track)
    assert summary.completed
    assert summary.completion_time == summary.simulated_time == 2.0
    assert (summary.travelled_distance, summary.mean_speed, summary.maximum_speed) == (4, 2, 4)
    assert (summary.stops, summary.longest_wait, summary.total_wait) == (1, 1.0, 1.0)
    assert summary.peak_deceleration == 4.0
    assert summary.rms_jerk == pytest.approx(np.sqrt((8**2 + 0 + 8**2 + 8**2) / 4))
    assert summary.peak_jerk == 8.0
    assert summary.mpc_feasibility_rate == 0.6
    assert summary.safety_share == 0.2
    assert summary.minimum_gap == 6.0
    assert summary.share_below_safe_distance == 0.2  # 8.0 m is not below 8 m


def test_the_goal_is_reached_between_two_instants(ego):
    places = np.column_stack(([0.0, 2.0, 3.0, 3.0, 4.0], np.zeros(5)))
    track = ego(2.0 + 0.5 * np.arange(5), places)
    assert summary_of(track, goal=3.25).completion_time == 1.625
    assert summary_of(track, goal=2.0).completion_time == 0.5
    assert not summary_of(track, goal=4.001).completed


def test_what_never_occurred_is_empty(ego):
    summary = summary_of(ego(TIME), goal=1e9, controller="pid")
    never = {name for name, value in summary.as_dict().items() if np.isnan(value)}
    assert never == {
        "beyond_assumption",
        "contacts_beyond",
        "completion_time",
        "mpc_feasibility_rate",
        "minimum_gap",
        "minimum_clearance",
        "minimum_ttc",
        "minimum_ttc_moving",
        "minimum_pet",
        "share_below_pet",
        "share_below_pet_person_first",
        "maximum_drac",
        "ttc_at_slowing",
    }
    assert (summary.overlaps, summary.overlap_time) == (0, 0.0)


def test_the_summary_of_the_crowd(ego):
    table = pd.DataFrame(
        {
            "minimum_clearance": [0.4, -0.1, -0.2, nan],
            "overlap_time": [0.0, 0.1, 0.3, nan],
            "contact": ["", "side", "frontal", ""],
            "minimum_ttc": [1.5, 0.0, nan, nan],
            "post_encroachment_time": [nan, 0.0, 0.8, nan],
            "passed_first": ["", "contact", "person", ""],
            "maximum_drac": [2.0, 3.5, 0.0, nan],
        }
    )
    summary = summary_of(ego(TIME), table, Critical(3, 0.25))
    assert summary.minimum_clearance == -0.2
    assert (summary.frontal_contacts, summary.side_contacts) == (1, 1)
    assert (summary.conflicts, summary.share_below_ttc) == (3, 0.25)
    assert (summary.overlaps, summary.overlap_time) == (2, pytest.approx(0.4))
    assert (summary.minimum_ttc, summary.minimum_pet, summary.maximum_drac) == (0.0, 0.0, 3.5)
    assert summary.share_below_pet == 0.5  # of all four, met or not
    assert summary.share_below_pet_person_first == 0.25


def test_the_summary_of_a_single_instant(ego):
    summary = summary_of(ego(TIME[:1], speed=0.0))
    assert summary.simulated_time == 0.0
    assert (summary.stops, summary.total_wait) == (1, 0.0)
    assert np.isnan([summary.mean_speed, summary.rms_jerk, summary.peak_jerk]).all()


def test_an_empty_track_is_refused(ego):
    with pytest.raises(ValueError, match="no instants"):
        summary_of(ego(TIME[:0]))


def test_the_summary_is_plain_python_in_the_documented_order(ego):
    row = summary_of(ego(TIME)).as_dict()
    assert list(row) == [column.name for column in SUMMARY_FIELDS]
    assert {type(value) for value in row.values()} == {bool, int, float}
    assert json.loads(json.dumps(row))["stops"] == 1


def test_every_column_says_what_it_means():
    assert [column.name for column in SUMMARY_FIELDS] == [field.name for field in fields(Summary)]
    for column in (*SUMMARY_FIELDS, *PEDESTRIAN_FIELDS):
        assert column.type in {"boolean", "integer", "number", "string"}
        assert column.description
        assert column.unit != ""
    units = {column.name: column.unit for column in (*PEDESTRIAN_FIELDS, *SUMMARY_FIELDS)}
    assert (units["post_encroachment_time"], units["rms_jerk"], units["id"]) == ("s", "m/s^3", None)


def test_assumption_violations_and_their_contacts_are_counted(ego):
    table = pd.DataFrame(
        {name: np.full(4, np.nan) for name in NOBODY.columns}
        | {"contact": ["frontal", "frontal", "", "side"]}
        | {"peak_acceleration": [2.0, 4.0, 3.0000001, 3.5]}
    )
    track = ego(0.5 * np.arange(6), speed=np.full(6, 4.0))
    found = summary_of(track, table, people=WorstMotion(3.0, 3.3))
    assert (found.beyond_assumption, found.contacts_beyond) == (2.0, 1.0)
    assert found.frontal_contacts == 2
    without = summary_of(track, table)
    assert np.isnan(without.beyond_assumption)
    assert np.isnan(without.contacts_beyond)
