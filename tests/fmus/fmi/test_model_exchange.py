"""FMUs for Model Exchange: the solvers are ours, and so are the events."""

from __future__ import annotations

from math import exp, log, tanh

import pytest

from fmus import FmuStartError
from fmus.fmi import cvode

H = 0.05  # [s]
SOLVERS = [
    "rk4",
    pytest.param(
        "cvode", marks=pytest.mark.skipif(not cvode.available(), reason="no SUNDIALS here")
    ),
]
CLOSE = {"rel": 3e-6, "abs": 1e-9}


@pytest.fixture(params=["2.0", "3.0"])
def version(request):
    return request.param


@pytest.fixture(params=SOLVERS)
def solver(request):
    return request.param


@pytest.fixture
def drive(zoo, version, solver, run):
    """A car of the zoo as Model Exchange under constant inputs; ``values`` are built in."""

    def driven(inputs, steps, *, start=None, options=None, **more):
        path = zoo.car(fmi=version, kind="model-exchange", **(options or {}))
        return run(path, inputs, steps, values=start, solver=solver, **more)

    return driven


def speed_after(force, time, speed=0.0, mass=1000.0, friction=100.0):
    """By the analytic solution of M v' + alpha v = F."""
    return force / friction + (speed - force / friction) * exp(-friction / mass * time)


def position_after(force, time, speed=0.0, mass=1000.0, friction=100.0):
    final = force / friction
    return final * time + (speed - final) * mass / friction * (1 - exp(-friction / mass * time))


# ---- motion ----


def test_the_car_moves_as_the_analytic_solution(drive):
    car = drive({"force": 700.0}, 200, start={"initial_speed": 5.0})
    expected = [position_after(700.0, 10.0, 5.0), speed_after(700.0, 10.0, 5.0)]
    assert list(car.outputs) == pytest.approx(expected, **CLOSE)


def test_quadratic_drag(drive):
    car = drive({"force": 700.0}, 100, options={"values": {"drag": 7.0, "friction": 0.0}})
    assert car.outputs[1] == pytest.approx(10.0 * tanh(0.07 * 5.0), **CLOSE)


def test_inputs_jump_at_the_start_of_a_step(drive):
    car = drive({"force": 1000.0}, 10)
    car.inputs[0] = -500.0
    car.tick(10 * H, H)
    expected = speed_after(-500.0, H, speed_after(1000.0, 10 * H))
    assert car.outputs[1] == pytest.approx(expected, **CLOSE)


def test_model_exchange_and_co_simulation_of_one_fmu_agree(zoo, run, version, solver):
    path = zoo.car(fmi=version, kind="both", role="drive_brake", values={"lag": 0.3, "drag": 0.5})
    inputs = {"drive_force": 4000.0, "brake_force": 500.0}
    outputs = ("position", "speed", "acceleration")
    exchange = run(path, inputs, 60, kind="model-exchange", solver=solver, outputs=outputs)
    co_simulation = run(path, inputs, 60, kind="co-simulation", outputs=outputs)
    assert list(exchange.outputs) == pytest.approx(list(co_simulation.outputs), rel=1e-5)


def test_arrays_and_whole_numbers(zoo, run, solver):
    path = zoo.car(fmi="3.0", kind="model-exchange", array=True)
    car = run(path, {"u[1]": 700.0}, 20, outputs=("y[1]",), values={"gears": 2}, solver=solver)
    assert car.outputs[0] == pytest.approx(speed_after(1400.0, 1.0), **CLOSE)


def test_no_states_at_all(drive):
    options = {"role": "speed_setpoint", "values": {"response": 0.0}, "outputs": ("speed",)}
    car = drive({"speed_setpoint": 3.0}, 3, options=options, outputs=("speed",))
    assert (car.status, car.outputs[0]) == (0, 3.0)


@pytest.mark.parametrize("nominal", [0.0, -1.0, 1e-3, 1e3])
def test_the_states_nominal_values_scale_the_tolerance_only(drive, nominal):
    car = drive({"force": 700.0}, 20, options={"nominal": nominal})
    assert car.outputs[1] == pytest.approx(speed_after(700.0, 1.0), rel=1e-5)


def test_a_stiff_actuator(drive):
    car = drive({"force": 700.0}, 4, options={"values": {"lag": 1e-4}})
    assert car.outputs[1] == pytest.approx(speed_after(700.0, 0.2 - 1e-4), rel=1e-4)


def test_too_stiff_for_runge_kutta_says_what_to_do(zoo, run):
    path = zoo.car(kind="model-exchange", values={"lag": 1e-8})
    car = run(path, {"force": 700.0}, 1, solver="rk4")
    assert car.status == 3
    assert 'use `solver = "cvode"`, it is for stiff systems' in car.messages.take()


# ---- events ----


def test_the_brake_stops_the_car_and_holds_it(drive):
    """State event: v = 0 at the time that solves v(t) = 0."""
    inputs = {"drive_force": 0.0, "brake_force": 5000.0}
    car = drive(inputs, 60, start={"initial_speed": 5.0}, options={"role": "drive_brake"})
    stop = 10.0 * log(1.0 + 5.0 / 50.0)  # 0.953 s, within a step
    assert car.outputs[1] == 0.0
    assert car.outputs[0] == pytest.approx(position_after(-5000.0, stop, 5.0), **CLOSE)


def test_the_brake_lets_go(drive):
    inputs = {"drive_force": 0.0, "brake_force": 5000.0}
    car = drive(inputs, 40, start={"initial_speed": 1.0}, options={"role": "drive_brake"})
    car.inputs[0], car.inputs[1] = 700.0, 0.0
    for k in range(40, 60):
        assert car.tick(k * H, H) == 0
    assert car.outputs[1] == pytest.approx(speed_after(700.0, 1.0), **CLOSE)


@pytest.mark.parametrize("shift", [0.33, 0.3, 0.30000000000000004, 1e-9, 0.05, 1.0])
@pytest.mark.parametrize("step", [0.05, 0.1])
def test_a_gear_shifts_at_its_time(drive, shift, step):
    """Time event, also where it falls on the end of a step or a rounding beside it."""
    options = {"values": {"gear_time": shift}, "outputs": ("speed", "gear")}
    steps = round(1.2 / step)
    outputs = ("speed", "gear")
    car = drive({"force": 1000.0}, steps, step=step, options=options, outputs=outputs)
    time = steps * step
    expected = speed_after(500.0, time - shift, speed_after(1000.0, shift))
    assert list(car.outputs) == pytest.approx([expected, 2.0], **CLOSE)


def test_a_gear_shifts_at_a_speed(drive):
    """Step event: the FMU asks for it after an integrator's step."""
    options = {"values": {"gear_speed": 0.5, "gear_ratio": 0.1}, "outputs": ("speed", "gear")}
    outputs = ("speed", "gear")
    car = drive({"force": 1000.0}, 10, options=options, outputs=outputs)
    assert list(car.outputs) == pytest.approx([speed_after(1000.0, 0.5), 1.0], **CLOSE)
    for k in range(10, 40):
        car.tick(k * H, H)
    assert car.outputs[1] == 2.0
    assert 0.5 < car.outputs[0] < 0.8


# ---- what goes wrong ----


def test_undefined_derivatives_end_the_step_with_their_name(drive):
    car = drive({"force": 1.0}, 10, options={"behaviour": "nan_rate"})
    assert car.status == 3
    assert "derivative 2 of 2 is nan at 0.1" in car.messages.take()


@pytest.mark.parametrize(
    ("behaviour", "status"),
    [("error", 3), ("unknown_status", 3), ("terminate", 6), ("discard_always", 3)],
)
def test_what_a_step_can_return(drive, behaviour, status, capfd):
    car = drive({"force": 1.0}, 10, options={"behaviour": behaviour})
    assert car.status == status
    assert car.messages.take()
    assert capfd.readouterr() == ("", "")


def test_an_event_iteration_without_end(drive):
    with pytest.raises(FmuStartError, match=r"event iteration at 0 s has not ended"):
        drive({"force": 1.0}, 1, options={"behaviour": "chatter", "phase": "event", "at": 0.0})


# ---- the solvers alone ----


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_a_completed_step_is_final(zoo, version, run):
    """The state is never set back to before it: noSetFMUStatePriorToCurrentPoint is true."""
    path = zoo.car(
        fmi=version, kind="model-exchange", calls=True, file=f"completed{version[0]}",
        flags={"completedIntegratorStepNotNeeded": "false"} if version == "2.0" else {},
    )  # fmt: skip
    run(path, {"force": 700.0}, 3)
    lines = path.with_suffix(".calls").read_text().splitlines()
    assert {line for line in lines if line.startswith("completed")} == {"completed 1"}
