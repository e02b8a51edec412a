"""Wheels: what turns is proposed with the radius that makes a motion of it."""

from __future__ import annotations

import re
import zipfile

import pytest

from fmus import FmuProfileError, FmuVariableError, make_profile
from fmus.description.reading import read_model
from fmus.profile.draft_profile import draft_profile
from fmus.profile.wiring import wire

R = 0.3  # [m]
CORNERS = ("fl", "fr", "rl", "rr")
INPUTS = "".join(
    f'<Float64 name="torque_{c}" valueReference="{n}" causality="input" unit="N.m" start="0"/>'
    for n, c in enumerate(CORNERS, start=1)
)
DESCRIPTION = f"""<?xml version="1.0"?>
<fmiModelDescription fmiVersion="3.0" modelName="wheels" instantiationToken="x">
<CoSimulation modelIdentifier="wheels"/>
<UnitDefinitions><Unit name="rpm"/></UnitDefinitions>
<ModelVariables>{INPUTS}
<Float64 name="wheel_speed" valueReference="5" causality="output" unit="rad/s">
<Dimension start="4"/></Float64>
<Float64 name="motor_speed" valueReference="6" causality="output" unit="rpm"/>
<Float64 name="wheel_angle" valueReference="7" causality="output" unit="deg"/>
<Float64 name="tyre_radius" valueReference="8" causality="parameter" unit="cm" start="31"/>
</ModelVariables><ModelStructure/></fmiModelDescription>"""


@pytest.fixture
def wheels(tmp_path):
    def make(edit=lambda text: text):
        path = tmp_path / "wheels.fmu"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("modelDescription.xml", edit(DESCRIPTION))
        return path

    return make


def test_wheels_are_proposed_with_the_radius_that_the_fmu_tells(wheels):
    draft = draft_profile(read_model(wheels()))
    tables = {entry.table: {line.key: line for line in entry.lines} for entry in draft.entries}
    corners = tuple(f"torque_{corner}" for corner in CORNERS)
    assert tables["inputs.force"]["variables"].value == corners
    assert tables["outputs.speed"]["variables"].value == ("wheel_speed",)
    assert tables["outputs.position"]["variable"].value == "wheel_angle"
    for table in ("inputs.force", "outputs.speed", "outputs.position"):
        assert tables[table]["radius"].value == 0.31
    assert [doubt.split("]")[0] for doubt in draft.doubts] == ["[inputs.force"]
    silent = wheels(lambda text: re.sub(r"<Float64 name=.tyre.*\n", "", text))
    asked = draft_profile(read_model(silent)).doubts
    assert any("'wheel_speed' is a wheel's: write radius = 0.3" in doubt for doubt in asked)


def profile(**tables):
    force = {"variables": ["torque_fl", "torque_fr"], "radius": R}
    speed = {"variables": ["wheel_speed"], "radius": R}
    return make_profile({"inputs": {"force": force}, "outputs": {"speed": speed}} | tables, "test")


def test_forces_are_divided_and_speeds_averaged(wheels):
    model = read_model(wheels())
    found = wire(model, profile())
    (force,), (speed,) = found.inputs, found.outputs
    assert [factor for _, factor in force.channel.parts] == [0.5, 0.5]
    assert force.to_raw(1000.0) == pytest.approx(300.0)  # [N.m] of both wheels
    assert [channel.element for channel, _ in speed.channel.parts] == [0, 1, 2, 3]
    assert speed.to_si(10.0) == pytest.approx(3.0)
    names = [f"torque_{corner}" for corner in ("fl", "rl")]
    uneven = {"variables": names, "share": [0.7, 0.3], "radius": R, "gain": 4.0}
    (force,) = wire(model, profile(inputs={"force": uneven})).inputs
    assert [factor for _, factor in force.channel.parts] == [0.7, 0.3]
    assert force.to_raw(1000.0) == pytest.approx(75.0)  # gears of 4:1
    turned = {"speed": {"variable": "motor_speed", "radius": R},
              "position": {"variable": "wheel_angle", "radius": R}}  # fmt: skip
    speed, position = wire(model, profile(outputs=turned)).outputs
    assert speed.to_si(600.0) == pytest.approx(R * 20 * 3.14159265359)
    assert position.to_si(180.0) == pytest.approx(R * 3.14159265359)


FORCE = {"variables": ["torque_fl", "torque_fr"], "radius": R}


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        ({"inputs": {"force": FORCE | {"variable": "torque_fl"}}}, "expected variable = "),
        ({"inputs": {"force": {"radius": R}}}, "expected variable = "),
        ({"inputs": {"force": FORCE | {"share": [0.7, 0.7]}}}, "the sum is 1.4; expected 1"),
        ({"inputs": {"force": FORCE | {"share": [0.5, 0.25, 0.25]}}}, "3 numbers for 2 variables"),
        ({"inputs": {"force": FORCE | {"variables": ["torque_fl"] * 2}}}, "named twice"),
        ({"inputs": {"force": FORCE | {"radius": None}}}, "a torque or an energy, and not a force"),
        ({"inputs": {"force": FORCE | {"offset": 10.0}}}, "cannot be divided"),
        ({"inputs": {"force": FORCE | {"unit": "kN"}}}, "is in 'kN', a force, and not in N.m"),
        ({"outputs": {"speed": {"variables": ["wheel_speed", "motor_speed"], "radius": R}}},
         "differ in unit or type"),
        ({"outputs": {"speed": {"variables": ["wheel_speed"], "share": [0.25] * 4, "radius": R}}},
         "only a force is divided"),
        ({"outputs": {"speed": {"variable": "wheel_speed", "radius": R}}}, 'variables = ["wheel_'),
        ({"outputs": {"speed": {"variables": ["wheel_sped"], "radius": R}}}, "did you mean"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_in_a_line(wheels, tables, said):
    model = read_model(wheels())
    with pytest.raises((FmuProfileError, FmuVariableError)) as caught:
        wire(model, profile(**tables))
    assert said in str(caught.value)
    assert str(caught.value).isprintable()


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_a_car_drives_by_torques_and_wheel_speeds_as_by_forces(zoo, open_car, fmi):
    units = {"force": ("N.m", 1.0, 0.0), "speed": ("rad/s", 1.0, 0.0)}
    spoken = {"force": (1.0 / R, 0.0), "speed": (R, 0.0)}
    turning = zoo.car(fmi=fmi, units=units, spoken=spoken, define_units=False, file="turning")
    radius = {"inputs": {"force": {"radius": R}}, "outputs": {"speed": {"radius": R}}}
    motions = []
    for car in (open_car(zoo.car(fmi=fmi)), open_car(turning, **radius, initial={"speed": None})):
        car.start(speed=0.0)
        for _ in range(20):
            car.step(2000.0)
        motions.append((car.position, car.speed))
    assert motions[1] == pytest.approx(motions[0], rel=1e-12)


def test_an_array_is_driven_by_shares_and_read_as_a_mean(zoo, open_car):
    path = zoo.car(fmi="3.0", array="structural", outputs=("speed", "speed", "speed"), file="mean")

    def drive(force):
        car = open_car(
            path,
            inputs={"force": force | {"unit": "N"}},
            outputs={"speed": {"variable": None, "variables": ["y"], "unit": "m/s"}},
        )
        car.start(speed=4.0)
        car.step(900.0)
        return car.speed

    whole = drive({"variable": "u[1]"})
    assert drive({"variable": None, "variables": ["u"], "share": [1, 0, 0]}) == whole
    third = drive({"variable": None, "variables": ["u[1]", "u[2]", "u[3]"], "gain": 1 / 3})
    assert third == pytest.approx(whole, rel=1e-12)
