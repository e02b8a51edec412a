"""FMUs for Model Exchange: the solvers are ours, and so are the events."""

from __future__ import annotations

import ctypes
from itertools import pairwise
from math import cos, exp, log, sin, tanh

import numpy as np
import pytest

from fmus import FmuStartError
from fmus.fmi import cvode
from fmus.fmi.continuous import IntegrationError, UndefinedError, locate
from fmus.fmi.cvode import Cvode
from fmus.fmi.runge_kutta import RungeKutta

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


def test_a_crossing_is_found_to_the_resolution():
    at = locate(lambda t: t * t > 2.0, 0.0, 2.0, 1e-12)
    assert 0.0 <= at - 2.0**0.5 <= 1e-12


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


class Oscillator:
    """x'' = -x, with states x and x'."""

    nx, nz = 2, 0
    wrong_from = 99.0  # [s]

    def derivatives(self, time, x, slope):
        (a, b), out = ((ctypes.c_double * 2).from_address(p) for p in (x, slope))
        out[0], out[1] = b, -a
        if time > self.wrong_from:
            raise UndefinedError("too late")

    def undefined(self, slope, time):
        return "" if np.isfinite(slope).all() else "odd"


def integrated(solver, end):
    solver.restart(0.0, np.array([0.0, 1.0]), np.ones(2))
    time = 0.0
    while time < end:
        time = solver.step(end)
    return solver.x


def test_runge_kutta_is_of_order_four():
    errors = []
    for h in (0.2, 0.1, 0.05):
        solver, x = RungeKutta(Oscillator(), 1e-6), np.array([0.0, 1.0])
        for k in range(round(4.0 / h)):
            x = solver._classical(k * h, x, h)
        errors.append(abs(x[0] - sin(4.0)))
    orders = [log(coarse / fine, 2) for coarse, fine in pairwise(errors)]
    assert orders == pytest.approx([4.0, 4.0], abs=0.15)


class Clock:
    """x' = 4 t^3, a function of the time alone, which Runge-Kutta's weights (Simpson's) know."""

    nx, nz = 1, 0

    def derivatives(self, time, x, slope):
        ctypes.c_double.from_address(slope).value = 4.0 * time**3

    def undefined(self, slope, time):
        return ""


def test_every_stage_of_a_step_has_its_time():
    solver = RungeKutta(Clock(), 1e-6)
    solver.restart(1.0, np.array([1.0]), np.ones(1))
    time = 1.0
    while time < 3.0:
        time = solver.step(3.0)
        assert solver.x[0] == pytest.approx(time**4, rel=1e-13)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("kind", [RungeKutta, Cvode])
def test_the_error_follows_the_tolerance(kind, tolerance):
    if kind is Cvode and not cvode.available():
        pytest.skip("no SUNDIALS here")
    solver = kind(Oscillator(), tolerance)
    try:
        x = integrated(solver, 4.0)
        assert x == pytest.approx([sin(4.0), cos(4.0)], abs=10 * tolerance)
    finally:
        solver.close()


@pytest.mark.parametrize("kind", [RungeKutta, Cvode])
def test_states_between_two_steps(kind):
    if kind is Cvode and not cvode.available():
        pytest.skip("no SUNDIALS here")
    solver = kind(Oscillator(), 1e-8)
    try:
        solver.restart(0.0, np.array([0.0, 1.0]), np.ones(2))
        time = before = 0.0
        for _ in range(20):
            before, time = time, solver.step(3.0)
        middle = 0.5 * (before + time)
        assert solver.at(middle) == pytest.approx([sin(middle), cos(middle)], abs=1e-6)
    finally:
        solver.close()


@pytest.mark.parametrize("kind", [RungeKutta, Cvode])
def test_a_point_that_cannot_be_passed_ends_the_integration(kind):
    if kind is Cvode and not cvode.available():
        pytest.skip("no SUNDIALS here")
    system = Oscillator()
    system.wrong_from = 1.0
    solver = kind(system, 1e-6)
    try:
        with pytest.raises(IntegrationError, match=r"too late; no step from (0.999|1 s)"):
            integrated(solver, 2.0)
    finally:
        solver.close()


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
