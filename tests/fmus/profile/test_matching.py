"""What a draft asks: of units, of several candidates, of what is missing."""

from __future__ import annotations

import re
import tomllib

import pytest
from support.drafts import drafted, questions, variable

from fmus.description.model import Variable
from fmus.profile.matching import words_of
from fmus.profile.vehicle_profile import make_profile


@pytest.mark.parametrize(
    ("inputs", "outputs", "asked"),
    [
        (["force"], ["speed [m/s]"], "[inputs.force] 'force' has no unit; add unit = \"N\""),
        (["force [N]"], ["speed"], "[outputs.speed] 'speed' has no unit; add unit = \"m/s\""),
        (["force [N]"], ["speed_kmh"], 'add unit = "km/h"'),
        (["force [N]"], ["v [m/s]", "x"], "[outputs.position] 'x' has no unit; add unit = \"m\""),
        (["force [N]"], ["speed [warp]"], "'warp', an unknown unit"),
    ],
)
def test_without_a_unit_nothing_is_sure(inputs, outputs, asked):
    assert asked in questions(drafted(inputs, outputs))


def test_a_force_in_kilograms_is_asked_about():
    message = questions(drafted(["force [kg]"], ["speed [m/s]"]))
    assert "in kg, a mass, not a force" in message


def test_a_torque_asks_for_the_wheels():
    message = questions(drafted(["traction [N.m]"], ["speed [m/s]"]))
    assert "add radius = 0.3 or that of the wheels" in message


@pytest.mark.parametrize(
    ("outputs", "asked"),
    [
        (["speed [m/s]", "velocity [m/s]"], "which of 'speed', 'velocity'"),
        (["v [m/s]", "s [m]", "x [m]"], "which of 's', 'x'"),
    ],
)
def test_two_that_are_as_good_are_a_question(outputs, asked):
    assert asked in questions(drafted(["force [N]"], outputs))


def test_two_ways_to_drive_are_a_question():
    message = questions(drafted(["force [N]", "speed_setpoint [m/s]"], ["speed [m/s]"]))
    assert "Choose one way to drive" in message


def test_pedals_have_a_strength_that_nobody_tells():
    draft = drafted(["throttle [1]", "brake [%]"], ["speed [m/s]"])
    message = questions(draft)
    assert "[inputs.throttle]" in message
    assert "full_force = 4000" in message
    text = re.sub(r"# \? (full_force)", r"\1", draft.toml)
    profile = make_profile(tomllib.loads(text), "edited draft")
    assert profile.inputs.brake.full_force == 8000


def test_a_throttle_without_a_brake():
    message = questions(drafted(["throttle [1]"], ["speed [m/s]"]))
    assert "'throttle' is a throttle, but no input is a brake" in message


def test_an_inner_variable_is_not_taken_without_being_asked():
    inner = variable("mass.v [m/s]", "local")
    message = questions(drafted(["f [N]"], ["y"], more=[inner]))
    assert "is it the local variable 'mass.v'" in message


def test_nothing_to_drive():
    message = questions(drafted(["k1", "on"], ["y [V]"]))
    assert "its inputs are k1, on" in message
    assert "its outputs are y" in message


def test_an_array_asks_for_the_element():
    states = Variable("speed", 0, "Float64", "output", unit="m/s", shape=(2,))
    assert "which element" in questions(drafted(["force [N]"], [states]))


def test_booleans_and_texts_are_no_candidates():
    brake = Variable("brake", 0, "Boolean", "input")
    force = Variable("force", 0, "String", "input")
    assert "no numeric input" in questions(drafted([brake, force], ["speed [m/s]"]))


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tractiveForce", ["tractive", "force"]),
        ("F_x", ["f", "x"]),
        ("v0", ["v", "0"]),
        ("vehicle.body.v_ref", ["v", "ref"]),
        ("APPSPosition", ["apps", "position"]),
        ("Ego Speed (km/h)", ["ego", "speed", "km", "h"]),
    ],
)
def test_words_of_a_name(name, words):
    assert words_of(name) == words
