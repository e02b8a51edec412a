"""Vehicles as pedestrians feel them: columns are checked."""

from __future__ import annotations

import numpy as np
import pytest

from pedestrian_model import (
    VehicleError,
    Vehicles,
)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"x": [0.0, np.nan]}, r"vehicles\[1, 0\] = nan"),
        ({"width": 0.0}, "width of vehicle 0 = 0.0 m, expected > 0 m"),
        ({"rear": [-1.0]}, "rear of vehicle 0 = -1.0 m"),
        ({"x": [0.0, 1.0], "y": [0.0, 1.0, 2.0]}, "lengths differ"),
        ({"speed": "fast"}, "speed: expected numbers"),
    ],
)
def test_a_bad_vehicle_is_refused_by_column_and_value(change, message):
    good = {"x": 0.0, "y": 0.0, "heading": 0.0, "speed": 1.0, "rear": 2.0, "width": 2.0}
    with pytest.raises(VehicleError, match=message):
        Vehicles.create(**(good | change))


def test_one_number_serves_all_vehicles():
    vehicles = Vehicles.create([0.0, 5.0], 1.0, 0.5, [1.0, -1.0])
    assert len(vehicles) == 2
    np.testing.assert_array_equal(vehicles.array[1], [5.0, 1.0, 0.5, -1.0, 2.5, 2.5, 2.0])
    assert len(Vehicles.empty()) == 0
