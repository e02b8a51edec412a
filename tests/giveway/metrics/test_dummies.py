"""The impact on a dummy: when the front reaches its box, how fast and where.

The car is 5 m x 2 m; its front bumper is at x = 0 at time 0, and it heads along +x.
"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.errors import ConfigError
from giveway.geometry.bodies import VehicleShape
from giveway.metrics.dummies import DummyMetric, DummyOptions
from giveway.run_data.tracks import NO_SIGHTS, SightTrack

CAR = VehicleShape(length=5.0, width=2.0)
TIME = 0.05 * np.arange(81)
SIZE = (0.6, 0.5)


def measured(track, people, sights=NO_SIGHTS):
    drive = SimpleNamespace(track=track, crowd=people, shape=CAR, sights=sights, id="ego")
    return DummyMetric(DummyOptions(SIZE)).measure(drive)


def test_a_crossing_dummy_is_hit_at_the_side_of_its_box(driving, crowd, walking):
    """Its middle is at x = 8.25 m; the front is at its box, 8 m, after 2 s."""
    found = measured(driving(TIME, 4.0), crowd(walking(TIME, (8.25, -3.0), (0.0, 1.4))))
    assert found.dummy_impact_speed == found.dummy_relative_speed == pytest.approx(4.0)
    assert found.dummy_lateral_offset == pytest.approx(-0.2)


def test_a_dummy_that_walks_ahead_is_hit_from_behind(driving, crowd, walking):
    """Its box is 0.3 m longer to either end; the car gains 3 m/s."""
    found = measured(driving(TIME, 4.0), crowd(walking(TIME, (6.3, 0.5), (1.0, 0.0))))
    assert found.dummy_impact_speed == pytest.approx(4.0)
    assert found.dummy_relative_speed == pytest.approx(3.0)
    assert found.dummy_lateral_offset == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("place", "velocity"),
    [
        ((8.25, -5.0), (0.0, 1.4)),  # too late: it walks into the side
        ((8.25, 1.0), (0.0, 1.4)),  # it has passed
        ((20.0, 0.0), (0.0, 0.0)),  # too far
    ],
)
def test_a_dummy_beside_or_beyond_is_not_hit(driving, crowd, walking, place, velocity):
    found = measured(driving(TIME, 4.0), crowd(walking(TIME, place, velocity)))
    assert np.isnan([found.dummy_impact_speed, found.dummy_lateral_offset]).all()


def test_nobody_and_no_braking_are_empty(driving, crowd):
    found = measured(driving(TIME, 4.0), crowd())
    assert np.isnan([found.dummy_impact_speed, found.first_braking_time]).all()
    assert found.hardest_braking == 0.0


def test_braking_counts_from_1_m_s2_after_the_start_and_before_the_impact(driving, crowd, walking):
    track = driving(TIME, 4.0)
    track.acceleration[TIME < 1.0] = -5.0  # an FMU settles
    track.acceleration[(TIME > 2.2) & (TIME < 2.6)] = -2.0
    track.acceleration[TIME > 3.2] = -9.0
    found = measured(track, crowd(walking(TIME, (12.25, 0.0), (0.0, 0.0))))
    assert found.first_braking_time == pytest.approx(2.25)
    assert found.hardest_braking == pytest.approx(2.0)


def test_the_first_sight_is_that_of_this_ego(driving, crowd, walking):
    sights = SightTrack(
        np.array([0.2, 0.3, 0.4]),
        np.array(["other", "ego", "ego"]),
        np.array([0, -1, 0]),  # the second is a false detection
        np.ones(3, np.bool_),
        np.array([9.0, 8.0, 7.0]),
    )
    found = measured(driving(TIME, 4.0), crowd(walking(TIME, (8.0, 0.0), (0.0, 0.0))), sights)
    assert (found.first_sight_time, found.first_sight_distance) == (0.4, 7.0)


@pytest.mark.parametrize("size", [[0.6, 0.0], [-1.0, 0.5], [4.0, 0.5]])
def test_a_dummy_has_a_box_of_its_size(size):
    with pytest.raises(ConfigError, match="expected two lengths above 0, up to 3 m"):
        load([Layer("mine", {"metrics": {"dummy": size}})])
