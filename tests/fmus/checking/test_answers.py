"""Both masses are measured against coasting, for lags, limits and factors of a thousand."""

import numpy as np
import pytest

from fmus.checking import measure, opener_of
from fmus.profile.vehicle_profile import make_profile


def answers_of(zoo, brake_force=8000.0, **options):
    path = zoo.car(**options)
    profile = make_profile(zoo.profile(path) | {"limits": {"acceleration": 1e6}}, "test")
    opener = opener_of(path, step_size=0.05, profile=profile, isolated=False)
    return measure(opener, brake_force=brake_force)


@pytest.mark.parametrize(
    ("mass", "options"),
    [
        (1000.0, {}),
        (1000.0, {"role": "throttle_brake", "values": {"full_drive": 2500.0}}),
        (12000.0, {"values": {"mass": 12000.0, "lag": 0.5}}),
        (1.0, {"spoken": {"force": (1000.0, 0.0)}}),
    ],
)
def test_the_masses_of_both_sides(zoo, mass, options):
    found = answers_of(zoo, brake_force=8.0 * mass, **options)
    assert found.drive_mass == pytest.approx(mass, rel=0.2)
    assert found.brake_mass == pytest.approx(mass, rel=0.25)
    assert found.braking == pytest.approx(8.0, rel=0.3)


def test_a_wrong_sign_and_no_answer(zoo):
    assert answers_of(zoo, spoken={"force": (-1.0, 0.0)}).drive_mass < 0.0
    assert answers_of(zoo, values={"engaged": 0.0}).drive_mass == np.inf


def test_brakes_of_their_own(zoo):
    reversed_, weak = (
        answers_of(zoo, role="drive_brake", spoken={"brake_force": (factor, 0.0)})
        for factor in (-1.0, 0.01)
    )
    assert reversed_.braking < 0.0
    assert reversed_.brake_mass < 0.0
    assert weak.braking < 0.2
    assert weak.drive_mass == pytest.approx(1000.0, rel=0.1)
