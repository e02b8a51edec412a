"""The signals of people who walk at red for some time."""

from __future__ import annotations

import numpy as np

from giveway.crowd.red_walkers import RedWalkers


def test_each_time_has_signals_of_its_own() -> None:
    people = RedWalkers({"bold": 5.0, "late": 2.0, "also bold": 5.0}, signals=2, first=3)
    assert people
    assert people.size == 4
    route = np.array([-1, 0, 1, 2])  # the last is no light that everybody heeds
    assert people.signals_for("anybody", route).tolist() == route.tolist()
    assert people.signals_for("late", route).tolist() == [-1, 3, 4, 2]
    assert people.signals_for("bold", route).tolist() == [-1, 5, 6, 2]
    assert people.signals_for("also bold", route).tolist() == [-1, 5, 6, 2]


def test_red_is_open_until_its_time_is_over() -> None:
    people = RedWalkers({"bold": 5.0}, signals=2, first=2)
    closed = np.array([True, True, False, False])
    people.note(0, "r", 10.0)
    people.note(1, "y", 10.0)  # closed, but not red
    people.close(closed, 12.0)
    assert closed.tolist() == [True, True, False, True]
    people.close(closed, 15.0)
    assert closed.tolist() == [True, True, True, True]
    closed[0] = False
    people.note(0, "G", 20.0)
    people.close(closed, 20.0)
    assert closed.tolist() == [False, True, False, True]


def test_nobody_walks_at_red_by_default() -> None:
    people = RedWalkers({}, signals=2, first=2)
    assert not people
    assert people.size == 0
