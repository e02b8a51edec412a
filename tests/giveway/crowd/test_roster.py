"""The population: who is present, under which name, in which row."""

from __future__ import annotations

import numpy as np

from giveway.population import Population
from pedestrian_model import Crowd


def at(*stations: float) -> Crowd:
    """People at these x [m] who walk on to x = 100 m."""
    n = len(stations)
    destination = [[(100.0, 0.0)]] * n
    return Crowd.create([(x, 0.0) for x in stations], np.zeros((n, 2)), 1.3, destination)


def test_who_comes_back_has_its_own_name_and_index_but_a_new_row() -> None:
    population = Population()
    population.take_in(["ann", "bob", "eve"], at(1.0, 2.0, 3.0))
    assert population.release(np.array([True, False, False])) == ["ann"]
    assert population.names == ["bob", "eve"]
    population.take_in(["ann"], at(9.0))
    assert population.names == ["bob", "eve", "ann"]  # not the order in which they first came
    assert population.present.tolist() == [1, 2, 0]
    assert [population.ids[i] for i in population.present] == population.names
    assert population.crowd.position[:, 0].tolist() == [2.0, 3.0, 9.0]


def test_the_ledger_adds_up() -> None:
    population = Population(["own"], at(0.0))
    population.take_in(["ann", "bob"], at(1.0, 2.0))
    population.release(np.array([True, True, False]))
    population.count("arrived")
    population.count("continued")
    ledger = population.ledger
    left = ledger["handed_back"] + ledger["arrived"] + ledger["continued"]
    assert ledger["added"] + ledger["taken_over"] == left + ledger["walking"] == 3
