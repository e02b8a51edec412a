"""The positions of people along the way ahead, and their motion across it."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller import Observation
from controller.reference_drivers.people_ahead import SIGHT, PeopleAhead, people_ahead


class Circle:
    """A way along a circle of 30 m to the left, from the origin along +x."""

    radius = 30.0

    def remaining(self) -> float:
        return 100.0

    def poses(self, distances: np.ndarray) -> np.ndarray:
        angle = distances / self.radius
        x, y = np.sin(angle), 1.0 - np.cos(angle)
        return np.column_stack([self.radius * x, self.radius * y, angle])


def seen(position: np.ndarray, velocity: np.ndarray) -> PeopleAhead:
    people = SimpleNamespace(position=position, velocity=velocity)
    found = people_ahead(Observation(0.0, 4.0, np.inf, np.empty(0), path=Circle(), people=people))
    assert found is not None
    return found


def beside(station: float, left: float) -> np.ndarray:
    """The place (1, 2) that is ``left`` [m] of the way at a station [m]."""
    angle, r = station / Circle.radius, Circle.radius - left
    return np.array([[r * np.sin(angle), Circle.radius - r * np.cos(angle)]])


@given(st.floats(1.0, SIGHT - 1.0), st.floats(-4.0, 4.0))
def test_in_a_bend_distances_count_along_the_way(station: float, left: float) -> None:
    found = seen(beside(station, left), np.zeros((1, 2)))
    assert found.distance[0] == pytest.approx(station, abs=0.1)
    assert found.aside[0] == pytest.approx(abs(left), abs=0.01)
    assert found.in_sight.all()


@pytest.mark.parametrize("left", [-2.0, 2.0])
def test_towards_the_way_is_positive_from_either_side(left: float) -> None:
    place = beside(12.0, left)
    inwards = beside(12.0, 0.0) - place
    found = seen(place, inwards / abs(left))
    assert found.towards[0] == pytest.approx(1.0, abs=1e-3)
    away = seen(place, -inwards / abs(left))
    assert away.towards[0] == pytest.approx(-1.0, abs=1e-3)


def test_behind_or_far_ahead_is_out_of_sight() -> None:
    places = np.concatenate([np.array([[-3.0, 0.0]]), beside(SIGHT + 2.0, 0.0)])
    assert seen(places, np.zeros((2, 2))).in_sight.tolist() == [False, False]


def test_without_a_way_or_people_there_is_nothing() -> None:
    assert people_ahead(Observation(0.0, 4.0, np.inf, np.empty(0))) is None
