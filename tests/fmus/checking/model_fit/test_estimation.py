"""Cars of other sizes than ours: trucks, set-points without a lead, limits with much resistance."""

from __future__ import annotations

from pathlib import Path

import pytest

from fmus.checking import Mpc, check, expected_of, opener_of
from fmus.checking.identification import identify
from fmus.profile.vehicle_profile import make_profile

TRUCK = {"mass": 18_000.0, "friction": 50.0, "constant": 900.0, "lag": 0.8}


def finding(report, name):
    return next(found for found in report.findings if found.name == name)


def identified(opener, force_limit):
    mpc = Mpc(0.05, 15, force_limit)
    return identify(opener, mpc, path=Path("car.fmu"), speeds=(2.0, 9.0, 18.0))


def test_rolling_resistance_is_not_taken_for_a_weak_drive(car):
    found = identified(car(**TRUCK), 8_000.0)  # its weakest tests do not even move it
    assert found.model.drive.limit is found.model.brake.limit is None
    assert found.model.mass == pytest.approx(18_000.0, rel=0.1)


def test_a_limit_is_that_of_the_actuator_whatever_resists(car):
    opener = car(mass=1400.0, friction=0.0, constant=300.0, drag=0.5, drive_limit=4500.0)
    assert identified(opener, 8_000.0).model.drive.limit * 1400.0 == pytest.approx(4500.0, rel=0.02)


def test_with_forces_of_its_size_a_truck_is_known_well(car):
    found = identified(car(**TRUCK), 60_000.0)
    assert found.model.mass == pytest.approx(18_000.0, rel=0.01)
    assert found.model.lag == pytest.approx(0.8, rel=0.02)


def test_all_four_resistances_come_back(car):
    opener = car(mass=1500.0, friction=40.0, constant=200.0, drag=0.8)
    found = identified(opener, 6_000.0).estimate
    assert found.mass(0) == pytest.approx(1500.0, rel=0.01)
    constant, viscous, quadratic = found.linear.coefficients[2:] * 1500.0
    assert constant == pytest.approx(200.0, rel=0.1)
    assert viscous == pytest.approx(40.0, rel=0.1)
    assert quadratic == pytest.approx(0.8, rel=0.1)


def test_a_gearbox_that_is_weaker_in_higher_gears_is_no_limit(zoo):
    values = {"gear_speed": 3.0, "gear_ratio": 0.6}
    path = zoo.car(fmi="2.0", kind="model-exchange", values=values)
    profile = make_profile(zoo.profile(path), "test")
    opener = opener_of(path, step_size=0.05, profile=profile, isolated=False)
    found = identified(opener, 8_000.0)
    assert found.model.drive.limit is None
    seen = finding(check(opener, expected_of(profile), step_size=0.05), "controller's model")
    assert "arrive" not in seen.text
