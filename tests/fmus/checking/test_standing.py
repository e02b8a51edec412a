"""A vehicle stays where it stopped: by itself, by a brake that is held, or a check says why not."""

from __future__ import annotations

import pytest

from fmus import make_profile
from fmus.checking import (
    measure,
    opener_of,
    openers_held,
    standing,
    stays,
    told_of,
    without_guards,
)

STEP = 0.05  # [s]
CREEPS = {"mass": 1200.0, "creep": 900.0}


@pytest.fixture
def at_rest(zoo):
    """The motion of a car of the zoo at rest, with what holds it, and the finding about it."""

    def find(hold=None, **options):
        path = zoo.car(outputs=("speed", "position"), **options)
        values = zoo.profile(path)
        if hold is not None:
            values["inputs"]["hold"] = hold
        profile = without_guards(make_profile(values, "test"))
        opener = opener_of(path, step_size=STEP, profile=profile, isolated=False)
        held = openers_held(path, step_size=STEP, profile=profile, isolated=False)
        answers = measure(opener, brake_force=9600.0)
        found = standing(opener, held, profile, answers, told_of(profile, None))
        return found, stays(found, profile)

    return find


def test_a_car_that_stands_needs_no_brake(at_rest):
    found, finding = at_rest(role="throttle_brake")
    assert (found.creep, found.roll, found.hold) == (0.0, 0.0, 0.0)
    assert (finding.verdict, finding.text) == ("pass", "without a demand it stands")


@pytest.mark.parametrize("role", ["throttle_brake", "drive_brake"])
def test_the_brakes_of_a_car_that_creeps_are_held(at_rest, role):
    found, finding = at_rest(role=role, values=CREEPS)
    assert found.creep == pytest.approx(1.0, abs=0.05)
    assert found.hold == pytest.approx(3.0 * 1200.0, rel=0.01)
    assert finding.verdict == "pass"
    assert finding.text == f"it creeps at 1 m/s without a demand; {found.hold:.4g} N of brake " \
        "force hold it"  # fmt: skip


def test_a_car_on_a_grade_is_held_uphill_and_downhill(at_rest):
    found, finding = at_rest(role="throttle_brake", extra=("grade",))
    assert abs(found.roll) > 1.0
    assert found.hold == pytest.approx(3.0 * 1000.0, rel=0.01)
    assert "on a grade of 6 %" in finding.text


def test_brakes_that_let_go_at_a_standstill_fail(at_rest):
    found, finding = at_rest(role="throttle_brake", values=CREEPS | {"holds": 0.0})
    assert found.hold is None
    assert finding.verdict == "fail"
    assert "creeps at 1 m/s without a demand, and goes at -" in finding.text
    assert "[inputs.brake]" in finding.remedy


def test_a_mass_without_brakes_that_hold_is_braked_again_and_again(at_rest):
    found, finding = at_rest(role="force", values={"creep": 300.0})
    assert found.hold == 0.0
    assert finding.verdict == "warn"
    assert "it stands while a controller brakes" in finding.text


def test_a_profile_that_names_the_force_is_believed(at_rest):
    found, finding = at_rest(role="throttle_brake", values=CREEPS, hold=2500.0)
    assert found.fact == ""
    assert finding.verdict == "pass"
