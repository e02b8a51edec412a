"""The pooled numbers of a campaign, their intervals and their bars."""

from __future__ import annotations

from math import nan

import campaign_table
import pytest
from campaign_table import MEASURES, pooled, tables
from drive_row import LOST

ROW = {
    "drive": "town, car, seed 1, mpc",
    "ending": "completed",
    "arrived": True,
    "sumo_arrived": True,
    "sumo_teleported": False,
    "time": 50.0,
    "sumo_time": 48.0,
    "ratio": 50.0 / 48.0,
    "driving_time": 50.0,
    "distance": 500.0,
    "person_near": False,
    "encounters": 0,
    "failures_to_yield": 0,
    "red_lights_run": 0,
    "stops_without_cause": 0,
    "frontal_contacts": 0,
    "side_contacts": 0,
    "acceleration_95": 1.5,
    "braking_95": 1.0,
    "lateral_95": 0.5,
    "rms_jerk": 0.9,
    "brakings": [],
    "take_over_felt": False,
    "stands": [],
    "gaps_at_rest": [2.2],
    "car_contacts": {},
    "slow_share": 0.1,
    "sumo_slow_share": 0.08,
    "over_limit": 0.0,
    "lost": dict.fromkeys(LOST, 1.0),
    "violations": [],
}
BRAKING = {"time": 3.0, "after": 3.0, "deceleration": 5.0, "speed": 9.0, "cause": "person"}


@pytest.fixture(autouse=True)
def _few_resamples(monkeypatch) -> None:
    monkeypatch.setattr(campaign_table, "RESAMPLES", 100)


def cells(rows: list[dict], name: str) -> list[str]:
    """Return value, interval, bar and verdict of a measure."""
    (line,) = (line for line in pooled(rows).splitlines() if line.startswith(f"| {name} |"))
    return [cell.strip() for cell in line.split("|")[2:-1]]


@pytest.mark.parametrize(
    ("change", "name", "verdict"),
    [
        ({}, "time over SUMO's, nobody near, median", "pass"),
        ({"ratio": 1.3}, "time over SUMO's, nobody near, median", "miss"),
        ({"brakings": [BRAKING]}, "hard brakings per drive", "miss"),
        ({"arrived": False, "ratio": nan}, "not arrived where SUMO arrives", "miss"),
        ({"car_contacts": {"x": "ego"}}, "contacts with cars, the ego's fault", "miss"),
        ({"car_contacts": {"x": "other"}}, "contacts with cars, the ego's fault", "pass"),
        ({"gaps_at_rest": [8.0]}, "gap at rest behind a car, median [m]", "miss"),
        ({"slow_share": 0.2}, "slow on free road, points over SUMO's", "miss"),
        ({"take_over_felt": True}, "taking over felt (> 3 m/s^2 in 2 s)", "miss"),
    ],
)
def test_a_bar_is_passed_or_missed(change, name, verdict) -> None:
    assert cells([ROW | change] * 4, name)[-1] == verdict


def test_people_near_do_not_count_for_the_bar_of_time() -> None:
    rows = [ROW, ROW | {"ratio": 2.0, "person_near": True}]
    assert cells(rows, "time over SUMO's, nobody near, 90 %")[0] == "1.04"
    assert cells(rows, "time over SUMO's, highest")[0] == "2.00"


def test_an_interval_covers_the_value_and_none_seen_is_not_none() -> None:
    rows = [ROW | {"ratio": 1.0 + 0.01 * i} for i in range(40)]
    value, interval, *_ = cells(rows, "time over SUMO's, median")
    low, high = map(float, interval.split(" to "))
    assert low < float(value) < high
    assert cells(rows, "red lights run")[:2] == ["0.00", "0.00 to 3.69"]
    assert cells(rows, "hard brakings per drive")[:2] == ["0.00", "0.00 to 0.09"]


def test_each_event_is_told_and_each_death() -> None:
    stand = {"time": 9.0, "duration": 5.0, "on": "crossing", "waits_for": "vehicle"}
    row = ROW | {"brakings": [BRAKING], "stands": [stand], "violations": ["7 s, red light"]}
    text = tables([row, {"drive": "town, bus", "failed": "SIGSEGV"}])
    assert "5.0 m/s^2 from 9.0 m/s, 3.0 s after the departure, for: person" in text
    assert "stand: 5.0 s on a crossing, waits for: vehicle" in text
    assert "town, car, seed 1, mpc: 7 s, red light" in text
    assert "town, bus: died: SIGSEGV" in text
    assert "1 drives, 0.5 km, 1 with nobody near; 1 died" in text


def test_another_state_of_the_repository_stands_beside_it() -> None:
    slower = [ROW | {"ratio": 1.2, "rms_jerk": 2.0}, {"drive": "x", "failed": "SIGSEGV"}]
    lines = tables([ROW], slower, brief=True).splitlines()
    (time,) = (line for line in lines if line.startswith("| time over SUMO's, highest |"))
    assert time.split("|")[-2].strip() == "1.20"
    (jerk,) = (line for line in lines if line.startswith("| RMS jerk"))
    assert [cell.strip() for cell in jerk.split("|")][2::4] == ["0.90", "2.00"]


def test_the_times_of_pairs_are_compared() -> None:
    rows = [ROW | {"drive": f"car {i}", "time": 60.0} for i in range(4)]
    before = [row | {"time": 50.0} for row in rows[:3]] + [rows[3] | {"arrived": False}]
    said = "time over before, 3 pairs: 1.2000 (1.2000 to 1.2000)"
    assert tables(rows, before, brief=True).splitlines()[-1] == said
    assert "pairs" not in tables(rows, brief=True)


def test_without_any_drive_there_are_no_numbers() -> None:
    assert pooled([]).count("| - |") >= len(MEASURES) // 2
