"""What cannot stop fails; a factor that a unit or a load explains is a question."""

import numpy as np
import pytest

from fmus.checking import Answers, judge, told_of, too_weak
from fmus.profile.vehicle_profile import make_profile

FITTED = {
    "mass": 1000.0, "friction": 100.0, "r_squared": 1.0, "speed_error": 0.0,
    "position_error": 0.0, "horizon": 0.75, "time_step": 0.05,
}  # fmt: skip


def profile(model=None, **inputs):
    values = {
        "inputs": inputs or {"force": {"variable": "F", "unit": "N"}},
        "outputs": {"speed": {"variable": "v", "unit": "m/s"}},
    }
    return make_profile(values | ({"model": model} if model else {}), "test")


def judged(drive=1000.0, brake=1000.0, braking=8.0, mass=None, given=None):
    answers = Answers(drive, brake, 8.0, 8000.0, braking)
    return judge(answers, told_of(given, mass), given)[-1]


@pytest.mark.parametrize(
    ("answers", "said"),
    [
        ((-1000.0, np.inf), "gain = -1.0 in [inputs.force]"),
        ((np.inf, np.inf), "gear, ignition"),
        ((1000.0, -1000.0, -8.0), "braking makes it faster"),
        ((1000.0, np.inf, 0.0), "nothing brakes it"),
        ((1000.0, 1e5, 0.08), "expected 3 m/s2"),
        ((1000.0, 3500.0), "a factor of 3.5"),
        ((100.0, 100.0), "a factor of 5"),
    ],
)
def test_what_cannot_be_driven_or_stopped_fails(answers, said):
    found = judged(*answers)
    assert found.verdict == "fail"
    assert said in f"{found.text}; {found.remedy}"


@pytest.mark.parametrize(
    ("factor", "name"),
    [(2.24, "mph 2.24"), (1.94, "knots 1.94, 2"), (0.5, "2"), (1.6, "a factor of 1.6;")],
)
@pytest.mark.parametrize("known", ["flag", "model"])
def test_a_factor_below_three_is_a_question(factor, name, known):
    given = profile(FITTED) if known == "model" else profile()
    mass = 1000.0 if known == "flag" else None
    found = judged(1000.0 * factor, 1000.0 * factor, mass=mass, given=given)
    assert found.verdict == "ask"
    assert name in found.text
    assert f"--vehicle-mass {1000.0 * factor:.4g}" in found.remedy
    assert judged(1000.0 * factor, 1000.0 * factor, mass=1000.0 * factor, given=given).verdict == (
        "pass"
    )


@pytest.mark.parametrize("side", [(3500.0, 1000.0), (1000.0, 3500.0)])
def test_each_side_is_compared_with_its_own_model(side):
    assert judged(*side, given=profile(FITTED)).verdict == "fail"
    sides = {"drive": {"mass": side[0]}, "brake": {"mass": side[1]}}
    assert judged(*side, given=profile(FITTED | sides)).verdict == "pass"


def test_a_promise_of_less_braking_is_enough():
    given = profile(FITTED | {"brake": {"mass": 1000.0, "limit": 1.5}})
    assert judged(braking=1.4, given=given).verdict == "pass"
    assert judged(braking=1.4).verdict == "fail"
    assert not too_weak(given, 1000.0, 1500.0)


def test_a_force_limit_must_brake_the_mass():
    assert not too_weak(None, 1000.0, 3000.0)
    assert "--vehicle-force-limit 320000" in too_weak(None, 40_000.0, 2000.0)


def test_an_acceleration_has_the_mass_of_its_inverse_map():
    given = profile(acceleration={"variable": "a", "unit": "m/s2"})
    assert judged(given=given, mass=1500.0).verdict == "pass"
    assert "[inverse_map]" in judged(2000.0, 2000.0, given=given).remedy
