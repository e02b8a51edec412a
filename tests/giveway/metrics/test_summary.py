"""The rows that users compare: one per pedestrian, one per run."""

from __future__ import annotations

import json
from dataclasses import asdict, fields
from math import nan

import numpy as np
import pandas as pd
import pytest

from controller import WorstMotion
from giveway.metrics import (
    PEDESTRIAN_FIELDS,
    SUMMARY_FIELDS,
    Anticipation,
    Critical,
    DriveSetting,
    Summary,
    summarise,
)

DT = 0.05
TIME = DT * np.arange(401)
NOBODY = pd.DataFrame(columns=[column.name for column in PEDESTRIAN_FIELDS], dtype=float)


def summary_of(track, table=NOBODY, critical=Critical(0, 0.0), **arguments):  # noqa: B008
    arguments = {"goal": 4.0, "safe_distance": 8.0, "controller": "mpc"} | arguments
    return summarise(track, table, critical, Anticipation(), DriveSetting(**arguments))


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
    never = {name for name, value in asdict(summary).items() if np.isnan(value)}
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
        "close_pass_share",
        "close_pass_share_moving",
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
            "clearance_moving": [0.4, -0.1, 4.1, nan],
            "clearance_above_1": [0.4, 0.2, nan, nan],
            "clearance_above_2": [0.45, 0.2, nan, nan],
            "clearance_above_3": [0.6, 0.29, nan, nan],
            "time_to_accident": [0.5, 0.3, 0.0, nan],
            "conflicting_speed": [4.0, 4.0, 0.4, nan],
        }
    )
    summary = summary_of(ego(TIME), table, Critical(3, 0.25))
    assert summary.minimum_clearance == -0.2
    assert (summary.frontal_contacts, summary.side_contacts) == (1, 1)
    assert (summary.people_below_ttc, summary.share_below_ttc) == (3, 0.25)
    assert summary.conflicts == 2
    assert (summary.people_near, summary.people_near_moving) == (3, 2)
    assert (summary.close_passes, summary.tight_passes, summary.narrow_passes) == (2, 1, 1)
    assert (summary.close_pass_share, summary.close_pass_share_moving) == (2 / 3, 1.0)
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
    row = asdict(summary_of(ego(TIME)))
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
