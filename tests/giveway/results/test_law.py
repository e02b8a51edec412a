"""The law's tables, other egos as vehicles, and the note that names violations."""

from dataclasses import replace

import numpy as np
from support.crossing_world import SHAPE, ego, traffic

from giveway.geometry.bodies import VehicleShape
from giveway.journal.recorded import RecordedEgo
from giveway.metrics.law import Event
from giveway.results.law import ledger_table, others_of, people_table, remark
from giveway.run_data.columns import LEDGER_COLUMNS
from giveway.run_data.scene import SCENE_FILE, Scene
from giveway.run_data.tracks import PeopleTrack
from giveway.run_data.way import CrossingOnWay, EgoWay, StopLine

MET = Event(3.0, "encounter", False, "ped0", ":c0", 1.0, 2.0, 0.5, "s", "met")
FAILED = Event(4.0, "failure to yield", True, "ped0", ":c0", 1.0, 2.0, 0.5, "s", "too early")
RED = Event(2.0, "red light", True, "tls", "3", 1.0, 2.0, 0.5, "s", "red")


def test_the_note_counts_violations_and_tells_of_the_first():
    assert remark("ego", ()) == ""
    text = remark("ego", (FAILED, replace(FAILED, time=9.0), RED))
    assert "ego 'ego'" in text
    assert "2 x failure to yield, 1 x red light" in text
    assert "at 4.00 s (too early)" in text
    assert "ledger.csv" in text


def test_the_events_of_all_egos_stand_in_order_of_time():
    table = ledger_table([("one", MET), ("one", FAILED), ("two", RED)])
    assert list(table.columns) == [column.name for column in LEDGER_COLUMNS]
    assert list(table["ego"]) == ["two", "one", "one"]
    assert list(table["violation"]) == [True, False, True]
    assert list(ledger_table([]).columns) == list(table.columns)


def test_other_egos_are_vehicles_like_any_but_oneself_is_none():
    one, two = ego((0.2, 0.0)), ego((0.1, 0.0), front=50.0)
    long = VehicleShape(12.0, 2.5)
    egos = [
        RecordedEgo("one", SHAPE, 99.0, 0, one, None),
        RecordedEgo("two", long, 99.0, 0, two, None),
    ]
    background = traffic([("car", [0.0, 0.1], [9.0, 9.5], 0.0, 0.0)])
    seen = others_of(egos[0], egos, background)
    assert seen.time.tolist() == sorted(seen.time.tolist())
    assert set(seen.id) == {"car", "two"}
    assert set(seen.length[seen.id == "two"]) == {12.0}
    assert seen.x[seen.id == "two"].tolist() == two.front_x.tolist()
    assert others_of(egos[0], egos[:1], background) is background


def test_the_places_of_each_way_are_numbered():
    step, who = np.array([0, 0, 0, 0, 7]), np.array([1, 1, 2, 2, 1])
    track = PeopleTrack(step, who, np.ones(5), np.arange(5.0), np.zeros(5))
    table = people_table(np.arange(10) / 10, track, ["a", "b", "c"])
    assert list(table["id"]) == ["b", "b", "c", "c", "b"]
    assert list(table["number"]) == [0, 1, 0, 1, 0]
    assert list(table["time"]) == [0.0, 0.0, 0.0, 0.0, 0.7]


def test_a_scene_keeps_the_ways_if_there_are_any(tmp_path):
    place = CrossingOnWay(":c0", ((0.0, 1.0), (0.0, 8.0)), 4.0, True, "", -1)
    way = EgoWay("ego", ((0.0, 0.0), (9.0, 0.0)), 2.0, (place,), (StopLine(4.0, "tls", 0),))
    scene = Scene((((0.0, 0.0), (1.0, 1.0)),), {"ego": (5.0, 2.0)}, (way,))
    (tmp_path / SCENE_FILE).write_text(scene.to_json(), encoding="utf-8")
    assert Scene.read(tmp_path) == scene
    assert "ways" not in Scene((), {}).to_json()
