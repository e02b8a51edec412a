"""A second of driving tells a lorry from a car."""

from pathlib import Path

import pytest

from fmus import FmuOutputError
from fmus.checking import coarse

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
