"""Drafts and messages for what common tools export: pedals, torques, tunables, fixed steps."""

from __future__ import annotations

from pathlib import Path

import pytest

from fmus import VehicleFmu
from fmus.description.model import Interface, Kind, Model, Variable
from fmus.errors import FmuStartError, FmuStepError
from fmus.profile.draft_profile import draft_profile
from fmus.profile.vehicle_profile import make_profile


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
        ("wheel_torque [N.m]", "ratio of the gears / radius of the wheels"),
        ("T_motor [Nm]", "ratio of the gears / radius of the wheels"),
        ("motor_cmd [%]", "the force at 1, which is 100 %"),
    ],
)
def test_a_torque_or_a_command_is_a_force_but_for_a_gain(name, gain):
    draft = drafted([name, "steering_angle [rad]", "road_grade [%]"])
    force = entry(draft, "inputs.force")
    assert not draft.confident
    assert line(draft, "inputs.force", "variable").value == name.split(" [")[0]
    assert f"add gain = {gain}" in force.doubt


def test_a_steering_torque_or_one_of_two_is_not_guessed():
    for inputs in (["steering_torque [N.m]"], ["torque_left [N.m]", "torque_right [N.m]"]):
        assert "gain" not in entry(drafted(inputs), "inputs.force").doubt


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


@pytest.mark.parametrize(
    ("only", "said"),
    [
        (0.1, "add step = 0.1 to [fmu]"),
        (0.02, "add step = 0.02 to [fmu] and run with --time-step 0.02"),
    ],
)
def test_a_refused_step_names_the_one_of_the_default_experiment(zoo, only, said):
    car = zoo.car(
        only_step=only, step=only, flags={"canHandleVariableCommunicationStepSize": "false"}
    )
    values = zoo.profile(car)
    values.get("fmu", {}).pop("step", None)
    with VehicleFmu(car, step_size=0.05, profile=make_profile(values, "test")) as vehicle:
        vehicle.start()
        with pytest.raises(FmuStepError) as caught:
            vehicle.step(100.0)
    assert str(caught.value).endswith(said)


def test_a_car_that_no_force_moves_names_the_inputs_that_nobody_sets(zoo):
    car = zoo.car(initial=(), values={"engaged": 0.0}, extra=("spare_input",))
    values = zoo.profile(car)
    values.pop("initial", None)
    values["parameters"] = {"engaged": False}
    with (
        VehicleFmu(car, step_size=0.05, profile=make_profile(values, "test")) as vehicle,
        pytest.raises(FmuStartError, match=r"no force moves it .* spare_input = "),
    ):
        vehicle.start(speed=4.0)


def test_a_car_with_the_sign_of_its_force_turned_is_told_the_line(zoo):
    car = zoo.car(initial=(), spoken={"force": (-1.0, 0.0)})
    values = zoo.profile(car)
    values.pop("initial", None)
    with (
        VehicleFmu(car, step_size=0.05, profile=make_profile(values, "test")) as vehicle,
        pytest.raises(
            FmuStartError, match=r"drive it backwards .* gain = -1.0 in \[inputs.force\]"
        ),
    ):
        vehicle.start(speed=4.0)
