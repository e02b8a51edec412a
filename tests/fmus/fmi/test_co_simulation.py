"""FMUs for Co-Simulation, FMI 1.0, 2.0 and 3.0, called through their C functions."""

from __future__ import annotations

from math import nan

import pytest
from support.fmus.analytic import moved, saving

from fmus import FmuPlatformError, FmuStartError, FmuVariableError, bundled_fmu
from fmus.fmi.status import ERROR

VERSIONS = ("1.0", "2.0", "3.0")
H = 0.05  # [s]


@pytest.fixture(params=VERSIONS)
def version(request):
    return request.param


def test_the_car_moves_as_the_analytic_solution(zoo, version, run):
    car = run(zoo.car(fmi=version), {"force": 700.0}, 100, values={"initial_speed": 5.0})
    assert list(car.outputs) == pytest.approx(moved(700.0, 5.0, 5.0), rel=1e-12)


def test_inputs_count_from_the_step_in_which_they_are_written(zoo, version, run):
    car = run(zoo.car(fmi=version), {"force": 1000.0}, 1)
    _, speed = moved(1000.0, H)
    car.inputs[0] = 0.0
    car.tick(H, H)
    assert car.outputs[1] == pytest.approx(moved(0.0, H, speed)[1], rel=1e-12)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_an_input_that_is_refused_ends_the_step_before_it_begins(version, run):
    car = run(bundled_fmu(version), {"force": 700.0}, 1)
    before = list(car.outputs)
    car.inputs[0] = nan
    assert car.tick(H, H) == ERROR
    assert "expected a finite number" in car.messages.take()
    assert list(car.outputs) == before


@pytest.mark.parametrize(
    ("version", "options", "inputs", "outputs"),
    [
        (
            "2.0",
            {"kinds": {"force": "Integer", "speed": "Real"}},
            ("force",),
            ("position", "speed"),
        ),
        ("1.0", {"kinds": {"force": "Integer"}}, ("force",), ("position", "speed")),
        ("3.0", {"kinds": {"force": "Int16"}}, ("force",), ("position", "speed")),
        ("3.0", {"kinds": {"force": "UInt64"}}, ("force",), ("position", "speed")),
        ("3.0", {"float32": True}, ("force",), ("position", "speed")),
        ("3.0", {"array": True}, ("u[1]",), ("y[2]", "y[1]")),
        ("3.0", {"array": "structural"}, ("u[1]",), ("y[2]", "y[1]")),
    ],
)
def test_channels_of_every_type_are_doubles_outside(zoo, run, version, options, inputs, outputs):
    path = zoo.car(fmi=version, **options)
    car = run(path, dict.fromkeys(inputs, 700.0), 20, outputs=outputs)
    precision = 1e-6 if options.get("float32") else 1e-12
    assert list(car.outputs) == pytest.approx(moved(700.0, 1.0), rel=precision)


def test_whole_numbers_are_rounded_and_kept_within_their_type(zoo, run):
    path = zoo.car(fmi="3.0", kinds={"force": "Int8"})
    car = run(path, {"force": 99.6}, 1, outputs=("speed",))
    assert car.outputs[0] == pytest.approx(moved(100.0, H)[1], rel=1e-12)
    car.inputs[0] = 1e6
    car.tick(H, H)
    assert car.outputs[0] == pytest.approx(moved(127.0, H, moved(100.0, H)[1])[1], rel=1e-12)


def test_several_types_at_once(zoo, version, run):
    path = zoo.car(fmi=version, outputs=("speed", "gear", "clock"), extra=("spare_input",))
    inputs = {"force": 700.0, "spare_input": 1.0}
    car = run(path, inputs, 20, outputs=("gear", "speed", "clock"))
    assert list(car.outputs) == pytest.approx([1.0, moved(700.0, 1.0)[1], 1.0], rel=1e-12)


def test_no_channel_at_all(zoo, version, run):
    car = run(zoo.car(fmi=version), {}, 2, outputs=())
    assert car.status == 0
    assert list(car.outputs) == []


# ---- start values ----


def test_start_values_of_every_type(zoo, version, run):
    values = {
        "mass": 800.0,
        "gears": 2,
        "load": "full",
        "initial_speed": 1.0,
        "initial_position": 7,
    }
    car = run(zoo.car(fmi=version), {"force": 350.0}, 20, values=values)
    position, speed = moved(700.0, 1.0, 1.0, mass=1200.0)
    assert list(car.outputs) == pytest.approx([position + 7.0, speed], rel=1e-12)


def test_a_boolean_start_value(zoo, version, run):
    path = zoo.car(fmi=version)
    assert run(path, {"force": 700.0}, 2, values={"engaged": False}).outputs[1] == 0.0
    assert run(path, {"force": 700.0}, 2, values={"engaged": 1}).outputs[1] > 0.0


def test_start_values_of_an_array_whole_or_by_element(zoo, load, start):
    car = load(zoo.car(fmi="3.0", array="structural"))
    for values in ({"u": [700.0, 0.0, 0.0]}, {"u[1]": 700.0}, {"array_size": 3, "u[1]": 700.0}):
        start(car, values, ("u[1]",), ("y[1]",))
        assert car.inputs[0] == (700.0 if "u[1]" in values else car.inputs[0])
        car.inputs[0] = 700.0
        car.tick(0.0, H)
        assert car.outputs[0] == pytest.approx(moved(700.0, H)[1], rel=1e-12)


def test_an_inputs_start_value_stays_until_it_is_overwritten(zoo, version, load, start):
    car = start(load(zoo.car(fmi=version)), {"force": 700.0})
    assert car.inputs[0] == 700.0
    car.tick(0.0, H)
    assert car.outputs[1] == pytest.approx(moved(700.0, H)[1], rel=1e-12)


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("mass", "heavy", "expected a finite number"),
        ("mass", True, "expected a finite number"),
        ("mass", float("nan"), "expected a finite number"),
        ("mass", [1.0, 2.0], "expected 1 values"),
        ("gears", 1.5, "expected a whole number from -2147483648 to 2147483647"),
        ("gears", 1e12, "expected a whole number"),
        ("engaged", 2, "expected true or false"),
        ("load", 3.0, "expected a text"),
        ("load", "half\0full", "expected a text"),
    ],
)
def test_a_start_value_that_does_not_fit_is_named(zoo, load, start, name, value, expected):
    path = zoo.car(fmi="2.0")
    with pytest.raises(FmuStartError, match=rf"\.fmu: start value {name} = .*: {expected}"):
        start(load(path), {name: value})


def test_a_refused_start_value_comes_with_its_reason(zoo, version, load, start):
    path = zoo.car(fmi=version)
    with pytest.raises(
        FmuStartError, match=r"the FMU does not start: .* returned 'error': load: neither"
    ):
        start(load(path), {"load": "flying"})


# ---- the order of calls ----


def called(path):
    return path.with_suffix(".calls").read_text().split()


def test_an_instance_lives_and_dies_in_the_standards_order(zoo, load, start):
    path = zoo.car(fmi="2.0", calls=True, file="order2")
    start(load(path), {"mass": 900.0, "force": 5.0}).stop()
    assert called(path) == ["instantiate", "setup", "enter", "initialise", "terminate", "free"]


def test_structural_parameters_are_set_in_configuration_mode(zoo, load, start):
    path = zoo.car(fmi="3.0", array="structural", calls=True, file="order3")
    start(load(path), {"array_size": 3, "mass": 900.0}, ("u[1]",), ("y[1]",)).stop()
    assert called(path) == [
        "instantiate", "configure", "configured", "enter", "initialise", "terminate", "free",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("behaviour", "end"),
    [("error", ["free"]), ("fatal", []), ("terminate", ["terminate", "free"])],
)
def test_an_instance_is_freed_after_an_error_but_not_a_fatal_one(zoo, run, behaviour, end):
    path = zoo.car(fmi="2.0", behaviour=behaviour, calls=True, file=f"order_{behaviour}")
    run(path, {"force": 1.0}, 10).stop()
    words = [word for word in called(path) if word[0].isalpha()]
    assert words[words.index("step") :] == ["step"] * 5 + end


def test_every_start_is_a_new_instance(zoo, version, load, start):
    car = load(zoo.car(fmi=version))
    for _ in range(3):
        start(car, {"initial_speed": 5.0})
        assert list(car.outputs) == [0.0, 5.0]
        car.tick(0.0, H)
    car.stop()
    car.stop()
    assert car.tick(0.0, H) == 3


# ---- steps that are not simply done ----


@pytest.mark.parametrize("behaviour", ["discard_once", "discard_long", "discard_spoiled"])
def test_a_discarded_step_is_resumed_or_done_in_smaller_ones(zoo, version, run, behaviour):
    if version == "1.0" and behaviour != "discard_once":
        pytest.skip("FMI 1.0 cannot return to an earlier state")
    car = run(
        zoo.car(fmi=version, behaviour=behaviour, flags=saving(version)), {"force": 700.0}, 20
    )
    assert car.status <= 1
    assert list(car.outputs) == pytest.approx(moved(700.0, 1.0), rel=1e-9)


@pytest.mark.parametrize(
    "behaviour", ["discard_always", "discard_creeping", "discard_backwards", "discard_nan"]
)
@pytest.mark.parametrize("saves", [False, True])
def test_endless_discard_ends(zoo, version, run, behaviour, saves):
    flags = saving(version, saves)
    car = run(zoo.car(fmi=version, behaviour=behaviour, flags=flags), {"force": 1.0}, 20)
    assert car.status == 2
    tried = "and steps down to 1/64 of it" if flags and saves else "and cannot return to the state"
    assert f"it discards the step, {tried}" in car.messages.take()


def test_without_rewinding_a_discard_is_final(zoo, run):
    path = zoo.car(behaviour="discard_long", flags=saving("2.0"))
    assert run(path, {"force": 1.0}, 20, rewinds=False).status == 2


@pytest.mark.parametrize(
    ("behaviour", "status"),
    [("warning", 1), ("error", 3), ("pending", 5), ("unknown_status", 3), ("terminate", 6)],
)
def test_what_a_step_can_return(zoo, version, run, behaviour, status):
    car = run(zoo.car(fmi=version, behaviour=behaviour), {"force": 700.0}, 10)
    if (version, behaviour) == ("1.0", "terminate"):
        status = 2  # FMI 1.0 has no word for it
    assert car.status == status if status > 1 else car.status <= 1


def test_a_null_instance_is_refused(zoo, version, load, start):
    path = zoo.car(fmi=version, behaviour="silent_null", phase="instantiate", at=0.0)
    with pytest.raises(FmuStartError, match=r"Instantiate.* returned no instance: without a "):
        start(load(path))


# ---- functions that are missing ----


def test_optional_functions_may_be_missing(zoo, run):
    missing = ("fmi2GetRealStatus", "fmi2GetBooleanStatus", "fmi2GetFMUstate")
    path = zoo.car(without=missing, flags=saving("2.0"), behaviour="discard_once")
    car = run(path, {"force": 700.0}, 10)
    assert (car.status, car.outputs[1]) == (2, pytest.approx(moved(700.0, 0.2)[1]))


@pytest.mark.parametrize("verb", ["DoStep", "Terminate", "EnterInitializationMode"])
@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_a_missing_mandatory_function_is_told_before_the_start(zoo, load, version, verb):
    path = zoo.car(fmi=version, without=(f"fmi{version[0]}{verb}",))
    with pytest.raises(FmuPlatformError, match=f"no function fmi{version[0]}{verb}, which"):
        load(path)


def test_a_channel_that_is_no_number(zoo, load, start):
    car = load(zoo.car(fmi="2.0"))
    with pytest.raises(FmuVariableError, match="load is a String; expected a number or a boolean"):
        start(car, inputs=("load",))
