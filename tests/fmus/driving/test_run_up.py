"""The start: at the speed and the place asked for, by a parameter or by driving up to it."""

from __future__ import annotations

import re

import pytest

from fmus import (
    FmuOutputError,
    FmuStartError,
    FmuStateError,
    FmuStepError,
    VehicleFmu,
    make_profile,
)

H = 0.05  # [s]
KMH = ("km/h", 1 / 3.6, 0.0)


def state(car):
    return car.time, car.position, car.speed, car.acceleration


# ---- a parameter for it ----


@pytest.mark.parametrize("fmi", ["1.0", "2.0", "3.0"])
def test_the_start_speed_is_in_the_parameters_unit(zoo, open_car, fmi):
    car = open_car(zoo.car(fmi=fmi, units={"initial_speed": KMH, "speed": KMH}))
    car.start(position=-3.0, speed=7.0)
    assert state(car)[:3] == (0.0, -3.0, pytest.approx(7.0, rel=1e-14))
    assert car.warnings == []


@pytest.mark.parametrize(
    ("quantity", "said"),
    [
        ("initial_speed", "initial_speed was set to start at 4 m/s, but speed = 1.11111 m/s"),
        ("speed", "initial_speed was set to start at 4 m/s, but speed = 14.4 m/s"),
    ],
)
def test_a_start_speed_in_a_wrong_unit_is_caught(zoo, open_car, quantity, said):
    car = open_car(zoo.car(spoken={quantity: KMH[1:]}))
    with pytest.raises(FmuStartError) as caught:
        car.start(speed=4.0)
    assert said in str(caught.value)
    assert "check the units of both, or leave out [initial.speed]" in str(caught.value)
    with pytest.raises(FmuStateError):
        car.step(0.0)


def test_a_start_place_in_a_wrong_unit_is_caught(zoo, open_car):
    car = open_car(zoo.car(spoken={"initial_position": (1000.0, 0.0)}))
    said = "initial_position was set to start at 40 m, but position = 40000 m"
    with pytest.raises(FmuStartError, match=said):
        car.start(position=40.0)
    car.start()  # 0 m is 0 km


@pytest.mark.parametrize(("speed", "met"), [(4.0, True), (3.3, False)])
def test_a_start_speed_that_is_a_whole_number(zoo, open_car, speed, met):
    path = zoo.car(kinds={"initial_speed": "Integer"})
    car = open_car(path, initial={"speed": {"unit": "m/s"}})
    if met:
        car.start(speed=speed)
        assert car.speed == speed
    else:
        with pytest.raises(FmuStartError, match=r"start at 3\.3 m/s, but speed = 3 m/s"):
            car.start(speed=speed)


def test_the_start_speed_wins_over_the_same_parameter(zoo, open_car):
    car = open_car(zoo.car(), parameters={"initial_speed": 9.0})
    car.start(speed=2.0)
    assert car.speed == 2.0


@pytest.mark.parametrize(
    "options",
    [
        {"initial": ("speed",)},  # no parameter for the position
        {"initial": ("speed", "position"), "outputs": ("speed",)},
        {"initial": ("speed",), "values": {"initial_position": 1e4}},
        {"initial": ("speed",), "units": {"position": ("km", 1000.0, 25.0)}},
    ],
)
def test_positions_count_from_where_the_fmu_is(zoo, open_car, options):
    car = open_car(zoo.car(**options))
    car.start(position=-12.5, speed=4.0)
    assert car.position == -12.5
    for _ in range(20):
        car.step(400.0)
    assert car.position == pytest.approx(-12.5 + 4.0, abs=1e-9)


@pytest.mark.parametrize(("position", "speed"), [(float("nan"), 1.0), (0.0, float("inf"))])
def test_a_start_that_is_nowhere_is_refused(zoo, open_car, position, speed):
    with pytest.raises(FmuStartError, match="expected a finite number"):
        open_car(zoo.car()).start(position=position, speed=speed)


def test_warnings_are_those_since_the_last_start(zoo, open_car):
    car = open_car(zoo.car(initial=()))
    car.start(speed=4.0)
    assert len(car.warnings) == 1
    car.start()
    assert car.warnings == []


# ---- what the FMU does not tell ----


def test_without_a_position_the_speed_is_integrated(zoo, open_car):
    car = open_car(zoo.car(outputs=("speed",)))
    car.start(position=2.0, speed=4.0)
    position = 2.0
    for force in (0.0, 3000.0, -3000.0, 500.0):
        before = car.speed
        car.step(force)
        position += 0.5 * H * (before + car.speed)
        assert car.position == pytest.approx(position, rel=1e-15)
        assert car.acceleration == pytest.approx((car.speed - before) / H, rel=1e-12)


def test_an_acceleration_of_the_fmu_is_its_own(zoo, open_car):
    car = open_car(zoo.car())
    car.start(speed=4.0)
    car.step(1000.0)
    assert car.acceleration == pytest.approx((1000.0 - 100.0 * car.speed) / 1000.0)


# ---- no parameter for it: the run-up ----

ROLES = ("force", "drive_brake", "acceleration", "throttle_brake", "speed_setpoint")


@pytest.mark.parametrize("role", ROLES)
@pytest.mark.parametrize("speed", [0.5, 4.0, 13.9])
def test_it_is_driven_up_to_the_speed(zoo, open_car, role, speed):
    car = open_car(zoo.car(role=role, initial=()))
    car.start(position=5.0, speed=speed)
    assert car.time == 0.0
    assert car.position == 5.0
    assert car.speed == pytest.approx(speed, abs=0.02)
    (warning,) = car.warnings
    assert re.search(rf"driven up to {car.speed:.3g} m/s in [\d.]+ s before the start", warning)
    position, before = car.position, car.speed
    for k in range(1, 21):  # it goes on from there, and does not fall behind
        car.step(100.0 * speed)
        assert car.time == k * H
        assert car.position - position == pytest.approx(H * (before + car.speed) / 2, abs=1e-3)
        position, before = car.position, car.speed


def test_resistance_unknown_to_the_controller_is_overcome(zoo, open_car):
    """Twice the mass and quadratic drag: the integrator finds the force that holds the speed."""
    path = zoo.car(initial=(), values={"mass": 2000.0, "drag": 5.0, "lag": 0.2})
    car = open_car(path, inverse_map={"mass": 1000.0, "friction": 100.0})
    car.start(speed=8.0)
    assert car.speed == pytest.approx(8.0, abs=0.02)


def test_a_car_that_starts_too_fast_is_slowed_down(zoo, open_car):
    car = open_car(zoo.car(initial=(), values={"initial_speed": 10.0}), parameters=None)
    car.start(speed=3.0)
    assert car.speed == pytest.approx(3.0, abs=0.02)


@pytest.mark.parametrize("stretch", [2, 3, 7])
@pytest.mark.parametrize("speed", [1.0, 2.0, 3.3])
def test_it_ends_where_a_step_of_the_fmu_ends(zoo, open_car, stretch, speed):
    """Else the first steps of the run would lie within one that is over."""
    path = zoo.car(initial=(), only_step=stretch * H, strict_time=True)
    car = open_car(path, limits={"position_jump": 1e6})
    car.start(speed=speed)
    position = car.position
    for _ in range(3 * stretch):
        car.step(100.0 * speed)
        assert car.position - position == pytest.approx(H * speed, abs=2e-3)
        position = car.position


def test_the_clock_of_the_fmu_goes_on(zoo, open_car):
    path = zoo.car(initial=(), outputs=("speed", "position"), strict_time=True, constant_step=True)
    car = open_car(path)
    car.start(speed=3.0)
    for _ in range(500):
        car.step(300.0)
    assert car.time == 500 * H


def test_it_can_be_forbidden(zoo, open_car):
    car = open_car(zoo.car(initial=()), initial={"run_up": False})
    with pytest.raises(FmuStartError) as caught:
        car.start(speed=4.0)
    assert "speed starts at 0 m/s and not at 4 m/s" in str(caught.value)
    assert "[initial.speed] variable = ..." in str(caught.value)
    assert "--ego-initial-speed" in str(caught.value)
    car.start()


def test_backwards_it_is_not_done(zoo, open_car):
    with pytest.raises(FmuStartError, match="and not at -2 m/s"):
        open_car(zoo.car(initial=())).start(speed=-2.0)


def test_a_speed_that_cannot_be_reached_is_given_up(zoo, open_car):
    """5 kN of drive against 500 N.s/m: 10 m/s at most."""
    path = zoo.car(role="throttle_brake", initial=(), values={"friction": 500.0})
    car = open_car(path)
    with pytest.raises(FmuStartError) as caught:
        car.start(speed=15.0)
    message = str(caught.value)
    assert "does not reach its initial speed of 15 m/s within 120 s (it is at 10 m/s)" in message
    assert "[initial.speed] variable = ..." in message
    with pytest.raises(FmuStateError, match="start it again"):
        car.step(0.0)
    car.start(speed=5.0)
    assert car.speed == pytest.approx(5.0, abs=0.02)


@pytest.mark.parametrize(("behaviour", "kind"), [("nan", FmuOutputError), ("error", FmuStepError)])
def test_a_failure_on_the_way_says_that_it_was_before_the_start(zoo, open_car, behaviour, kind):
    car = open_car(zoo.car(initial=(), behaviour=behaviour))
    with pytest.raises(kind, match=r"before the start, driving up to .* 4 m/s"):
        car.start(speed=4.0)
    with pytest.raises(FmuStateError):
        car.step(0.0)
    car.start()


def test_a_car_that_no_force_moves_names_its_unset_inputs(zoo):
    car = zoo.car(initial=(), values={"engaged": 0.0}, extra=("spare_input",))
    values = zoo.profile(car)
    values.pop("initial", None)
    values["parameters"] = {"engaged": False}
    with (
        VehicleFmu(car, step_size=0.05, profile=make_profile(values, "test")) as vehicle,
        pytest.raises(FmuStartError, match=r"no force moves it .* spare_input = "),
    ):
        vehicle.start(speed=4.0)


@pytest.mark.parametrize(
    ("factor", "gain", "line"),
    [
        (-1.0, None, r"gain = -1.0 in \[inputs.force\]"),
        (1.0, -1.0, r"gain = 1.0 in place of gain = -1.0 in \[inputs.force\]"),
        (0.32, -3.125, r"gain = 3.125 in place of gain = -3.125 in \[inputs.force\]"),
    ],
)
def test_a_car_with_its_force_sign_turned_is_told_the_line(zoo, factor, gain, line):
    car = zoo.car(initial=(), spoken={"force": (factor, 0.0)})
    values = zoo.profile(car)
    values.pop("initial", None)
    if gain is not None:
        values["inputs"]["force"]["gain"] = gain
    with (
        VehicleFmu(car, step_size=0.05, profile=make_profile(values, "test")) as vehicle,
        pytest.raises(FmuStartError, match=rf"drive it backwards .* with {line}, or"),
    ):
        vehicle.start(speed=4.0)
