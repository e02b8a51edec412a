"""What no car does ends the run at once; what a car hardly does is a warning, said once."""

from __future__ import annotations

import re

import pytest
from support.fmus.cars import Fault

from fmus import FmuOutputError, FmuStateError, FmuStepError

H = 0.05  # [s]


def drive(car, force=1000.0, steps=10):
    for _ in range(steps):
        car.step(force)


# ---- faults ----


@pytest.mark.parametrize("fmi", ["1.0", "2.0", "3.0"])
@pytest.mark.parametrize(
    ("behaviour", "said"),
    [
        ("nan", "speed = nan at 0.25 s; expected a finite number"),
        ("nan_position", "position = nan at 0.25 s"),
        ("nan_acceleration", "acceleration = nan at 0.25 s"),
        ("inf", "speed = inf at 0.25 s"),
        ("huge", "speed = 1e+300 m/s at 0.25 s; expected within +-100 m/s"),
        ("jump", "m at 0.25 s, +50 m from where the speed leads; expected within 1 m"),
    ],
)
def test_what_no_car_does_is_named_with_variable_and_time(zoo, open_car, fmi, behaviour, said):
    path = zoo.car(fmi=fmi, behaviour=behaviour)
    car = open_car(path)
    car.start(speed=4.0)
    with pytest.raises(FmuOutputError) as caught:
        drive(car)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert said in message
    assert "\n" not in message
    assert car.time == 5 * H


def test_after_a_failure_the_vehicle_says_so_until_restarted(zoo, open_car):
    car = open_car(zoo.car(behaviour="nan"))
    car.start(speed=4.0)
    with pytest.raises(FmuOutputError):
        drive(car)
    with pytest.raises(FmuStateError, match=r"failed at 0\.25 s; start it again"):
        car.step(0.0)
    car.start(position=7.0, speed=3.0)
    assert (car.time, car.position, car.speed) == (0.0, 7.0, 3.0)
    drive(car, steps=4)


def test_a_first_state_is_judged_too(zoo, open_car):
    car = open_car(zoo.car(spoken={"speed": (1e-9, 0.0)}, values={"initial_speed": 5.0}))
    with pytest.raises(FmuOutputError, match="at 0 s"):
        car.start(speed=5.0)
    with pytest.raises(FmuStateError, match="has not started"):
        car.step(0.0)


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        ({"speed": 4.1}, "expected within +-4.1 m/s; check its unit and the step, or raise speed"),
        ({"position_jump": 0.01}, "expected within 0.01 m"),
    ],
)
def test_the_limits_are_the_profiles(zoo, open_car, limits, said):
    """3 cm per step are no fault by the usual limits: wheels may slip by as much."""
    path = zoo.car(spoken={"position": (0.85, 0.0)})
    ordinary, strict = open_car(path), open_car(path, limits=limits)
    for car in (ordinary, strict):
        car.start(speed=4.0)
    drive(ordinary)
    with pytest.raises(FmuOutputError, match=re.escape(said)):
        drive(strict)


def test_a_hard_stop_within_a_step_is_no_jump(zoo, open_car):
    """A trapezoid is off by up to half the speed's change times the step."""
    car = open_car(zoo.car(values={"mass": 1000.0}), limits={"position_jump": 1e-9})
    car.start(speed=30.0)
    drive(car, force=-20_000.0, steps=2)


@pytest.mark.parametrize("force", [float("nan"), float("inf"), -float("inf")])
def test_a_force_that_is_none_is_refused_and_does_no_harm(zoo, open_car, force):
    car = open_car(zoo.car())
    car.start(speed=4.0)
    with pytest.raises(FmuStepError, match="expected a finite number"):
        car.step(force)
    car.step(400.0)
    assert car.time == H


# ---- warnings ----


def frozen(car):
    return [warning for warning in car.warnings if "has not changed" in warning]


def test_a_frozen_car_is_warned_of_once(zoo, open_car):
    car = open_car(zoo.car(behaviour="frozen", at=0.0))
    car.start()
    drive(car, force=3000.0, steps=38)
    assert not frozen(car)
    drive(car, force=3000.0, steps=100)
    (warning,) = frozen(car)
    assert re.search(
        r"speed has not changed for 2 s until 2(\.05)? s under forces like 3000", warning
    )
    car.start()
    assert car.warnings == []


@pytest.mark.parametrize("outputs", [("speed", "position"), ("speed",)])
def test_a_frozen_car_with_rounding_noise_in_speed_is_warned_of(zoo, open_car, outputs):
    path = zoo.car(behaviour=[Fault("frozen", at=0.0), Fault("trembles", at=0.0)], outputs=outputs)
    car = open_car(path)
    car.start()
    drive(car, force=400.0)
    drive(car, force=3000.0, steps=50)
    assert abs(car.speed) < 1e-15
    assert frozen(car)


def test_the_time_until_that_warning_is_the_profiles(zoo, open_car):
    car = open_car(zoo.car(behaviour="frozen", at=0.0), limits={"frozen_time": 0.5})
    car.start()
    drive(car, force=3000.0, steps=11)
    assert frozen(car)


def test_a_frozen_speed_is_noticed_without_a_position(zoo, open_car):
    """Its position is integrated and goes on; the speed does not answer another force."""
    car = open_car(zoo.car(behaviour="frozen", outputs=("speed",)))
    car.start(speed=4.0)
    drive(car, force=400.0)
    drive(car, force=3000.0, steps=50)
    assert frozen(car)


@pytest.mark.parametrize("outputs", [("speed", "position"), ("speed",)])
def test_a_steady_drive_is_not_frozen(zoo, open_car, outputs):
    """At 5 m/s and 500 N nothing changes but the position."""
    car = open_car(zoo.car(outputs=outputs, fmi="3.0", float32=True))
    car.start(speed=5.0)
    drive(car, force=500.0, steps=200)
    assert car.speed == 5.0
    assert car.warnings == []


@pytest.mark.parametrize("force", [-8000.0, 0.0, 100.0])
def test_a_car_that_stands_braked_is_not_frozen(zoo, open_car, force):
    car = open_car(zoo.car(role="drive_brake", values={"full_drive": 1.0}))
    car.start()
    drive(car, force=min(force, 0.0), steps=100)
    assert car.speed == 0.0
    assert car.warnings == []


def test_reversing_is_a_warning_with_the_first_time(zoo, open_car):
    car = open_car(zoo.car(), inputs={"block_reverse": False})
    car.start()
    drive(car, force=-500.0, steps=20)
    (warning,) = car.warnings
    assert re.search(r"speed = -0\.0744 m/s at 0\.15 s: it reverses", warning)


def test_the_overshoot_of_a_stop_is_no_reversing(zoo, open_car):
    """A bare mass that is braked by 1 N within its last step goes on at some mm/s."""
    car = open_car(zoo.car())
    car.start(speed=0.02)
    drive(car, force=-800.0)
    assert -0.05 < car.speed <= 0.0
    assert car.warnings == []


# ---- speeds that no car has ----


def test_a_speed_that_changes_as_no_car_is_a_warning_once(zoo, open_car):
    car = open_car(zoo.car(values={"mass": 100.0, "friction": 0.0}))
    car.start(speed=4.0)
    drive(car, force=1400.0, steps=5)
    assert car.warnings == []
    drive(car, force=2000.0, steps=5)
    (warning,) = car.warnings
    assert re.search(r"speed = 8\.5 m/s at 0\.3 s, 7\.5 m/s 0\.05 s before: 20 m/s2: more", warning)


@pytest.mark.parametrize("force", [6000.0, -6000.0])
def test_a_speed_that_jumps_ends_it(zoo, open_car, force):
    path = zoo.car(values={"mass": 100.0, "friction": 0.0})
    car = open_car(path)
    car.start(speed=4.0)
    with pytest.raises(FmuOutputError, match=r"60 m/s2; expected at most 50 m/s2"):
        car.step(force)
    wider = open_car(path, limits={"acceleration": 70.0})
    wider.start(speed=4.0)
    wider.step(force)


def test_brakes_may_stop_it_within_a_step_and_noise_may_shake_it(zoo, open_car):
    car = open_car(zoo.car(values={"mass": 100.0, "holds": 1.0}))
    car.start(speed=1.8)
    drive(car, force=-9000.0, steps=5)
    assert (car.speed, car.warnings) == (0.0, [])
    fast = open_car(zoo.car(values={"mass": 100.0, "friction": 0.0}), step=0.005)
    fast.start(speed=4.0)
    drive(fast, force=6000.0, steps=2)
    assert fast.warnings == []


# ---- the ranges that the FMU declares for its inputs ----


def test_inputs_keep_their_range_and_that_is_said_once(zoo, open_car, redescribed):
    path = zoo.car(units={"force": ("kN", 1000.0, 0.0)})
    narrow = redescribed(path, '<Real unit="kN"', '<Real min="-2" max="1" unit="kN"')
    limited, free = open_car(narrow, like=path), open_car(path)
    for car in (limited, free):
        car.start(speed=10.0)
    for wanted, passed in ((5000.0, 1000.0), (900.0, 900.0), (-9000.0, -2000.0), (3e9, 1000.0)):
        limited.step(wanted)
        free.step(passed)
        assert limited.speed == free.speed
    (warning,) = limited.warnings
    assert warning.endswith("force was limited to the FMU's -2 to 1 kN")


def test_the_range_holds_at_the_start_too(zoo, open_car, redescribed):
    """No force is below what this input takes: it starts with the least that it does."""
    path = zoo.car()
    odd = redescribed(path, '<Real unit="N" start="0.0"', '<Real min="100" unit="N" start="100"')
    car = open_car(odd, like=path)
    car.start()
    assert car.acceleration == pytest.approx(0.1)


@pytest.mark.parametrize("range_", ['min="5" max="-5"', 'min="nan"', 'max="nan"'])
def test_a_range_that_is_none_is_left_alone(zoo, open_car, redescribed, range_):
    path = zoo.car()
    car = open_car(redescribed(path, '<Real unit="N"', f'<Real {range_} unit="N"'), like=path)
    car.start()
    car.step(1000.0)
    assert car.speed == pytest.approx(10.0 * (1 - 2.718281828459045**-0.005), rel=1e-9)
