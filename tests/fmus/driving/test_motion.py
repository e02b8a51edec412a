"""A position that is not the speed's integral ends the drive before it misleads anybody."""

from __future__ import annotations

import pytest

from fmus import FmuOutputError, VehicleFmu, make_profile


def drive(vehicle, steps):
    for _ in range(steps):
        vehicle.step(400.0)


@pytest.mark.parametrize("kilo", [1000.0, 1 / 0.3048], ids=["km", "ft"])
def test_a_position_in_an_undeclared_unit_is_found_within_metres(zoo, kilo):
    path = zoo.car(spoken={"position": (kilo, 0.0)})
    with VehicleFmu(path, step_size=0.05, profile=make_profile(zoo.profile(path), "t")) as vehicle:
        vehicle.start(speed=4.0)
        with pytest.raises(FmuOutputError, match=r"position has moved by .* check the units"):
            drive(vehicle, 20)
        assert vehicle.time < 1.0


def test_wheels_that_slip_a_little_are_no_fault(zoo):
    path = zoo.car(spoken={"position": (1.1, 0.0)})
    with VehicleFmu(path, step_size=0.05, profile=make_profile(zoo.profile(path), "t")) as vehicle:
        vehicle.start(speed=4.0)
        for _ in range(400):
            vehicle.step(1000.0)
