"""A second of driving tells a lorry from a car."""

from pathlib import Path

import pytest

from fmus import FmuOutputError, make_profile
from fmus.checking import coarse, opener_of, without_guards

PATH = Path("car.fmu")


@pytest.mark.parametrize(
    ("values", "mass"),
    [({}, 1000.0), ({"mass": 12_000.0, "constant": 900.0, "friction": 30.0}, 12_000.0)],
)
def test_cars_and_lorries_are_told_apart(car, values, mass):
    found = coarse(car(lag=0.2, **values), path=PATH)
    assert found.drive.mass == pytest.approx(mass, rel=0.05)
    assert found.brake.mass == pytest.approx(mass, rel=0.05)
    assert found.drive.lag + found.drive.delay == pytest.approx(0.2, abs=0.05)


def test_what_does_not_drive_off_is_refused_in_one_line(car):
    with pytest.raises(FmuOutputError, match=r"^car.fmu: forces of up to .* drives off") as caught:
        coarse(car(drive_limit=0.0), path=PATH)
    assert "\n" not in str(caught.value)


def test_a_lag_of_the_actuators_is_told_from_one_of_the_output(zoo):
    values = {"lag": 0.2, "sensor_lag": 0.3}
    path = zoo.car(outputs=("speed", "position"), values=values, file="both_lags")
    profile = without_guards(make_profile(zoo.profile(path), "test"))
    opener = opener_of(path, step_size=0.05, profile=profile, isolated=False)
    found = coarse(opener, path=path, profile=profile)
    assert found.sensor_lag == pytest.approx(0.3, rel=0.01)
    for side in (found.drive, found.brake):
        assert side.lag == pytest.approx(0.2, abs=0.005)
        assert side.delay < 0.01
        assert side.mass == pytest.approx(1000.0, rel=0.002)
    assert found.sides_error < 0.1  # 0.3 m where both are one response
