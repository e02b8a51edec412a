"""The speeds of contacts, and the smallest distance ahead.

The car is 5 m x 2 m; its front bumper is at x = 0 at time 0, and it heads along +x.
"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from giveway.geometry.bodies import VehicleShape
from giveway.metrics.impacts import ImpactMetric

CAR = VehicleShape(length=5.0, width=2.0)
R = 0.27
TIME = 0.05 * np.arange(81)


def measured(track, people):
    drive = SimpleNamespace(track=track, crowd=people, shape=CAR, body_radius=R)
    return ImpactMetric().measure(drive)


def test_a_frontal_impact_has_the_speed_of_the_ego(driving, crowd, walking):
    found = measured(driving(TIME, 4.0), crowd(walking(TIME, (8.0, 0.0), (0.0, 0.0))))
    assert found.frontal_impact_speed == pytest.approx(4.0)
    assert np.isnan(found.side_impact_speed)
    assert found.clearance_ahead == pytest.approx(0.0, abs=0.2)


def test_an_impact_at_the_side_has_the_relative_speed(driving, crowd, walking):
    """He crosses at 1.4 m/s and meets the side 2 m behind the bumper."""
    meets = (1.73 / 1.4) * 4.0 - 2.0
    found = measured(driving(TIME, 4.0), crowd(walking(TIME, (meets, -3.0), (0.0, 1.4))))
    assert np.isnan(found.frontal_impact_speed)
    assert found.side_impact_speed == pytest.approx(np.hypot(4.0, 1.4))


def test_adults_and_children_who_are_hit_have_speeds_of_their_own(driving, crowd, walking):
    people = crowd(walking(TIME, (8.0, 0.0), (0.0, 0.0)), walking(TIME, (12.0, 0.0), (0.0, 0.0)))
    for kinds, ends in (((), "adult"), (("elderly", "child"), "both"), (("child",) * 2, "child")):
        found = measured(driving(TIME, 4.0), replace(people, kinds=kinds))
        assert found.frontal_impact_speed == pytest.approx(4.0)
        assert np.isnan(found.adult_impact_speed) == (ends == "child")
        assert np.isnan(found.child_impact_speed) == (ends == "adult")


def test_nobody_ahead_is_no_distance(driving, crowd, walking):
    found = measured(driving(TIME, 4.0), crowd(walking(TIME, (8.0, 5.0), (0.0, 0.0))))
    assert np.isnan(found.clearance_ahead)


def test_the_distance_ahead_is_from_the_bumper_to_the_circle(driving, crowd, walking):
    """He stands 20 m ahead; the car drives 16 m."""
    found = measured(driving(TIME, 4.0), crowd(walking(TIME, (20.0, 1.2), (0.0, 0.0))))
    assert found.clearance_ahead == pytest.approx(20.0 - 16.0 - R)


def test_the_summary_of_a_run_has_them_if_they_are_asked_for():
    import giveway

    settings = {"time_limit": 0.5, "crowd": {"pedestrians": 1}}
    usual = giveway.run(settings).summary
    asked = giveway.run(settings | {"metrics": {"impacts": True}}).summary
    assert set(asked) - set(usual) == {
        "frontal_impact_speed",
        "side_impact_speed",
        "adult_impact_speed",
        "child_impact_speed",
        "clearance_ahead",
    }
