"""FMUs that are in order but particular: about their steps, types, functions, names and folders."""

from __future__ import annotations

import tempfile
from math import exp

import pytest

from fmus import FmuPlatformError, FmuVariableError, open_vehicle
from fmus.profile.vehicle_profile import make_profile

H = 0.05  # [s]
VERSIONS = ("1.0", "2.0", "3.0")


@pytest.fixture
def opened(zoo):
    """Open a car of the zoo here, or in a process of its own, with its profile changed."""
    vehicles = []

    def open_(path, *, isolated=False, parameters=None, **tables):
        values = zoo.profile(path)
        for table, keys in tables.items():
            for key, change in keys.items():
                old = values[table].get(key)
                values[table][key] = {**old, **change} if isinstance(old, dict) else change
        made = make_profile({**values, "parameters": parameters or {}}, "the test's profile")
        vehicles.append(open_vehicle(path, step_size=H, profile=made, isolated=isolated))
        return vehicles[-1]

    yield open_
    for vehicle in vehicles:
        vehicle.close()


def drive(vehicle, force=250.0) -> tuple[float, float]:
    """Position and speed after 1.25 s from 1.2 m/s."""
    vehicle.start(speed=1.2)
    for _ in range(25):
        vehicle.step(force)
    return vehicle.position, vehicle.speed


@pytest.fixture
def as_usual(zoo, opened):
    return pytest.approx(drive(opened(zoo.car())), rel=1e-12)


def test_the_usual_drive_is_the_analytic_one(as_usual):
    end, rate, time = 2.5, 0.1, 1.25
    speed = end + (1.2 - end) * exp(-rate * time)
    assert as_usual == (end * time + (1.2 - speed) / rate, speed)


# ---- steps ----


@pytest.mark.parametrize("fmi", VERSIONS)
@pytest.mark.parametrize(
    "particular", [{"only_step": 0.01}, {"constant_step": True}, {"strict_time": True}]
)
def test_it_gets_the_steps_that_it_wants(zoo, opened, as_usual, fmi, particular):
    assert drive(opened(zoo.car(fmi=fmi, **particular))) == as_usual


def test_its_time_is_k_h_also_after_a_long_drive(zoo, opened):
    """A running sum of steps would be refused by an FMU that compares with its own clock."""
    vehicle = opened(zoo.car(strict_time=True))
    vehicle.start()
    for _ in range(15_000):
        vehicle.step(0.0)
    assert vehicle.time == 15_000 * H


def test_a_slow_fmu_is_waited_for(zoo, opened, as_usual):
    assert drive(opened(zoo.car(behaviour="slow"), isolated=True)) == as_usual


# ---- types ----


@pytest.mark.parametrize(
    ("fmi", "kind"), [("1.0", "Integer"), ("2.0", "Integer"), ("3.0", "Int16"), ("3.0", "UInt32")]
)
def test_whole_numbers_are_read_and_written(zoo, opened, as_usual, fmi, kind):
    """Speed in mm/s and pedals in per mille, as a bus would carry them."""
    car = zoo.car(
        fmi=fmi,
        role="throttle_brake",
        kinds={"speed": kind, "throttle": kind},
        spoken={"speed": (1e-3, 0.0), "throttle": (1e-3, 0.0)},
    )
    vehicle = opened(
        car,
        outputs={"speed": {"gain": 1e-3}},
        inputs={"throttle": {"gain": 1e-3}},
    )
    position, speed = drive(vehicle)
    assert speed == pytest.approx(as_usual.expected[1], abs=1e-3)
    assert position == pytest.approx(as_usual.expected[0], abs=1e-3)


@pytest.mark.parametrize("fmi", VERSIONS)
@pytest.mark.parametrize(
    ("parameters", "force"),
    [
        ({"load": "full", "friction": 150.0}, 375.0),  # 1.5 times everything
        ({"gears": 2}, 125.0),
        ({"engaged": True}, 250.0),
        ({"mass": 500.0, "friction": 50.0}, 125.0),
    ],
)
def test_parameters_of_every_type_arrive(zoo, opened, as_usual, fmi, parameters, force):
    vehicle = opened(zoo.car(fmi=fmi), parameters=parameters)
    assert drive(vehicle, force) == as_usual


@pytest.mark.parametrize(
    ("parameters", "says"),
    [
        ({"gears": 1.5}, "expected a whole number"),
        ({"engaged": 1}, "expected true or false"),
        ({"load": 3.0}, "expected text"),
        ({"mass": True}, "expected a finite number"),
        ({"speed": 1.0}, "expected a parameter"),
        ({"gear": 1}, "did you mean 'gears'"),
    ],
)
def test_a_parameter_of_the_wrong_type_is_refused(zoo, opened, parameters, says):
    with pytest.raises(FmuVariableError, match=says):
        opened(zoo.car(), parameters=parameters)


def test_an_axis_that_counts_the_other_way(zoo, opened):
    """The brake force is negative in this FMU: gain = -1 in its profile."""
    braked = drive(opened(zoo.car(role="drive_brake")), force=-400.0)
    car = zoo.car(role="drive_brake", spoken={"brake_force": (-1.0, 0.0)})
    assert drive(opened(car, inputs={"brake_force": {"gain": -1.0}}), force=-400.0) == braked


# ---- functions ----


@pytest.mark.parametrize(
    ("fmi", "missing"),
    [
        ("1.0", ("car_fmiResetSlave", "car_fmiGetRealOutputDerivatives", "car_fmiCancelStep")),
        ("2.0", ("fmi2Reset", "fmi2GetFMUstate", "fmi2GetRealStatus", "fmi2SetDebugLogging")),
        ("3.0", ("fmi3Reset", "fmi3GetFMUState", "fmi3GetClock", "fmi3EvaluateDiscreteStates")),
    ],
)
def test_functions_that_are_not_needed_may_be_missing(zoo, opened, as_usual, fmi, missing):
    assert drive(opened(zoo.car(fmi=fmi, without=missing))) == as_usual


@pytest.mark.parametrize("isolated", [True, False])
@pytest.mark.parametrize(
    ("fmi", "missing"), [("1.0", "car_fmiDoStep"), ("2.0", "fmi2DoStep"), ("3.0", "fmi3DoStep")]
)
def test_one_that_is_needed_is_named(zoo, opened, fmi, missing, isolated):
    def start():
        opened(zoo.car(fmi=fmi, without=(missing,)), isolated=isolated).start()

    with pytest.raises(FmuPlatformError, match=missing):
        start()


def test_one_instance_per_process_is_enough_for_two_egos(zoo, opened, as_usual):
    car = zoo.car(once_per_process=True)
    one, other = opened(car, isolated=True), opened(car, isolated=True)
    one.start(speed=1.2)
    assert drive(other) == as_usual
    one.step(0.0)


@pytest.mark.parametrize("flag", ["needsExecutionTool", "canNotUseMemoryManagementFunctions"])
def test_flags_that_are_no_reason_to_refuse(zoo, opened, as_usual, flag):
    assert drive(opened(zoo.car(flags={flag: "true"}))) == as_usual


# ---- names and folders ----


def test_names_may_be_anything(zoo, opened, as_usual):
    names = {"speed": 'Auto.Geschwindigkeit <v> & "ß"', "force": "u[1].F_x", "position": "位置"}
    assert drive(opened(zoo.car(names=names))) == as_usual


@pytest.mark.parametrize("fmi", VERSIONS)
@pytest.mark.parametrize("isolated", [True, False])
def test_folders_may_have_any_name(zoo, opened, as_usual, tmp_path, monkeypatch, fmi, isolated):
    """FMI 1 and 2 hand the folder of the resources over as a URI."""
    folder = tmp_path / "Müller & Söhne, 100 % #1 ?a=b [x]"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    assert drive(opened(zoo.car(fmi=fmi), isolated=isolated)) == as_usual
