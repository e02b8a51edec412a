"""The measures of behaviour on made-up tracks, whose values are known."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.validation.behaviour.measures import (
    ACCELERATION,
    CLEARANCE,
    ENCROACHMENT,
    EVASION,
    NEIGHBOUR,
    SPEED,
    behaviour_of,
    near_vehicles,
    together,
)

TIME = np.arange(100) / 10.0


def along(y: float, speed: float = 0.0, x: float = 0.0) -> np.ndarray:
    """Return the track of somebody who walks along the road."""
    return np.column_stack([x + speed * TIME, np.full(100, y)])


def measured(recording):
    return behaviour_of(recording, near_vehicles(recording))


def test_clearance_is_from_outline_to_outline(recording) -> None:
    found = measured(recording(along(1.57), along(4.0), along(9.0)))
    assert found.samples[CLEARANCE.name].value == pytest.approx([0.4, 2.83], abs=1e-6)
    assert found.pairs.tolist() == [1, 1, 0]
    assert found.close.tolist() == [1, 0, 0]
    assert found.contact.tolist() == [False] * 3


def test_who_stands_in_the_way_is_touched(recording) -> None:
    found = measured(recording(along(1.0), along(3.0)))
    assert found.contact.tolist() == [True, False]
    assert found.samples[ENCROACHMENT.name].value.tolist() == [0.0]


def test_nobody_is_near_a_vehicle_that_stands(recording) -> None:
    found = measured(recording(along(1.57), car_speed=0.0))
    assert found.pairs.tolist() == [0]
    assert all(len(each.value) == 0 for each in found.samples.values())


def test_a_slow_vehicle_passes_nobody_closely(recording) -> None:
    found = measured(recording(along(1.57), car_speed=1.9))
    assert found.pairs.tolist() == [1]
    assert found.close.tolist() == [0]


def test_evasion_is_the_largest_distance_from_the_line(recording) -> None:
    bend = np.column_stack([0.2 * TIME, 2.0 + np.interp(TIME, [0.0, 4.0, 9.9], [0.0, 0.6, 0.0])])
    found = measured(recording(bend, along(2.0, 0.3)))
    assert found.samples[EVASION.name].value == pytest.approx([0.6, 0.0], abs=1e-9)


def test_the_sign_of_the_time_says_who_was_first(recording) -> None:
    ahead = np.column_stack([0.0 * TIME, 1.5 * (TIME - 2.0)])
    after = np.column_stack([0.0 * TIME, 1.5 * (TIME - 8.0)])
    first, second = measured(recording(ahead, after)).samples[ENCROACHMENT.name].value
    # the person leaves the car's strip at 2.78 s, its front is there at 4.5 s, and by symmetry
    assert 1.4 < first < 1.8
    assert second == pytest.approx(-first, abs=0.15)


def test_the_nearest_person_is_centre_to_centre(recording) -> None:
    found = measured(recording(along(2.0), along(2.7), along(30.0)))
    assert found.samples[NEIGHBOUR.name].value == pytest.approx([0.7] * 100)


def test_speed_and_acceleration_count_beside_the_vehicle(recording) -> None:
    faster = np.column_stack([0.5 * 0.3 * (TIME - 5.0) ** 2, np.full(100, 2.0)])
    found = measured(recording(faster, along(3.0, 1.2)))
    change = found.samples[ACCELERATION.name]
    assert change.value[change.person == 0] == pytest.approx(0.3, abs=1e-6)
    speed = found.samples[SPEED.name]
    assert speed.value[speed.person == 1] == pytest.approx(1.2)
    assert 0 < np.sum(speed.person == 1) < 25  # of 50 samples


def test_people_of_several_recordings_are_numbered_on(recording) -> None:
    one = measured(recording(along(1.57), along(9.0)))
    both = together([one, one])
    assert both.samples[CLEARANCE.name].person.tolist() == [0, 2]
    assert both.close.tolist() == [1, 0, 1, 0]
    assert np.isnan(both.of_each(CLEARANCE)).tolist() == [False, True, False, True]
