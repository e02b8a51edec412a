"""The roster: who is present, under which name, in which row."""

from __future__ import annotations

import numpy as np

from giveway.crowd.roster import Roster
from pedestrian_model import Crowd


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


def test_the_ledger_adds_up() -> None:
    roster = Roster(["own"], at(0.0))
    roster.take_in(["ann", "bob"], at(1.0, 2.0))
    roster.release(np.array([True, True, False]))
    roster.count("arrived")
    roster.count("continued")
    ledger = roster.ledger
    left = ledger["handed_back"] + ledger["arrived"] + ledger["continued"]
    assert ledger["added"] + ledger["taken_over"] == left + ledger["walking"] == 3
