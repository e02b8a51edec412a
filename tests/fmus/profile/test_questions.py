"""The questions of drafts for what common tools export: pedals, torques, tunable parameters."""

from __future__ import annotations

from pathlib import Path

import pytest

from fmus.description.model import Interface, Kind, Model, Variable
from fmus.profile.draft_profile import draft_profile


def drafted(inputs=(), parameters=()):
    """Of texts such as ``speed [m/s]``; the parameters are tunable."""
    variables = {}
    named = [(text, "input", "continuous") for text in inputs]
    named += [(text, "parameter", "tunable") for text in parameters]
    for text, causality, variability in (*named, ("speed [m/s]", "output", "continuous")):
        name, _, unit = text.partition(" [")
        variables[name] = Variable(
            name, 0, "Real", causality, variability, unit=unit.rstrip("]"), settable=True
        )
    return draft_profile(
        Model(
            path=Path("car.fmu"),
            fmi_version="2.0",
            name="Car",
            guid="{}",
            generation_tool="",
            description="",
            interfaces={Kind.CO_SIMULATION: Interface(Kind.CO_SIMULATION, "car")},
            variables=variables,
            units={},
            platforms=(),
            states=0,
            event_indicators=0,
            default_step=None,
            default_tolerance=None,
        )
    )


def entry(draft, table):
    return next(entry for entry in draft.entries if entry.table == table)


def line(draft, table, key):
    return next(line for line in entry(draft, table).lines if line.key == key)


def test_pedals_in_the_short_words_of_simulink():
    draft = drafted(["AccelPdl_pct", "BrkPdl_pct"])
    assert line(draft, "inputs.throttle", "variable").value == "AccelPdl_pct"
    assert line(draft, "inputs.brake", "variable").value == "BrkPdl_pct"
    assert line(draft, "inputs.brake", "unit").value == "%"  # as its name says, but not sure
    assert not line(draft, "inputs.brake", "unit").sure
    doubt = entry(draft, "inputs.throttle").doubt
    assert 'add unit = "%"' in doubt
    assert "full_force = 4000" in doubt


@pytest.mark.parametrize(
    ("name", "gain"),
    [
        ("wheel_torque [N.m]", "radius = 0.3 or that of the wheels"),
        ("T_motor [Nm]", "radius = 0.3 or that of the wheels"),
        ("motor_cmd [%]", "gain = the force at 1, which is 100 %"),
    ],
)
def test_a_torque_or_a_command_is_a_force_but_for_a_gain(name, gain):
    draft = drafted([name, "steering_angle [rad]", "road_grade [%]"])
    force = entry(draft, "inputs.force")
    assert not draft.confident
    assert line(draft, "inputs.force", "variable").value == name.split(" [")[0]
    assert f"add {gain}" in force.doubt


def test_a_steering_torque_or_one_of_two_is_not_guessed():
    for inputs in (["steering_torque [N.m]"], ["torque_a [N.m]", "torque_b [N.m]"]):
        assert "gain" not in entry(drafted(inputs), "inputs.force").doubt


def test_torques_of_several_wheels_are_one_force():
    draft = drafted([f"torque_{corner} [N.m]" for corner in ("fl", "fr", "rl", "rr")])
    named = ("torque_fl", "torque_fr", "torque_rl", "torque_rr")
    assert line(draft, "inputs.force", "variables").value == named
    both = drafted(["drive_torque [N.m]", "brake_torque [N.m]"])
    assert line(both, "inputs.drive_force", "radius").value == 0.3
    assert "add radius = 0.3" in entry(both, "inputs.brake_force").doubt


def test_without_inputs_a_tunable_parameter_is_asked_about():
    draft = drafted(parameters=["F_x [N]", "mass [kg]"])
    assert "the FMU has no input; is it driven by 'F_x'" in entry(draft, "inputs.force").doubt
    assert not draft.confident
    assert "it has no numeric input" in entry(drafted(), "inputs.force").doubt


def test_a_draft_says_how_its_marked_lines_are_meant():
    open_ = drafted(["force"])
    assert open_.open_lines
    assert 'Lines with "# ?" are open' in open_.toml
    closed = drafted(["force [N]"])
    assert not closed.open_lines
    assert "# ?" not in closed.toml
