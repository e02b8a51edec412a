"""The instants of a picture: the events of the drive, and others evenly."""

from dataclasses import replace

import numpy as np

from giveway.figures.instants import SNAPSHOTS, closest_approach, telling_instants
from giveway.geometry.bodies import VehicleShape

CAR = VehicleShape(length=5.0, width=2.0)


def told(ego, crowd):
    return telling_instants(ego, crowd, closest_approach(ego, crowd, CAR))


def with_stop(ego, first, last, cause):
    speed, waits_for = ego.speed.copy(), ego.waits_for.astype(object)
    speed[first:last] = 0.0
    waits_for[first + 2 : last] = cause  # a controller knows it some steps later
    return replace(ego, speed=speed, waits_for=waits_for)


def test_there_are_six_with_the_closest_approach(run):
    found = told(*run(30, 1, "mpc"))
    assert len(found) == SNAPSHOTS
    assert list(found) == sorted(found)
    assert list(found.values()).count("closest approach") == 1


def test_the_longest_stops_are_shown_with_their_causes(run):
    ego, crowd = run(30, 1, "mpc")
    stopped = with_stop(with_stop(ego, 20, 60, "light"), 100, 130, "yield")
    found = told(stopped, crowd)
    assert found[20] == "stands at a red light"
    assert found[100] == "stands to yield"
    assert len(found) == SNAPSHOTS


def test_a_stop_of_an_unknown_cause_is_a_stop(run):
    ego, crowd = run(30, 1, "mpc")
    assert told(with_stop(ego, 20, 60, ""), crowd)[20] == "stands"


def test_a_stop_beside_the_closest_approach_is_not_shown_twice(run):
    ego, crowd = run(30, 1, "mpc")
    closest = closest_approach(ego, crowd, CAR)
    found = told(with_stop(ego, closest + 3, closest + 40, "person"), crowd)
    assert closest + 3 not in found
    assert found[closest] == "closest approach"


def test_the_others_are_spread(run):
    found = np.array(list(told(*run(30, 1, "mpc"))))
    assert np.diff(found).min() > 5
