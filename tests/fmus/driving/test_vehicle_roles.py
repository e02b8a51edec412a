"""Every way to drive an FMU, every version and kind: the same car moves the same way."""

from __future__ import annotations

import pytest

from fmus import FmuError, FmuStartError, FmuVariableError

H = 0.05  # [s]
FORCES = [2000.0] * 10 + [0.0] * 5 + [-1500.0] * 10 + [300.0] * 5  # it never stands
KMH, MPH, KN = ("km/h", 1 / 3.6, 0.0), ("mph", 0.44704, 0.0), ("kN", 1000.0, 0.0)
KM, PER_CENT, G = ("km", 1000.0, 0.0), ("%", 0.01, 0.0), ("g0", 9.80665, 0.0)
FORMS = [
    {"fmi": "1.0"},
    {"fmi": "2.0"},
    {"fmi": "3.0"},
    {"fmi": "2.0", "kind": "model-exchange"},
    {"fmi": "3.0", "kind": "model-exchange"},
]
PEDALS = {"role": "throttle_brake", "values": {"full_drive": 4000.0, "full_brake": 9000.0}}


def drive(car, forces=FORCES):
    car.start(position=3.0, speed=6.0)
    states = []
    for force in forces:
        car.step(force)
        states.append((car.position, car.speed, car.acceleration))
    return states


def near(found, expected, tolerance):
    for one, other in zip(found, expected, strict=True):
        assert one == pytest.approx(other, rel=0, abs=tolerance)


@pytest.fixture
def reference(zoo, open_car):
    return drive(open_car(zoo.car()))


@pytest.mark.parametrize("form", FORMS, ids=lambda form: " ".join(form.values()))
@pytest.mark.parametrize("options", [{}, {"role": "drive_brake"}, PEDALS], ids=str)
def test_forces_by_any_way_are_the_same_forces(zoo, open_car, reference, form, options):
    tolerance = 1e-4 if "kind" in form else 1e-10
    near(drive(open_car(zoo.car(**form, **options))), reference, tolerance)


@pytest.mark.parametrize(
    ("options", "units"),
    [
        ({}, {"force": KN, "speed": KMH, "position": KM, "acceleration": G}),
        ({}, {"speed": MPH, "initial_speed": KMH, "initial_position": KM}),
        ({"role": "drive_brake"}, {"drive_force": KN, "speed": KMH}),
        (PEDALS, {"throttle": PER_CENT, "brake": PER_CENT}),
    ],
    ids=str,
)
@pytest.mark.parametrize("define_units", [True, False])
def test_in_any_units(zoo, open_car, reference, options, units, define_units):
    car = open_car(zoo.car(**options, units=units, define_units=define_units))
    near(drive(car), reference, 1e-9)


def test_signs_and_offsets_of_the_users(zoo, open_car, reference):
    """A force that counts backwards, a brake that counts negative, a speed with an offset."""
    backwards = zoo.car(spoken={"force": (-2.0, 0.0), "speed": (0.5, -3.0)})
    car = open_car(
        backwards,
        inputs={"force": {"gain": -2.0}},
        outputs={"speed": {"gain": 0.5, "offset": -3.0}},
    )
    near(drive(car), reference, 1e-9)
    negative = zoo.car(role="drive_brake", spoken={"brake_force": (-1.0, 0.0)})
    near(drive(open_car(negative, inputs={"brake_force": {"gain": -1.0}})), reference, 1e-10)


def test_single_precision_and_arrays(zoo, open_car, reference):
    units = {"force": "N", "speed": "m/s", "position": "m", "acceleration": "m/s2"}
    for options in ({"float32": True}, {"array": True}, {"array": "structural", "float32": True}):
        path = zoo.car(fmi="3.0", **options)
        outputs = {name: {"unit": units[name]} for name in ("speed", "position", "acceleration")}
        near(
            drive(open_car(path, inputs={"force": {"unit": "N"}}, outputs=outputs)), reference, 1e-4
        )


def test_whole_numbers_as_channels(zoo, open_car, reference):
    """A force in whole N is rounded, not cut; a speed in whole mm/s is as fine as that."""
    path = zoo.car(
        kinds={"force": "Integer", "speed": "Integer"},
        units={"speed": ("mm/s", 0.001, 0.0)},
        initial=("speed", "position"),
    )
    car = open_car(path, inputs={"force": {"unit": "N"}}, outputs={"speed": {"unit": "mm/s"}})
    found = drive(car, [force + 0.4 for force in FORCES])
    for (position, speed, _), (s, v, _) in zip(found, reference, strict=True):
        assert position == pytest.approx(s, abs=1e-9)
        assert speed == pytest.approx(v, abs=0.00100001)


@pytest.mark.parametrize("form", FORMS, ids=lambda form: " ".join(form.values()))
def test_an_acceleration_is_kept(zoo, open_car, form):
    """By the inverse map (u - alpha v) / M, with M and alpha of the profile."""
    car = open_car(
        zoo.car(role="acceleration", **form), inverse_map={"mass": 1400.0, "friction": 80.0}
    )
    speed, position = 6.0, 3.0
    for force, state in zip(FORCES, drive(car), strict=True):
        rate = (force - 80.0 * speed) / 1400.0
        position, speed = position + speed * H + rate * H * H / 2, speed + rate * H
        assert state[:2] == pytest.approx((position, speed), abs=2e-4)


def test_a_speed_loop_is_led_like_the_controllers_car(zoo, open_car):
    """With its time constant as the lead, its first acceleration is (u - alpha v) / M."""
    car = open_car(zoo.car(role="speed_setpoint", outputs=("speed", "position")))
    car.start(speed=6.0)
    for force in FORCES:
        before = car.speed
        car.step(force)
        wanted = (force - 100.0 * before) / 1000.0
        assert (car.speed - before) / H == pytest.approx(wanted, rel=0.06)


def test_without_a_lead_the_set_point_is_one_step_ahead(zoo, open_car):
    """Of a car that follows at once: forward Euler of the controller's own model."""
    path = zoo.car(role="speed_setpoint", values={"response": 0.0}, outputs=("speed", "position"))
    car = open_car(path, limits={"position_jump": 10.0})
    car.start()
    speed = car.speed
    for force in FORCES:
        car.step(force)
        speed = max(0.0, speed + H * (force - 100.0 * speed) / 1000.0)
        assert car.speed == pytest.approx(speed, abs=1e-9)


@pytest.mark.parametrize("role", ["force", "acceleration"])
def test_braking_to_a_standstill_does_not_drive_backwards(zoo, open_car, role):
    car = open_car(zoo.car(role=role))
    car.start(speed=2.0)
    for _ in range(60):
        car.step(-3000.0)
        assert car.speed > -0.2  # what is left of the step in which it stops
    assert car.position < 2.0
    at = car.position
    for _ in range(20):
        car.step(-3000.0)
    assert car.position == pytest.approx(at, abs=0.1)


def test_an_fmu_whose_brakes_hold_may_have_all_forces(zoo, open_car):
    path = zoo.car(values={"holds": 1.0})
    car = open_car(path, inputs={"block_reverse": False})
    car.start(speed=1.0)
    for _ in range(40):
        car.step(-3000.0)
    assert car.speed == 0.0
    assert car.warnings == []


@pytest.mark.parametrize("block", [True, False])
def test_a_brake_force_does_not_drive_a_bare_mass_backwards(zoo, open_car, block):
    car = open_car(
        zoo.car(role="drive_brake", values={"holds": 0.0}), inputs={"block_reverse": block}
    )
    car.start()
    for _ in range(40):
        car.step(-3000.0)
    assert car.speed == 0.0 if block else car.speed < -1.0


@pytest.mark.parametrize(
    ("fmi", "kind"),
    [("1.0", "co-simulation"), ("2.0", "co-simulation"), ("3.0", "co-simulation"),
     ("2.0", "model-exchange"), ("3.0", "model-exchange")],
)  # fmt: skip
def test_an_fmu_that_wants_a_stop_time_is_told_the_profiles(zoo, open_car, fmi, kind):
    path = zoo.car(fmi=fmi, kind=kind, needs_stop_time=60.0)
    with pytest.raises(FmuStartError, match="no stop time, or too early"):
        open_car(path).start()
    with pytest.raises(FmuStartError, match="no stop time, or too early"):
        open_car(path, fmu={"stop_time": 59.0}).start()
    car = open_car(path, fmu={"stop_time": 60.0})
    car.start()
    car.step(1000.0)
    assert car.speed > 0.0


def test_a_structural_parameter_sizes_arrays_and_their_buffers(zoo, open_car):
    path = zoo.car(fmi="3.0", array="structural", outputs=("speed",))
    units = {"inputs": {"force": {"unit": "N"}}, "outputs": {"speed": {"unit": "m/s"}}}
    usual = open_car(path, **units)
    longer = open_car(path, parameters={"array_size": 12, "u[12]": 0.5}, **units)
    shorter = open_car(path, start_values={"array_size": 1}, **units)
    for car in (usual, longer, shorter):
        car.start(speed=4.0)
        car.step(900.0)
    assert usual.speed == longer.speed == shorter.speed > 4.0
    assert longer.prepared.model.variables["u"].size == 12
    for size, told in ((-1, "expected a size, 0 to"), (20, "does not start")):
        with pytest.raises(FmuError, match=told):
            open_car(path, parameters={"array_size": size}, **units).start()
    with pytest.raises(FmuVariableError, match=r"'u' has 2 element\(s\)"):
        open_car(path, parameters={"array_size": 2, "u[3]": 1.0}, **units)
