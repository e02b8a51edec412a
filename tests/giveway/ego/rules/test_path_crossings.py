"""Crossings on a path: the stretch that lies on each."""

import numpy as np
import pytest

from giveway.ego.rules.path_crossings import crossings_on
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from giveway.sumo.network.pedestrian_crossings import Crossing

SHAPE = VehicleShape(length=5.0, width=2.0)


LANE = -1.75  # [m] its y


SOUTHERN_KERB, NORTHERN_KERB = -3.5, 3.5


def test_the_stretch_of_the_path_that_lies_on_it():
    ends = np.array([[22.0, NORTHERN_KERB], [22.0, SOUTHERN_KERB]])
    path = EgoPath.through([(0.0, LANE), (60.0, LANE)])
    (place,) = crossings_on(path, SHAPE, [Crossing(":j_c0_0", ends, 4.0, True, "", -1)])
    assert (place.entry, place.exit) == pytest.approx((20.0, 24.0), abs=0.11)
    # from the northern kerb: the lane's middle at 5.25 m, half a width and a body beside it
    assert (place.low, place.high) == pytest.approx((5.25 - 1.8, 5.25 + 1.8))
    beside = EgoPath.through([(0.0, 9.0), (60.0, 9.0)])
    assert crossings_on(beside, SHAPE, [Crossing(":j_c0_0", ends, 4.0, True, "", -1)]) == ()
