"""A draft holds what is sure, and asks for the rest."""

from __future__ import annotations

import re
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.drafts import CS, PATH, a_model, drafted, questions, variable

from fmus import bundled_fmu
from fmus.description import units
from fmus.description.model import Interface, Kind, Unit, Variable
from fmus.description.reading import read_model
from fmus.profile.draft_profile import draft_profile, require_confident
from fmus.profile.vehicle_profile import make_profile

# ---- what is sure ----


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_our_own_fmu_leaves_no_doubt(version):
    model = read_model(bundled_fmu(version))
    profile = require_confident(draft_profile(model), model.path)
    assert profile.inputs.force.variable == "force"
    outputs = profile.outputs
    assert (outputs.speed.variable, outputs.position.variable) == ("speed", "position")
    assert outputs.acceleration.variable == "acceleration"
    assert (profile.initial.speed.variable, profile.initial.position.variable) == ("v0", "s0")


@pytest.mark.parametrize(
    ("name", "role"),
    [
        *((name, "force") for name in ("force [N]", "F [N]", "F_x [kN]", "Fx [lbf]", "u [N]")),
        *((name, "force") for name in ("tractiveForce [N]", "thrust [N]", "vehicle.F [N]")),
        *((name, "force") for name in ("force_cmd [N]", "longitudinalForce [N]", "in1 [N]")),
        *((name, "acceleration") for name in ("a_ref [m/s2]", "accel [m/s2]", "u [m/s2]")),
        *((name, "acceleration") for name in ("desiredAcceleration [m.s-2]", "acc_cmd [g0]")),
    ],
)
def test_one_input_by_name_and_unit(name, role):
    draft = drafted([name], ["v [m/s]"])
    assert draft.confident
    (way,) = draft.values["inputs"]
    assert (way, draft.values["inputs"][way]["variable"]) == (role, name.partition(" [")[0])


@pytest.mark.parametrize(
    "name",
    ["v_ref [m/s]", "speedSetpoint [km/h]", "target_speed [mph]", "vSet [m/s]", "u [km/h]"],
)
def test_how_fast_a_set_point_is_followed_is_a_question(name):
    """With another lead than the FMU's own time constant the car hardly brakes, or too hard."""
    draft = drafted([name], ["v [m/s]"])
    assert not draft.confident
    variable = name.partition(" [")[0]
    assert draft.values["inputs"] == {"speed_setpoint": {"variable": variable}}
    assert "[inputs.speed_setpoint] the FMU does not say how fast it follows" in questions(draft)
    text = re.sub(r"# \? (lead)", r"\1", draft.toml)
    assert make_profile(tomllib.loads(text), "edited draft").inputs.speed_setpoint.lead == 0.5


@pytest.mark.parametrize(
    ("inputs", "question"),
    [
        ([("F [N]", 0.0, 5000.0)], "'F' is never negative (min = 0): what brakes?"),
        ([("a_ref [m/s2]", 0.0, None)], "'a_ref' is never negative (min = 0): what brakes?"),
        ([("F_x [N]", None, None), ("brake", None, None)], "'brake' is an input, too: does 'F_x'"),
        ([("a_ref [m/s2]", None, None), ("brk_cmd [%]", None, None)], "'brk_cmd' is an input, too"),
        ([("F_drive [N]", None, None)], "'F_drive' is named after a drive: does it brake"),
        ([("F_drive [N]", 0.0, None), ("F_brake [N]", -9e3, 0.0)], "'F_brake' is never positive"),
    ],
)
def test_what_decides_about_braking_is_a_question(inputs, question):
    variables = [variable(t, "input", minimum=low, maximum=high) for t, low, high in inputs]
    assert question in questions(drafted(variables, ["v [m/s]"]))


@pytest.mark.parametrize(
    ("text", "gain"),
    [("F_brake [N]", "gain = -1.0"), ("throttle [1]", "gain = the force at 1"),
     ("brake_pedal [%]", "gain = minus the force at 1"), ("brakeForce", "gain = -1.0")],
)  # fmt: skip
def test_the_only_input_may_be_drive_and_brake_by_its_sign(text, gain):
    draft = drafted([text], ["speed [m/s]"])
    message = questions(draft)
    assert "is it both, by its sign?" in message
    assert gain in message
    assert f'# ? variable = "{text.partition(" [")[0]}"' in draft.toml
    if "= -1.0" in gain:
        edited = draft.toml.replace("# ? ", "")
        assert make_profile(tomllib.loads(edited), "edited draft").inputs.force.gain == -1.0


@pytest.mark.parametrize(
    ("names", "role", "chosen"),
    [
        (["der(s) [m/s]"], "speed", "der(s)"),
        (["der(vehicle.position) [m/s]"], "speed", "der(vehicle.position)"),
        (["v [m/s]", "der(s) [m/s]"], "speed", "v"),
        (["v [m/s]", "der(v) [m/s2]"], "acceleration", "der(v)"),
        (["v [m/s]", "der(wind.v) [m/s2]"], "acceleration", None),
    ],
)
def test_a_derivative_is_named_after_its_variable(names, role, chosen):
    outputs = drafted(["force [N]"], names).values["outputs"]
    assert outputs.get(role, {}).get("variable") == chosen


@pytest.mark.parametrize(
    ("description", "unit"),
    [
        ("speed of the car [km/h]", "km/h"),
        ("speed (mph), as shown", "mph"),
        ("longitudinal speed in km/h.", "km/h"),
        ("speed (of the car), in a tunnel [3]", "?"),
        ("speed [rad]", "?"),
    ],
)
def test_a_unit_in_the_description_is_offered(description, unit):
    draft = drafted(["force [N]"], [variable("speed", "output", description=description)])
    assert not draft.confident
    assert f'# ? unit = "{unit}"' in draft.toml


@pytest.mark.parametrize(
    ("drive", "brake"),
    [
        ("F_drive [N]", "F_brake [N]"),
        ("driveForce [kN]", "brakeForce [kN]"),
        ("tractive_force [N]", "braking_force [N]"),
        ("engine_force [N]", "brake [N]"),
        ("traction [N]", "Fb [N]"),
    ],
)
def test_a_drive_and_a_brake_force(drive, brake):
    draft = drafted([drive, brake], ["v [m/s]"])
    assert draft.confident
    assert {role: axis["variable"] for role, axis in draft.values["inputs"].items()} == {
        "drive_force": drive.partition(" [")[0],
        "brake_force": brake.partition(" [")[0],
    }


@pytest.mark.parametrize(
    ("name", "role"),
    [
        *((name, "speed") for name in ("speed [m/s]", "v [km/h]", "vx [m/s]", "v_x [mph]")),
        *((name, "speed") for name in ("VehicleSpeed [m/s]", "body.velocity [m/s]", "Spd [kn]")),
        *((name, "speed") for name in ("y1 [m/s]", "ego_velocity_kmh [km/h]")),
        *((name, "position") for name in ("s [m]", "x [km]", "odometer [mi]", "car.pos [m]")),
        *((name, "acceleration") for name in ("a [m/s2]", "accel [g0]", "a_x [m/s^2]")),
    ],
)
def test_outputs_by_name_and_unit(name, role):
    outputs = [name] if role == "speed" else ["speed [m/s]", name]
    draft = drafted(["force [N]"], outputs)
    assert draft.confident
    assert draft.values["outputs"][role]["variable"] == name.partition(" [")[0]


@pytest.mark.parametrize("name", ["v0", "v_0", "v_start", "vInit", "initial_speed", "speedStart"])
def test_the_initial_speed(name):
    draft = drafted(["force [N]"], ["speed [m/s]"], [f"{name} [km/h]", "mass [kg]", "v_max [m/s]"])
    assert draft.values["initial"] == {"speed": {"variable": name}}


def test_an_output_with_a_start_value_is_its_own_initial_value():
    speed = variable("speed [m/s]", "output", start="0", settable=True)
    assert drafted(["force [N]"], [speed]).values["initial"] == {"speed": {"variable": "speed"}}


def test_of_several_the_best_name_wins():
    speeds = ["wheel_speed [rad/s]", "wind_speed [m/s]", "v_lat [m/s]", "speed [m/s]", "vRef [m/s]"]
    draft = drafted(["force [N]", "slope [rad]", "wind [m/s]"], speeds)
    assert draft.confident
    assert draft.values["outputs"]["speed"]["variable"] == "speed"
    assert "slope" in draft.toml
    assert "wind" in draft.toml


def test_the_fmus_own_unit_counts_before_the_name():
    model = a_model(["force [strange]"], ["speed [m/s]"])
    model.units["strange"] = Unit("strange", 1000.0, 0.0, units.FORCE)
    assert draft_profile(model).confident


# ---- how it is stepped ----

FIXED = Interface(Kind.CO_SIMULATION, "car", fixed_internal_step=0.002)
RIGID = Interface(Kind.CO_SIMULATION, "car", variable_step=False)
ME = Interface(Kind.MODEL_EXCHANGE, "car")


@pytest.mark.parametrize(
    ("interfaces", "default_step", "table"),
    [
        ((CS,), 0.01, {"kind": "co-simulation"}),
        ((ME,), None, {"kind": "model-exchange"}),
        ((ME, CS), None, {"kind": "co-simulation"}),
        ((FIXED,), None, {"kind": "co-simulation", "step": 0.002}),
        ((RIGID,), 0.01, {"kind": "co-simulation", "step": 0.01}),
        ((RIGID,), 0.02, {"kind": "co-simulation", "step": 0.02}),
        ((RIGID,), 11.0, {"kind": "co-simulation"}),  # no profile may say so: a question
        ((RIGID,), None, {"kind": "co-simulation"}),
    ],
)
def test_kind_and_step(interfaces, default_step, table):
    draft = drafted(["F [N]"], ["v [m/s]"], interfaces=interfaces, default_step=default_step)
    assert draft.values["fmu"] == table
    assert draft.confident


# ---- the file ----

NAMES = st.text(min_size=1, max_size=12)


@given(NAMES, NAMES, NAMES, st.sampled_from(["", "m/s", "N", "kg", 'a"b']), st.text(max_size=30))
def test_whatever_the_fmu_says_the_file_is_toml(one, other, third, unit, description):
    model = a_model(
        [Variable(one, 0, "Real", "input", unit=unit, description=description)],
        [Variable(other, 1, "Real", "output", unit=unit, description=description)],
        [Variable(third, 2, "Real", "parameter", unit=unit, start="1", settable=True)],
    )
    draft = draft_profile(model)
    assert tomllib.loads(draft.toml) == draft.values
    assert all(line.isprintable() for line in draft.toml.splitlines())


@pytest.mark.parametrize(
    ("inputs", "outputs"),
    [
        (["force [N]"], ["speed [m/s]", "x [km]", "a [m/s2]"]),
        (["driveForce [N]", "brakeForce [N]"], ["speed [m/s]"]),
        (["vehicle.a_ref [m/s2]"], ["vehicle.v [m/s]"]),
        (['odd "name\\' + " [N]"], ["speed [m/s]"]),
    ],
)
def test_a_draft_without_questions_is_a_profile(inputs, outputs):
    draft = drafted(inputs, outputs)
    profile = make_profile(tomllib.loads(draft.toml), "draft")
    assert profile == require_confident(draft, PATH)
    assert "# ?" not in draft.toml
