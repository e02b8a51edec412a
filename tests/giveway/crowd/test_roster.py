"""The roster: who is present, under which name, in which row."""

from __future__ import annotations

import numpy as np

from giveway.config.tables.crowd import CrowdConfig
from giveway.config.tables.people import PeopleConfig
from giveway.crowd.generation.spawn import spawn
from giveway.crowd.roster import Roster, Trait
from giveway.geometry.path import EgoPath
from pedestrian_model import OFF_WALKWAYS, Crowd


def at(*stations: float) -> Crowd:
    """People at these x [m] who walk on to x = 100 m."""
    n = len(stations)
    destination = [[(100.0, 0.0)]] * n
    return Crowd.create([(x, 0.0) for x in stations], np.zeros((n, 2)), 1.3, destination)


def test_who_comes_back_has_its_own_name_and_index_but_a_new_row() -> None:
    roster = Roster()
    roster.take_in(["ann", "bob", "eve"], at(1.0, 2.0, 3.0))
    assert roster.release(np.array([True, False, False])) == ["ann"]
    assert roster.names == ["bob", "eve"]
    roster.take_in(["ann"], at(9.0))
    assert roster.names == ["bob", "eve", "ann"]  # not the order in which they first came
    assert roster.person_ids.tolist() == [1, 2, 0]
    assert [roster.ids[i] for i in roster.person_ids] == roster.names
    assert roster.crowd.position[:, 0].tolist() == [2.0, 3.0, 9.0]


def test_walls_hold_those_who_were_added_only_if_asked_for() -> None:
    for walled, signal in ((True, -1), (False, OFF_WALKWAYS)):
        roster = Roster(["own"], at(0.0), walled=walled)
        roster.add(["later"], at(1.0), {})
        roster.take_in(["ann"], at(2.0))
        assert roster.crowd.waypoint_signal.tolist() == [signal, signal, -1]


def test_the_ledger_adds_up() -> None:
    roster = Roster(["own"], at(0.0))
    roster.take_in(["ann", "bob"], at(1.0, 2.0))
    roster.release(np.array([True, True, False]))
    roster.count("arrived")
    roster.count("continued")
    ledger = roster.ledger
    left = ledger["handed_back"] + ledger["arrived"] + ledger["continued"]
    assert ledger["added"] + ledger["taken_over"] == left + ledger["walking"] == 3


AXIS = EgoPath.through([(-20, 0), (100, 0)])


def test_mixed_people_stand_where_an_unmixed_crowd_does() -> None:
    mixed = spawn(CrowdConfig(pedestrians=40, people=PeopleConfig(elderly=0.5)), AXIS, 3)
    plain = spawn(CrowdConfig(pedestrians=40), AXIS, 3)
    assert np.array_equal(mixed.position, plain.position)
    assert set(mixed.kinds) == {"adult", "elderly"}
    assert plain.kinds == ("",) * 40
    assert plain.traits == {}
    assert mixed.traits["ped0"] == Trait(mixed.kinds[0], "")


def test_the_roster_knows_distracted_people_and_groups() -> None:
    crowd = Crowd.create([(0, 0), (1, 0), (2, 0)], [(0, 0)] * 3, 1.0, [[(9, 9)]] * 3)
    traits = {"a": Trait("distracted", "a"), "b": Trait("adult", "a")}
    roster = Roster(["a", "b", "c"], crowd, traits)
    assert roster.distracted.tolist() == [True, False, False]
    assert roster.groups.tolist() == [0, 0, -1]
    roster.release(np.array([True, False, False]))
    late = Crowd.create([(5, 5)], [(0, 0)], 1.0, [[(9, 9)]])
    roster.add(["d"], late, {"d": Trait("distracted")})
    assert roster.distracted.tolist() == [False, False, True]
    assert roster.groups.tolist() == [0, -1, -1]
