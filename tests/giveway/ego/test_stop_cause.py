"""What an ego that stands, or nearly stands, is said to wait for."""

import math
from dataclasses import replace

import numpy as np
import pytest

from controller import Decision
from giveway.ego.percept import Perceived
from giveway.ego.perception.leader import Leader
from giveway.ego.stop_cause import waits_for

FRONT, KEPT = 40.0, 8.0  # [m]
FREE = Perceived(ahead=np.full(3, math.inf))


def cause(force=-900.0, acting="mpc", reason="clear", eases_off=False, **seen):
    decision = Decision(force, acting, reason, "solved", 1, 4.0, None)
    return waits_for(FRONT, KEPT, replace(FREE, **seen), decision, eases_off)


@pytest.mark.parametrize(("force", "eases_off"), [(-900.0, True), (300.0, False)])
def test_who_lets_go_of_the_brake_or_drives_off_waits_for_nobody(force, eases_off):
    assert cause(force=force, eases_off=eases_off) == ""


def test_who_brakes_on_for_nobody_has_no_cause():
    assert cause() == "none"
    assert cause(reason="as planned") == "plan"


@pytest.mark.parametrize("stops_for", ["light", "stop", "yield"])
def test_the_nearest_is_the_cause(stops_for):
    assert cause(leader=Leader(46.0, 0.0), eases_off=True) == "vehicle"
    assert cause(pedestrian=47.0, stop=45.0, stops_for=stops_for) == "person"
    assert cause(pedestrian=60.0, stop=41.0, stops_for=stops_for) == stops_for
    assert cause(stop=44.0, stops_for=stops_for) == "none"  # it could go on for 4 m


def test_the_layer_waits_for_people_the_plan_for_expected_ones():
    assert cause(acting="safety") == "person"
    assert cause(ahead=np.array([60.0, 47.0, 60.0])) == "vehicle"
    assert cause(ahead=np.array([60.0, 47.0, 60.0]), predicted=np.empty((3, 1, 2))) == "person"


def test_the_layer_for_vehicles_waits_for_vehicles():
    assert cause(acting="safety", reason="vehicle ahead") == "vehicle"
