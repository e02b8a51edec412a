"""A profile on an FMU: units, gains, elements of arrays; what does not fit is refused in a line."""

from __future__ import annotations

import math

import pytest

from fmus import FmuInterfaceError, FmuProfileError, FmuVariableError, VehicleFmu, make_profile
from fmus.description.reading import read_model
from fmus.profile.wiring import wire

SPEED = {"variable": "speed"}
FORCE = {"variable": "force"}


def wired(path, *, start_values=None, **tables):
    values = {"inputs": {"force": FORCE}, "outputs": {"speed": SPEED}} | tables
    return wire(read_model(path), make_profile(values, "test"), start_values)


def refusal(path, kind=FmuVariableError, **tables):
    """The one line with which a profile is refused; it names the FMU."""
    with pytest.raises(kind) as caught:
        wired(path, **tables)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert message.isprintable()
    return message.removeprefix(f"{path}: ")


# ---- units ----


@pytest.mark.parametrize("defined", [True, False])
@pytest.mark.parametrize(
    ("unit", "factor"),
    [
        ("km/h", 1 / 3.6),
        ("mph", 0.44704),
        ("knots", 1852 / 3600),
        ("m/s", 1.0),
    ],
)
def test_speeds_come_in_the_units_of_the_fmu(zoo, unit, factor, defined):
    """By the base units that the FMU defines, or by the name."""
    path = zoo.car(units={"speed": (unit, factor, 0.0)}, define_units=defined)
    speed = wired(path).outputs[0]
    assert speed.to_si(50.0) == pytest.approx(50.0 * factor, rel=1e-12)
    assert speed.to_raw(speed.to_si(50.0)) == pytest.approx(50.0)


def test_a_unit_with_an_offset(zoo):
    """SI = factor * raw + offset: 0 raw is 2 m/s."""
    path = zoo.car(units={"speed": ("odd", 0.5, 2.0)})
    assert wired(path).outputs[0].to_si(6.0) == 5.0


def test_the_units_own_offset_and_the_users_add_up(zoo):
    """SI = gain * (factor * raw + unit_offset) + offset."""
    path = zoo.car(units={"speed": ("odd", 0.5, 2.0)})
    axis = {**SPEED, "gain": -3.0, "offset": 7.0}
    speed = wired(path, outputs={"speed": axis}).outputs[0]
    assert speed.to_si(6.0) == -3.0 * (0.5 * 6.0 + 2.0) + 7.0
    assert speed.to_raw(speed.to_si(6.0)) == pytest.approx(6.0)


def test_the_profiles_unit_wins_over_the_fmus(zoo):
    speed = wired(zoo.car(), outputs={"speed": {**SPEED, "unit": "km/h"}}).outputs[0]
    assert speed.to_si(36.0) == pytest.approx(10.0)


@pytest.mark.parametrize(("unit", "full"), [("1", 1.0), ("%", 100.0), (None, 1.0)])
def test_pedals_may_be_plain_numbers_or_per_cent(zoo, unit, full):
    factor = 1.0 / full
    units = dict.fromkeys(("throttle", "brake"), unit and (unit, factor, 0.0))
    path = zoo.car(role="throttle_brake", units=units)
    pedals = {
        "throttle": {"variable": "throttle", "full_force": 1.0},
        "brake": {"variable": "brake", "full_force": 1.0},
    }
    for pedal in wired(path, inputs=pedals).inputs:
        assert pedal.to_raw(1.0) == pytest.approx(full)


def test_a_pedal_in_degrees_needs_a_gain(zoo):
    """Full throttle at 30 degrees: degrees are radians, and 1 is fully pressed."""
    units = {"throttle": ("deg", math.pi / 180, 0.0)}
    path = zoo.car(role="throttle_brake", units=units, define_units=False)
    pedals = {
        "throttle": {"variable": "throttle", "full_force": 1.0},
        "brake": {"variable": "brake", "full_force": 1.0},
    }
    said = refusal(path, FmuProfileError, inputs=pedals)
    assert said.startswith("[inputs.throttle] variable 'throttle' is in 'deg', an angle, and not a")
    assert "gain = ..." in said
    pedals["throttle"]["gain"] = 1 / math.radians(30)
    assert wired(path, inputs=pedals).inputs[0].to_raw(1.0) == pytest.approx(30.0)


@pytest.mark.parametrize(
    ("unit", "what"),
    [("kg", "a mass"), ("Nm", "a torque or an energy"), ("m/s2", "an acceleration")],
)
def test_a_unit_of_another_kind_is_refused_with_the_line_to_add(zoo, unit, what):
    said = refusal(zoo.car(), FmuProfileError, inputs={"force": {**FORCE, "unit": unit}})
    assert f"'force' is in '{unit}', {what}, and not a force" in said
    assert "add the line gain = ..." in said
    assert said.endswith("to [inputs.force]")


def test_a_force_declared_in_kg_is_a_mass(zoo):
    path = zoo.car(units={"force": ("kg", 1.0, 0.0)})
    assert "is in 'kg', a mass, and not a force" in refusal(path, FmuProfileError)


@pytest.mark.parametrize(
    ("quantity", "place", "line"),
    [
        ("force", "[inputs.force]", 'unit = "N"'),
        ("speed", "[outputs.speed]", 'unit = "m/s"'),
        ("position", "[outputs.position]", 'unit = "m"'),
        ("acceleration", "[outputs.acceleration]", 'unit = "m/s2"'),
        ("initial_speed", "[initial.speed]", 'unit = "m/s"'),
    ],
)
def test_no_unit_is_refused_with_the_line_to_add(zoo, quantity, place, line):
    path = zoo.car(units={quantity: None})
    outputs = {name: {"variable": name} for name in ("speed", "position", "acceleration")}
    initial = {"speed": {"variable": "initial_speed"}}
    said = refusal(path, FmuProfileError, outputs=outputs, initial=initial)
    assert said == (
        f"{place} variable '{quantity}' has no unit; add the line {line}, or what it is, to {place}"
    )


def test_an_unknown_unit_is_refused_by_name(zoo):
    said = refusal(zoo.car(), FmuProfileError, inputs={"force": {**FORCE, "unit": "furlong"}})
    assert "is in 'furlong', an unknown unit; add the line unit = \"N\" or gain = ..." in said


@pytest.mark.parametrize("axis", [{"unit": "furlong"}, {"unit": "Nm"}, {}])
def test_with_a_gain_no_unit_is_needed(zoo, axis):
    path = zoo.car(units={"force": None})
    force = wired(path, inputs={"force": {**FORCE, **axis, "gain": 3.125}}).inputs[0]
    assert force.to_si(1.0) == 3.125


@pytest.mark.parametrize("axis", [{"gain": 1e-320}, {"gain": 1e300}, {"offset": 1e300}])
def test_a_conversion_beyond_all_measure_is_mistyped(zoo, axis):
    said = refusal(zoo.car(), FmuProfileError, inputs={"force": {**FORCE, **axis}})
    assert said.endswith("check unit, gain and offset of [inputs.force]")


# ---- variables ----


def test_a_missing_variable_is_named_with_the_likely_one(zoo):
    said = refusal(zoo.car(), outputs={"speed": {"variable": "sped"}})
    assert said == "[outputs.speed] no variable 'sped' in the FMU; did you mean 'speed'?"
    said = refusal(zoo.car(), outputs={"speed": {"variable": "v_x"}})
    assert "it has force, speed, position" in said


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        ({"inputs": {"force": SPEED}}, "'speed' is output; expected an input: force"),
        ({"inputs": {"force": {"variable": "mass"}}}, "'mass' is parameter; expected an input"),
        ({"outputs": {"speed": FORCE}}, "'force' is input; expected an output: speed, position"),
        ({"outputs": {"speed": {"variable": "mass"}}}, "'mass' is parameter; expected an output"),
        ({"initial": {"speed": SPEED}}, "'speed' is output and cannot be set before the start"),
        ({"outputs": {"speed": {"variable": "load"}}}, "'load' is String; expected a number"),
        ({"inputs": {"force": {"variable": "engaged"}}}, "'engaged' is Boolean; expected a number"),
    ],
)
def test_a_variable_of_another_part_is_refused(zoo, tables, said):
    assert said in refusal(zoo.car(), **tables)


def test_one_variable_cannot_be_two_inputs(zoo):
    """The brake would overwrite the drive."""
    both = {"drive_force": {"variable": "drive_force"}, "brake_force": {"variable": "drive_force"}}
    said = refusal(zoo.car(role="drive_brake"), inputs=both)
    assert "[inputs.brake_force] variable 'drive_force' is that of [inputs.drive_force]" in said


def test_a_local_variable_may_be_read(zoo):
    path = zoo.car(kind="model-exchange")
    axis = {"variable": "state_speed"}
    assert wired(path, outputs={"speed": axis}).outputs[0].channel.name == "state_speed"


def test_a_kind_that_the_fmu_lacks_is_refused(zoo):
    said = refusal(zoo.car(), FmuInterfaceError, fmu={"kind": "model-exchange"})
    assert "[fmu] kind = 'model-exchange': the FMU has co-simulation only" in said


@pytest.mark.parametrize(
    ("wanted", "found"),
    [(None, "co-simulation"), ("model-exchange",) * 2, ("co-simulation",) * 2],
)
def test_co_simulation_is_the_first_choice(zoo, wanted, found):
    fmu = {} if wanted is None else {"kind": wanted}
    assert wired(zoo.car(kind="both"), fmu=fmu).interface.kind == found


# ---- arrays ----

ELEMENT = {"variable": "y[1]", "unit": "m/s"}


@pytest.fixture
def array(zoo):
    """u = [force, spare, spare], y = [speed, position, acceleration]."""
    return zoo.car(fmi="3.0", array="structural")


def test_elements_are_counted_from_one(array):
    outputs = {"speed": ELEMENT, "position": {"variable": "y[2]", "unit": "m"}}
    found = wired(array, inputs={"force": {"variable": "u[1]", "unit": "N"}}, outputs=outputs)
    assert [w.channel.element for w in (*found.inputs, *found.outputs)] == [0, 0, 1]


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("y", "variable 'y' is an array of 3; name one element, 'y[1]' to 'y[3]'"),
        ("y[0]", "'y' has 3 element(s), counted from 1"),
        ("y[4]", "'y' has 3 element(s), counted from 1"),
        ("y[-1]", "no variable 'y[-1]'"),
        ("y[1,2]", "no variable 'y[1,2]'"),
        ("y[" + "9" * 5000 + "]", "no variable 'y["),
        ("initial_speed[1]", "'initial_speed' is not an array; leave out the brackets"),
    ],
)
def test_elements_that_there_are_not(array, name, said):
    force = {"variable": "u[1]", "unit": "N"}
    axis = {"variable": name, "unit": "m/s"}
    assert said in refusal(array, inputs={"force": force}, outputs={"speed": axis})


# ---- start values ----


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("mass", True, "expected a finite number"),
        ("mass", "heavy", "expected a finite number"),
        ("mass", float("nan"), "expected a finite number"),
        ("mass", 10**400, "expected a finite number"),
        ("mass", None, "expected a finite number"),
        ("mass", [], "expected 1 value(s)"),
        ("mass", ["a"], "expected a finite number as value 1"),
        ("gears", 2.0, "expected a whole number"),
        ("gears", True, "expected a whole number"),
        ("gears", "2", "expected a whole number"),
        ("engaged", 1, "expected true or false"),
        ("engaged", "true", "expected true or false"),
        ("load", 1, "expected text"),
        ("speed", 1.0, "'speed' is output; expected a parameter or an input"),
        ("bulk", 1.0, "no variable 'bulk' in the FMU"),
        ("mass[1]", 1.0, "'mass' is not an array"),
    ],
)
def test_start_values_must_fit_their_variables(zoo, name, value, said):
    message = refusal(zoo.car(), start_values={name: value})
    assert message.startswith("start value")
    assert said in message
    assert len(message) < 250


@pytest.mark.parametrize(
    ("old", "new", "values", "said"),
    [
        ('<Real unit="kg"', '<Real min="500" unit="kg"', {"mass": 1}, "at least 500 kg"),
        ('<Real unit="kg"', '<Real max="5e3" unit="kg"', {"mass": 5001.0}, "at most 5000 kg"),
        ("<Integer ", '<Integer min="1" max="6" ', {"gears": 7}, "at most 6"),
        ("<Integer ", '<Integer min="1" max="6" ', {"gears": 0}, "at least 1"),
    ],
)
def test_start_values_keep_the_ranges_of_the_fmu(zoo, redescribed, old, new, values, said):
    path = redescribed(zoo.car(), old, new)
    assert refusal(path, start_values=values).endswith(f"expected {said}")


def test_values_of_an_array(array):
    inputs = {"force": {"variable": "u[1]", "unit": "N"}}
    tables = {"inputs": inputs, "outputs": {"speed": ELEMENT}}
    assert len(wired(array, start_values={"u": [1, 2.5, 3]}, **tables).start_values) == 1
    assert len(wired(array, start_values={"u[2]": 2.5}, **tables).start_values) == 1
    said = refusal(array, start_values={"u": [1.0]}, **tables)
    assert said.endswith("start value u = [1.0]: expected 3 value(s)")
    said = refusal(array, start_values={"u": [1.0, math.inf, 2.0]}, **tables)
    assert said.endswith("expected a finite number as value 2")


@pytest.mark.parametrize("fmi", ["1.0", "2.0", "3.0"])
def test_start_values_of_every_type_reach_the_fmu(zoo, fmi):
    """A load of 50 % on twice the mass, two gears: the acceleration at rest tells."""
    path = zoo.car(fmi=fmi)
    values = {"mass": 2000.0, "load": "full", "gears": 2, "engaged": True, "friction": 0}
    profile = make_profile(zoo.profile(path) | {"parameters": values}, "test")
    with VehicleFmu(path, step_size=0.05, profile=profile) as car:
        car.start()
        car.step(1500.0)
        assert car.speed == pytest.approx(0.05 * 2 * 1500.0 / 3000.0, rel=1e-12)
    with VehicleFmu(
        path, step_size=0.05, profile=profile, start_values={"engaged": False}
    ) as standing:  # arguments come after the profile
        standing.start()
        standing.step(1500.0)
        assert standing.speed == 0.0
